"""Run many impacts: a sweep file, or ranges of psi1 and chi.

Examples
--------
  contactlab sweep --psi1 0:7:71 --chi 1.4412
  contactlab sweep --psi1 1.2 --chi 0.5:8:76 --tangential coulomb --csv
  contactlab sweep examples/sweep.toml --out sweep.npz
  contactlab sweep --psi1 0:7:100000 --chi 1.4412 --workers 2 --out sweep.npz --resume
  contactlab sweep --psi1 0:7:10000 --chi 0.5:2:1000 --out sweep/
  contactlab sweep --psi1 0:7:10000 --chi 0.5:2:1000 --out sweep.parquet/
"""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contactlab.cli import arguments as shared
from contactlab.cli.run import draw, report, was_interrupted
from contactlab.cli.scene import (
    add_file,
    add_groups,
    check_alone,
    compose_laws,
    grid,
    grid_entries,
    read,
)
from contactlab.contracts.status import Status, succeeded
from contactlab.impact.grid import GridParts
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab.outcome.answer import ImpactError
from contactlab.outcome.chunk_forms import form_of
from contactlab.outcome.columns import components, csv_heading
from contactlab.outcome.export import WRITERS
from contactlab.outcome.files import unwritable
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.tables import evenly, sweep_section
from contactlab.outcome.text_table import table
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.scene_file import LawChoice, SceneFile

if TYPE_CHECKING:
    from concurrent.futures import Executor

#: Printed columns.
SHOWN = ("psi1", "chi", "psi2")
#: Most impacts in a folder, some 120 GB: a typing error must not fill the disk.
MOST_IN_A_FOLDER = 1_000_000_000
#: Statuses of impacts that were not computed.
NOT_COMPUTED = (Status.INTERRUPTED, Status.WORKER_DIED)
#: Most rows printed of a sweep that a file holds.
MOST_ROWS = 25


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the scenes, the laws and the outputs."""
    add_file(parser, "a sweep, instead of ranges")
    add_groups(parser)
    shared.add_laws(parser)
    shared.add_forms(parser)
    words = (
        f"{', '.join(WRITERS)}; or a folder/, for more impacts than memory holds (folder.parquet/ "
        "writes Parquet). A stopped sweep continues in its folder"
    )
    parser.add_argument("--out", type=_output, metavar="FILE or FOLDER/", help=words)
    words = "keep finished impacts beside --out, and continue a stopped sweep"
    parser.add_argument("--resume", action="store_true", help=words)
    parser.add_argument(
        "--workers", type=shared.whole_number, metavar="N", help="share the work among N processes"
    )
    shared.add_figure(parser, "also draw psi2 over psi1")
    shared.add_progress(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Run the sweep and report; the status is 1 if an impact failed."""
    file = read(arguments)
    check_alone(arguments)
    if file is not None and file.gathering is not None:
        from contactlab.cli.gathering import sweep  # few files need it

        return sweep(arguments, file)
    if file and not file.scene.shape:
        raise ValueError(f"{arguments.scene}: holds a single impact; use contactlab run")
    if arguments.out is not None and arguments.out.suffix.lower() not in WRITERS:
        return _into_folder(arguments, file)
    scene = file.scene if file else grid(arguments.psi1, arguments.chi)
    simulation = compose_laws(arguments, file.laws if file else LawChoice())
    keep = _folder(arguments.out) if arguments.resume else None
    before = 0 if keep is None else _count_before(keep)
    with (
        shared.working(arguments.progress, "impacts") as progress,
        _executor(arguments.workers) as executor,
    ):
        result = simulation.sweep(
            scene, progress=progress, executor=executor, keep=keep, return_partial=True
        )
    if before:
        print(f"contactlab sweep: {before} impacts were done before", file=sys.stderr)
    varied = file.varied if file else {}
    shared.tell_normal_spin(scene, simulation)
    written: list[Path] = []

    def write(path: Path) -> None:
        WRITERS[path.suffix.lower()](result, path)
        written.append(path)

    saved = shared.save(
        (arguments.out, write),
        (arguments.figure, lambda path: draw(path, result, **shared.look(arguments))),
        progress_wanted=arguments.progress,
        interrupted=was_interrupted(result),
    )
    if keep is not None and saved == shared.OK and _count_before(keep) == len(result):
        from contactlab.runs.kept import remove  # only with --resume

        remove(keep)
        keep = None
    if arguments.csv:
        names, rows = _rows(result)
        units = ["1"] * (len(names) - 1) + [""]
        print(",".join(csv_heading(*each, result.scene) for each in zip(names, units, strict=True)))
        for *numbers, status in rows:
            print(",".join([*map(repr, numbers), status]))
    elif not arguments.json:
        _print_table(result, varied, *written)
        if arguments.out and not written:
            print(f"all {len(result)} impacts; {arguments.out} is not written")
    failed = report(result, as_json=arguments.json, varied=varied)
    if keep is not None:
        words = f"{_count_before(keep)} impacts are kept in {keep}; repeat the command to continue"
        print(f"contactlab sweep: {words}", file=sys.stderr)
    return max(saved, failed)


def _output(text: str) -> Path:
    """Return the path of a file to write, or of a folder, whose name ends with a slash."""
    if not text.endswith(("/", os.sep)) and not os.path.isdir(text):
        try:
            return shared.file_of(*WRITERS)(text)
        except argparse.ArgumentTypeError as error:
            raise argparse.ArgumentTypeError(f"{error}, or name a folder, {text}/") from None
    path = Path(text)
    if path.suffix.lower() in WRITERS:
        raise argparse.ArgumentTypeError(f"{text!r}: a folder must not end as a file does")
    if why_not := unwritable(path.absolute().parent / "file"):
        raise argparse.ArgumentTypeError(f"{text!r}: {why_not}")
    try:
        form_of(path)
    except ImportError as error:
        raise argparse.ArgumentTypeError(f"{text!r}: {error}") from None
    return path


def _into_folder(arguments: argparse.Namespace, file: SceneFile | None) -> int:
    """Sweep into a folder, and report what is in it; the status is 1 if an impact failed."""
    for name in ("json", "csv", "figure"):
        if getattr(arguments, name):
            rule = f"--{name}: needs all impacts in memory; leave it out, or name a file with --out"
            raise ValueError(rule)
    scenes: Scene | GridParts
    if file:
        scenes = file.scene
    else:
        psi1, chi = arguments.psi1, arguments.chi
        entries = grid_entries(psi1, chi, most=MOST_IN_A_FOLDER, remedy="vary less")
        scenes = Scene.grid_in_parts(chi=entries["chi"], psi1=entries["psi1"])
    simulation = compose_laws(arguments, file.laws if file else LawChoice())
    with (
        shared.working(arguments.progress, "impacts") as progress,
        _executor(arguments.workers) as executor,
    ):
        folder = simulation.sweep(
            scenes, progress=progress, executor=executor, into=arguments.out, return_partial=True
        )
    print(folder)
    if failed := len(folder) - folder.statuses.get(Status.SUCCESS.name, 0):
        try:
            folder.check()  # which reads the first failure alone
        except ImpactError as error:
            print(
                f"contactlab: failed: {failed} of {len(folder)} impacts: {error}", file=sys.stderr
            )
        return shared.FAILED
    return shared.OK if folder.complete else shared.INTERRUPTED


def _print_table(result: ImpactResult, varied: Mapping[str, Real], out: Path | None = None) -> None:
    """Print one row for each impact; evenly spread rows if the file ``out`` holds all."""
    most = None if out is None else MOST_ROWS
    if varied:
        print(table(*sweep_section(result, varied, most=most)))
    else:
        print(table(*_rows(result, evenly(len(result), most))))
    if most is not None and len(result) > most:
        done = _count_new(result)
        which = "all of them" if done == len(result) else f"the {done} finished ones"
        print(f"{most} of {len(result)} impacts; {which} are in {out}")


def _executor(count: int | None) -> AbstractContextManager[Executor | None]:
    """Return a context with worker processes, or with None for no ``count``."""
    if count is None:
        return contextlib.nullcontext()
    from contactlab.runs.workers import processes  # only for --workers

    return processes(count)


def _folder(out: Path | None) -> Path:
    """Return the folder beside ``out`` for the finished impacts of a sweep."""
    if out is None:
        raise ValueError("--resume: needs --out FILE; finished impacts are kept beside this file")
    return out.with_name(f"{out.name}.kept")


def _count_before(folder: Path) -> int:
    """Return the number of impacts that an earlier run finished."""
    from contactlab.runs.target import count

    return count("--resume", folder)


def _count_new(result: ImpactResult) -> int:
    """Return the number of impacts that were computed."""
    if succeeded(result.status):
        return len(result)
    return sum(status not in NOT_COMPUTED for status in result.status)


def _rows(
    result: ImpactResult, shown: Sequence[int] | None = None
) -> tuple[list[str], list[tuple[Any, ...]]]:
    """Return names and values of the printed columns, one row for each impact, or those shown."""
    shape = result.scene.shape
    named: list[tuple[str, object]] = []
    for name, values in zip(SHOWN, (result.psi1, result.scene.chi, result.psi2), strict=True):
        named += components(name, values, shape)
    places = slice(None) if shown is None else [*shown]
    columns = [np.broadcast_to(np.asarray(values), shape)[places].tolist() for _, values in named]
    statuses = [status.name for status in result.status[places]]
    return [*(name for name, _ in named), "status"], list(zip(*columns, statuses, strict=True))
