"""``python -m contactlab_laws.tabulated``: build the table, verify it, or time it."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from contactlab_laws.tabulated.table import SHIPPED, read


def main() -> int:
    """Run one command; return 0, or 1 if the table is not as good as it should be."""
    parser = argparse.ArgumentParser(
        prog="python -m contactlab_laws.tabulated", description=__doc__
    )
    commands = parser.add_subparsers(dest="command", required=True)
    building = commands.add_parser("build", help="build the table; resumes what was interrupted")
    building.add_argument("--tolerance", type=float, default=1e-10, help="of psi2/psi1 (1e-10)")
    verifying = commands.add_parser("verify", help="compare with fresh exact impacts")
    verifying.add_argument("--count", type=int, default=10_000, help="impacts (10000)")
    verifying.add_argument("--seed", type=int, default=1)
    verifying.add_argument("--alone", action="store_true", help="solve each impact alone: slow")
    verifying.add_argument("--bound", type=float, default=1e-9, help="largest error (1e-9)")
    for command in (building, verifying):
        command.add_argument(
            "--workers", type=int, default=1, help="processes; 0 for one a core (1)"
        )
        command.add_argument("--file", type=Path, default=SHIPPED, help="the table")
    commands.add_parser("bench", help="print the processor time an impact takes")
    asked = parser.parse_args()
    if asked.command == "build":
        return _build(asked)
    return _verify(asked) if asked.command == "verify" else _bench()


def _workers(asked: argparse.Namespace) -> int:
    return asked.workers or os.cpu_count() or 1


def _build(asked: argparse.Namespace) -> int:
    from contactlab_laws.tabulated.build import build

    build(asked.file, tolerance=asked.tolerance, workers=_workers(asked))
    table = read(asked.file)
    print(f"{asked.file}: {len(table.cells)} patches, {asked.file.stat().st_size} bytes")
    return 0


def _verify(asked: argparse.Namespace) -> int:
    from contactlab_laws.tabulated.verify import verify

    table = read(asked.file)
    print(f"{asked.file}: {table.provenance}")
    rows = verify(
        table, count=asked.count, seed=asked.seed, workers=_workers(asked), alone=asked.alone
    )
    print(f"{'errors of max(1, psi1)':30} {'count':>7} {'largest':>8} {'rms':>8}  at psi1, chi")
    for row in rows:
        print(
            f"{row.name:30} {row.draws:7} {row.largest:8.1e} {row.rms:8.1e}  "
            f"{row.psi1!r}, {row.chi!r}"
        )
    return 0 if rows[-1].largest <= asked.bound else 1


def _bench() -> int:
    from contactlab_laws.tabulated.bench import bench

    for name, nanoseconds in bench():
        print(f"{name:30} {nanoseconds:8.0f} ns of processor time")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
