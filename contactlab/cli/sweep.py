"""Run many impacts: a sweep file, or ranges of the paper's two parameters.

Examples
--------
  contactlab sweep --psi1 0:7:71 --chi 1.4412
  contactlab sweep --psi1 1.2 --chi 0.5:8:76 --tangential coulomb --csv
  contactlab sweep examples/sweep.toml --out sweep.npz
  contactlab sweep --psi1 0:7:100000 --chi 1.4412 --workers 2 --out sweep.npz --resume
"""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contactlab.cli import arguments as shared
from contactlab.cli.run import draw, report
from contactlab.cli.scene import MOST_IMPACTS, add_ranges, check_alone, composed
from contactlab.cli.table import table
from contactlab.impact.scene import Scene, entry_unit
from contactlab.numeric.checks import refuse
from contactlab.outcome.columns import COLUMNS, csv_heading
from contactlab.outcome.export import WRITERS
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.tables import evenly, sweep_section
from contactlab.scene_file import LawChoice, read_scene

if TYPE_CHECKING:
    from concurrent.futures import Executor

#: Columns that are printed.
SHOWN = ("psi1", "chi", "psi2", "status")
#: Rows that are printed of a sweep that is written to a file.
MOST_ROWS = 25


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the scenes, the laws and the outputs."""
    parser.add_argument("scene", nargs="?", metavar="SCENE.toml", help="a sweep, instead of ranges")
    add_ranges(parser)
    shared.add_laws(parser)
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print JSON instead of the table")
    form.add_argument("--csv", action="store_true", help="print psi1, chi, psi2 as CSV")
    parser.add_argument("--out", type=shared.file_of(*WRITERS), metavar="FILE")
    parser.add_argument(
        "--resume",
        action="store_true",
        help="keep what is done beside the file of --out, and go on where such a sweep stopped",
    )
    parser.add_argument("--workers", type=int, metavar="N", help="share the work among N processes")
    shared.add_figure(parser, "also draw psi2 over psi1")
    shared.add_progress(parser)


def execute(arguments: argparse.Namespace) -> int:
    """Run the sweep and report; 1 if an impact was not followed to its end."""
    file = read_scene(arguments.scene) if arguments.scene else None
    check_alone(arguments)
    scene = file.scene if file else _ranges(arguments.psi1, arguments.chi)
    if not scene.shape:
        raise ValueError(f"{arguments.scene}: holds a single impact; use contactlab run")
    simulation = composed(arguments, file.laws if file else LawChoice())
    keep = _folder(arguments.out) if arguments.resume else None
    before = 0 if keep is None else _done(keep)
    with (
        shared.progress(arguments.progress, "impacts") as progress,
        contextlib.redirect_stdout(sys.stderr),  # what a plug-in prints is not our output
        _executor(arguments.workers) as executor,
    ):
        result = simulation.sweep(scene, progress=progress, executor=executor, keep=keep)
    if before:
        print(f"contactlab sweep: {before} impacts were done before", file=sys.stderr)
    saved = shared.save(
        (arguments.out, lambda path: WRITERS[path.suffix.lower()](result, path)),
        (arguments.figure, lambda path: draw(path, result, **shared.look(arguments))),
        progress_wanted=arguments.progress,
    )
    if keep is not None and saved == shared.OK:
        _clear(keep, result)
    varied = file.varied if file else {}
    if arguments.csv:
        units = {column.name: column.unit for column in COLUMNS}
        print(",".join(csv_heading(name, units[name], result.scene) for name in SHOWN))
        for psi1, chi, psi2, status in _rows(result):
            print(f"{psi1!r},{chi!r},{psi2!r},{status}")
    elif not arguments.json:
        _print_table(result, varied, arguments.out)
    return max(saved, report(result, as_json=arguments.json, varied=varied))


def _print_table(result: ImpactResult, varied: Mapping[str, Any], out: Path | None) -> None:
    """Print a row an impact; of many that are in a file, some that are evenly spread."""
    most = None if out is None else MOST_ROWS
    if varied:
        shown = {name: (entry_unit(name), values) for name, values in varied.items()}
        print(table(*sweep_section(result, shown, most=most)))
    else:
        rows = _rows(result)
        print(table(SHOWN, [rows[index] for index in evenly(len(rows), most)]))
    if most is not None and len(result) > most:
        print(f"{most} of {len(result)} impacts; all of them are in {out}")


def _executor(count: int | None) -> AbstractContextManager[Executor | None]:
    """Return processes for the work; None for this one."""
    if count is None:
        return contextlib.nullcontext()
    from contactlab.compose.workers import processes  # only for those who ask for some

    return processes(count)


def _folder(out: Path | None) -> Path:
    """Return the folder beside ``out`` where a sweep is kept until it is done."""
    if out is None:
        raise ValueError("--resume: needs --out FILE; what is done is kept beside it")
    return out.with_name(f"{out.name}.kept")


def _done(folder: Path) -> int:
    """Return how many impacts are there from before."""
    from contactlab.compose.kept import count

    return count(folder)


def _clear(folder: Path, result: ImpactResult) -> None:
    """Delete what was kept of a sweep that is done; what is to be tried again needs the rest."""
    from contactlab.compose.kept import TRIED_AGAIN, remove

    if not any(status in TRIED_AGAIN for status in result.status):
        remove(folder)


def _ranges(psi1: Any, chi: Any) -> Scene:
    """Return every psi1 with every chi, psi1 varying fastest."""
    if psi1 is None or chi is None:
        missing = " and ".join(n for n, v in (("--psi1", psi1), ("--chi", chi)) if v is None)
        raise ValueError(f"{missing}: must be given, or a sweep file")
    if np.size(psi1) * np.size(chi) > MOST_IMPACTS:
        raise refuse(
            "--psi1, --chi", np.size(psi1) * np.size(chi), f"at most {MOST_IMPACTS} impacts"
        )
    return Scene.grid(chi=np.atleast_1d(chi), psi1=np.atleast_1d(psi1))


def _rows(result: ImpactResult) -> list[tuple[float, float, float, str]]:
    shape = result.scene.shape
    columns = [
        np.broadcast_to(np.asarray(column), shape).tolist()
        for column in (result.psi1, result.scene.chi, result.psi2)
    ]
    names = [status.name for status in result.status]
    return list(zip(*columns, names, strict=True))
