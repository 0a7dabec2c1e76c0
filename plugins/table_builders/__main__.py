"""``python -m table_builders``: build a table, verify it, or time it; run in ``plugins``."""

from __future__ import annotations

import argparse
import os
from pathlib import Path


def main() -> int:
    """Run one command; return 0, or 1 if a table is not as good as it should be."""
    parser = argparse.ArgumentParser(prog="python -m table_builders", description=__doc__)
    tables = parser.add_subparsers(dest="table", required=True)
    elastic = tables.add_parser("elastic", help="the elastic rebound")
    restituted = tables.add_parser("restituted", help="the rebound with a restitution")
    unlike = tables.add_parser("coupling", help="the size of elastic coupling of unlike bodies")
    built = unlike.add_subparsers(dest="command", required=True)
    built.add_parser("build", help="build the table: four minutes of processor time")
    sizes = tables.add_parser("differences", help="the sizes in cautions of laws of equal e")
    measured = sizes.add_subparsers(dest="command", required=True)
    measured.add_parser("build", help="measure springs and normal laws: minutes")
    for table, count in ((elastic, 10_000), (restituted, 1_000)):
        these = table.add_subparsers(dest="command", required=True)
        building = these.add_parser("build", help="build the table: minutes")
        verifying = these.add_parser("verify", help="compare with fresh impacts")
        verifying.add_argument("--count", type=int, default=count, help=f"impacts ({count})")
        verifying.add_argument("--seed", type=int, default=1)
        these.add_parser("bench", help="print the processor time an impact takes")
        these.add_parser("thin", help="write it, thinned, into the kernels for games")
        if table is elastic:
            _options(building, verifying)
        else:
            these.add_parser("shear", help="build the table of the loss in shear: half a minute")
    asked = parser.parse_args()
    if asked.table == "coupling":
        from contactlab.impact.coupling import FILE
        from table_builders.coupling.build import build

        build(FILE)
        return 0
    if asked.table == "differences":
        from table_builders.differences.build import write

        write()
        return 0
    return (_elastic if asked.table == "elastic" else _build_restituted)(asked)


def _options(building: argparse.ArgumentParser, verifying: argparse.ArgumentParser) -> None:
    """Add what the elastic table's commands alone know."""
    from contactlab_laws.tables.elastic import SHIPPED

    building.add_argument("--tolerance", type=float, default=1e-10, help="of psi2/psi1 (1e-10)")
    verifying.add_argument("--bound", type=float, default=1e-9, help="largest error (1e-9)")
    for command in (building, verifying):
        command.add_argument(
            "--workers", type=int, default=1, help="processes; 0 for one a core (1)"
        )
        command.add_argument("--file", type=Path, default=SHIPPED, help="the table")


def _elastic(asked: argparse.Namespace) -> int:
    from contactlab_laws.tables.elastic import Table
    from contactlab_laws.tables.file import read

    if asked.command == "bench":
        from table_builders.elastic.bench import bench

        for name, nanoseconds in bench():
            print(f"{name:30} {nanoseconds:8.0f} ns of processor time")
        return 0
    if asked.command == "thin":
        from table_builders.elastic import thin

        for file in thin.write():
            print(file)
        return 0
    workers = asked.workers or os.cpu_count() or 1
    if asked.command == "build":
        from table_builders.elastic.build import build

        build(asked.file, tolerance=asked.tolerance, workers=workers)
        patches = len(read(asked.file).arrays["cells"])
        print(f"{asked.file}: {patches} patches, {asked.file.stat().st_size} bytes")
        return 0
    from table_builders.elastic.verify import verify

    stored = read(asked.file)
    print(f"{asked.file}: contactlab {stored.version}, {stored.built}")
    table = Table.of(stored)
    rows = verify(table, count=asked.count, seed=asked.seed, workers=workers)
    print(f"{'errors of max(1, psi1)':30} {'count':>7} {'largest':>8} {'rms':>8}  at psi1, chi")
    for row in rows:
        print(
            f"{row.name:30} {row.draws:7} {row.largest:8.1e} {row.rms:8.1e}  "
            f"{row.psi1!r}, {row.chi!r}"
        )
    return 0 if rows[-1].largest <= asked.bound else 1


def _build_restituted(asked: argparse.Namespace) -> int:
    from contactlab_laws.tables.restituted import SHEAR, SHIPPED

    if asked.command == "build":
        from table_builders.restituted import build

        build.build(SHIPPED, build.PSI2)
        return 0
    if asked.command == "shear":
        from table_builders.restituted import build

        build.build(SHEAR, build.SHEAR)
        return 0
    if asked.command == "thin":
        from table_builders.restituted import thin

        for file in thin.write():
            print(file)
        return 0
    from table_builders.restituted.checks import bench, verify

    return verify(asked.count, asked.seed) if asked.command == "verify" else bench()


if __name__ == "__main__":
    raise SystemExit(main())
