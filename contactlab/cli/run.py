"""Run one impact or a range: velocities, energy, plan and status.

Examples
--------
  contactlab run --psi1 1.2 --chi 1.4412
  contactlab run examples/steel_ball.toml --tangential coulomb
  contactlab run examples/steel_ball.toml --tangential annulus --history force.csv
  contactlab run examples/sweep.toml --out sweep.csv
  contactlab run --psi1 0:7:8 --chi 1.4412
  contactlab run --psi1 1.2 --chi 1.4412 --stick-slip map.png --style slides
  contactlab run --psi1 1.2 --chi 1.4412 --json
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import attrs
import numpy as np

from contactlab.cli import arguments as shared
from contactlab.cli.describe import describe
from contactlab.cli.scene import add_scene, inputs
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab.outcome import export
from contactlab.outcome.columns import json_value
from contactlab.outcome.export import WRITERS
from contactlab.outcome.numerical_error import error_cautions
from contactlab.outcome.result import ImpactResult
from contactlab.registration.hooks import Execute, hookimpl

if TYPE_CHECKING:
    from contactlab.collisions.collision import Collision


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the scene, the laws and the outputs."""
    add_scene(parser, ranges=True)
    shared.add_forms(parser)
    shared.add_file(parser, "--out", *WRITERS, words="also write .json, .csv or .npz")
    words = "also write the history of a single impact"
    shared.add_file(parser, "--history", ".csv", words=words)
    shared.add_figure(parser, "also draw the forces over the contact, or psi2 over psi1")
    words = "also draw regions of stick and slip over the contact of a single impact"
    shared.add_file(parser, "--stick-slip", *shared.PICTURES, words=words)
    parser.add_argument(
        "--estimate-error",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="estimate the numerical error of a single impact by finer runs (the default)",
    )
    shared.add_progress(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Run and report; the status is 1 if an impact failed."""
    file, scene, simulation = inputs(arguments)
    if file is not None and file.gathering is not None:
        from contactlab.cli.gathering import run  # few files need it

        return run(arguments, file)
    for name in ("history", "stick_slip"):
        if getattr(arguments, name) and scene.shape:
            option = name.replace("_", "-")
            raise ValueError(
                f"--{option}: needs a single impact, this scene is a sweep; leave out --{option}"
            )
    with shared.working(arguments.progress, "impacts" if scene.shape else "impact") as progress:
        if scene.shape:
            result = simulation.sweep(scene, progress=progress, return_partial=True)
        else:
            history = bool(arguments.history or arguments.figure)
            result = simulation.run(
                scene,
                history="fields" if arguments.stick_slip else history,
                estimate_error=arguments.estimate_error,
            )
    varied: Mapping[str, Real] = file.varied if file else _find_ranges(arguments, scene)
    encounter = file.encounter if file else None
    collision = None
    if encounter is not None:
        from contactlab.collisions.collision import Collision  # only for vectors

        collision = Collision.of(encounter, result)
    if collision is not None:  # it knows more than the scene: contact vectors
        result = attrs.evolve(result, plan=collision.plan)
    saved = shared.save(
        (arguments.out, lambda path: WRITERS[path.suffix.lower()](result, path)),
        (arguments.history, lambda path: export.write_history_csv(result, path)),
        (arguments.figure, lambda path: draw(path, result, **shared.look(arguments))),
        (arguments.stick_slip, lambda path: draw_map(path, result, **shared.look(arguments))),
        progress_wanted=arguments.progress,
        interrupted=was_interrupted(result),
    )
    if arguments.csv:  # no plan is shown
        shared.tell_cautions(error_cautions(result))
        shared.tell_normal_spin(result.scene, simulation)
        export.print_csv(result, sys.stdout)
    elif not arguments.json:
        title = file.title if file else ""
        print(describe(result, title=title, varied=varied, collision=collision))
    status = report(result, as_json=arguments.json, varied=varied, collision=collision)
    return max(saved, status)


def _find_ranges(arguments: argparse.Namespace, scene: Scene) -> dict[str, Real]:
    """Return the ranges of the arguments by name, each of the scene's shape."""
    groups = {"psi1": scene.psi1, "chi": scene.chi}
    return {name: value for name, value in groups.items() if np.ndim(getattr(arguments, name))}


def draw(path: Path, result: ImpactResult, **look: Unpack[shared.Drawing]) -> None:
    """Draw a result with its ``plot``; ``look`` as in ``arguments.look``."""
    from contactlab.figures.files import save  # matplotlib only when drawing

    save(path, lambda axes: result.plot(axes=axes), **look)


def draw_map(path: Path, result: ImpactResult, **look: Unpack[shared.Drawing]) -> None:
    """Draw the map of stick and slip of an impact."""
    from contactlab.figures.files import save  # matplotlib only when drawing
    from contactlab.figures.stick_slip import draw_stick_slip

    save(path, lambda axes: draw_stick_slip(axes, result), **look)


def report(
    result: ImpactResult,
    *,
    as_json: bool,
    varied: Mapping[str, Real],
    collision: Collision | None = None,
) -> int:
    """Print JSON if ``as_json``, report failures on stderr, and return the exit status."""
    if as_json:
        content = result.to_dict() | {"varied": json_value(varied)}
        if collision is not None:
            content["collision"] = collision.vectors()
        shared.print_json(content)
        shared.tell_cautions(error_cautions(result))
    failures = result.failures
    if not failures:
        return shared.OK
    interrupted = was_interrupted(result)
    which = f"{len(failures)} of {len(result)} impacts: " if result.scene.shape else ""
    word = "interrupted" if interrupted else "failed"
    print(f"contactlab: {word}: {which}{next(iter(failures.values()))}", file=sys.stderr)
    return shared.INTERRUPTED if interrupted else shared.FAILED


def was_interrupted(result: ImpactResult) -> bool:
    """Return whether Ctrl-C left impacts out."""
    return Status.INTERRUPTED in np.ravel(np.array(result.status, dtype=object))
