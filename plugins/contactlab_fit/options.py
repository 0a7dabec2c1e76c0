"""Options of ``compare`` and ``report``: a file of measured impacts, and names of its columns."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from contactlab.registration.hooks import hookimpl
from contactlab.scene_file import SceneFile

if TYPE_CHECKING:
    from contactlab_fit.conventions import Result
    from contactlab_fit.fit_result import Fit
    from contactlab_fit.measurements import Measurements


def add_columns(parser: argparse.ArgumentParser) -> None:
    """Add ``--column`` and ``--columns``, names for headings of a CSV of measured impacts."""
    parser.add_argument(
        "--column",
        type=_column,
        action="append",
        default=[],
        metavar="HEADING=NAME",
        help="name a column of the CSV: 'impact angle [deg]=incidence_angle'. A - before the name "
        "changes the sign; 'remark=#' skips the column. May be repeated",
    )
    parser.add_argument(
        "--columns",
        type=_columns,
        metavar="A,B,...",
        help="names of all columns of the CSV, in order: 'angle_deg,speed (mph),#'; # skips a "
        "column",
    )


def _columns(text: str) -> list[str]:
    return [name.strip() for name in text.split(",")]


def read_impacts(
    data: str | Path | SceneFile,
    arguments: argparse.Namespace,
    fit_of: Callable[[Measurements], Fit] | None = None,
) -> Measurements:
    """Return measured impacts, with the names of columns; a refusal has the command to paste.

    The message lists each reading of ambiguous headings with the result of ``fit_of``.
    """
    from contactlab_fit import measurements  # only for measured impacts

    if arguments.columns and arguments.column:
        raise ValueError("--column: --columns names all columns already; leave out --column")
    names = arguments.columns or dict(arguments.column)
    headings = [heading for heading, _ in arguments.column]
    if twice := sorted(name for name in set(headings) if headings.count(name) > 1):
        raise ValueError(f"--column: {twice[0]!r} is named twice; leave out one")
    read = partial(measurements.read_measurements, data)
    return read_named(read, names, arguments, fit_of)


def read_named(
    read: Callable[..., Measurements],
    names: Mapping[str, str] | list[str],
    arguments: argparse.Namespace,
    fit_of: Callable[[Measurements], Fit] | None,
) -> Measurements:
    """Return ``read(columns=names)``; a refusal has the command to paste."""
    from contactlab_fit.conventions import ForeignHeadingsError

    try:
        return read(columns=names)
    except ForeignHeadingsError as error:
        command = f"contactlab {shlex.join(arguments.words)}"
        gives: list[Result] = []
        if fit_of is not None and isinstance(names, Mapping):
            from contactlab_fit.printed import tell_readings

            def fit(columns: Mapping[str, str]) -> Fit:
                return fit_of(read(columns={**names, **columns}))

            gives = tell_readings(error.readings, fit)
        raise ForeignHeadingsError(error.said, error.readings, command, gives) from None


def _column(text: str) -> tuple[str, str]:
    """Return the heading and the name in ``"impact angle [deg]=incidence_angle"``."""
    heading, _, name = text.rpartition("=")
    if not heading.strip() or not name.strip():
        raise argparse.ArgumentTypeError(f"{text!r}: write HEADING=NAME")
    return heading.strip(), name.strip()


def add_measured(parser: argparse.ArgumentParser) -> None:
    """Add ``--measured``, ``--column`` and ``--columns``."""
    parser.add_argument(
        "--measured",
        type=Path,
        metavar="DATA.csv",
        help="measured impacts to set beside the laws, with the headings of contactlab fit",
    )
    add_columns(parser)


@hookimpl
def contactlab_options(command: str, parser: argparse.ArgumentParser) -> None:
    """Add ``--measured`` to the commands that set laws beside measured values."""
    if command in ("compare", "report"):
        add_measured(parser)


@hookimpl
def contactlab_scene_file(
    arguments: argparse.Namespace, read: Callable[..., SceneFile]
) -> SceneFile | None:
    """Return a scene file with the values of ``--measured`` in place of its own."""
    if arguments.measured is None:
        if arguments.column or arguments.columns:
            option = "--columns" if arguments.columns else "--column"
            raise ValueError(f"{option}: names headings of --measured DATA.csv, which is missing")
        return None
    if not arguments.scene:
        raise ValueError("--measured: needs a SCENE.toml with the bodies of the experiment")
    from contactlab_fit import beside  # only for --measured

    table = read_impacts(arguments.measured, arguments)
    for note in table.notes:
        print(f"contactlab: note: {note}", file=sys.stderr)
    file = read(defaults=beside.first_velocities(table))
    return beside.with_measurements(file, table)
