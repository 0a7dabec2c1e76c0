"""Several contacts at once on the command line: ``run`` and ``sweep`` of such a scene file."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contactlab.cli import arguments as shared
from contactlab.cli.scene import compose_laws
from contactlab.collisions.collide import collide
from contactlab.collisions.gathered import GatheringResult
from contactlab.collisions.gathering_tables import (
    WRITERS,
    bodies_table,
    contacts_table,
    to_dict,
    write_history_csv,
)
from contactlab.impact.gathering import Gathering
from contactlab.outcome.columns import json_value
from contactlab.outcome.text_table import table
from contactlab.scene_file import LawChoice, SceneFile

#: Options of ``run`` and ``sweep`` for impacts with one contact only.
OF_ONE_CONTACT = ("stick_slip", "restitution", "workers", "resume", "csv")
#: Most gatherings of a batch whose rows are printed.
MOST_ROWS = 25


def run(arguments: argparse.Namespace, file: SceneFile) -> int:
    """Run a gathering, or a batch of a sweep, and report; the status is 1 if one failed."""
    _refuse(arguments)
    gathering = file.gathering
    assert gathering is not None
    history = bool(getattr(arguments, "history", None) or arguments.figure)
    if gathering.shape and history:
        option = "--history" if getattr(arguments, "history", None) else "--figure"
        raise ValueError(f"{option}: needs a single gathering, this scene is a sweep; leave it out")
    with shared.working(arguments.progress, "gatherings"):
        hit: GatheringResult = _answer(arguments, file, gathering, history=history)
    saved = shared.save(
        (arguments.out, lambda path: WRITERS[path.suffix.lower()](hit, path)),
        (getattr(arguments, "history", None), lambda path: write_history_csv(hit, path)),
        (arguments.figure, lambda path: _draw(path, hit, arguments)),
        progress_wanted=arguments.progress,
    )
    return max(saved, _report(arguments, file, hit))


def sweep(arguments: argparse.Namespace, file: SceneFile) -> int:
    """Run a batch of gatherings and report; the status is 1 if one failed."""
    assert file.gathering is not None
    if not file.gathering.shape:
        raise ValueError(f"{arguments.scene}: holds a single gathering; use contactlab run")
    return run(arguments, file)


def _refuse(arguments: argparse.Namespace) -> None:
    """Refuse options for impacts with one contact, and forms of files that gatherings lack."""
    for name in OF_ONE_CONTACT:
        if getattr(arguments, name, None):
            option = name.replace("_", "-")
            rule = "is of impacts with one contact, and the scene has several"
            raise ValueError(f"--{option}: {rule}; leave out --{option}")
    out = arguments.out
    if out is not None and out.suffix.lower() not in WRITERS:
        raise ValueError(f"--out {out}: several contacts go to {' or '.join(WRITERS)}")


def _answer(
    arguments: argparse.Namespace, file: SceneFile, gathering: Gathering, *, history: bool
) -> GatheringResult:
    """Return the outcome, by the laws that file or arguments name, else by its restitutions."""
    named = [arguments.normal, arguments.tangential, arguments.integrator, *arguments.settings]
    simulation = None
    if any(named) or file.laws != LawChoice():
        simulation = compose_laws(arguments, file.laws)
    return collide(gathering, simulation, history=history)


def _draw(path: Path, hit: GatheringResult, arguments: argparse.Namespace) -> None:
    """Draw the forces of the contacts over time."""
    from contactlab.figures.files import save  # matplotlib only when drawing

    save(path, lambda axes: hit.history.plot(axes=axes), **shared.look(arguments))


def _report(arguments: argparse.Namespace, file: SceneFile, hit: GatheringResult) -> int:
    """Print tables or JSON, tell failures on stderr, and return the exit status."""
    if arguments.json:
        varied: Mapping[str, Any] = file.varied
        shared.print_json(to_dict(hit) | {"varied": json_value(varied)})
    else:
        _print(file, hit)
    for sentence in hit.failures.values():
        print(f"contactlab: failed: {sentence}", file=sys.stderr)
        return shared.FAILED
    return shared.OK


def _print(file: SceneFile, hit: GatheringResult) -> None:
    """Print one row for each body and one for each contact, and the plan."""
    if file.title:
        print(file.title)
    for headings, rows in (bodies_table(hit), contacts_table(hit)):
        print(table(headings, rows[:MOST_ROWS]))
        if len(rows) > MOST_ROWS:
            print(f"{MOST_ROWS} of {len(rows)} rows; --out FILE.csv has all")
        print()
    print(hit.plan)
