"""Impacts of any two bodies for run, sweep and compare: words, tables and rows."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np

from contactlab.cli import arguments as shared
from contactlab.cli.describe import in_space
from contactlab.compose.body_collision import BodyCollision
from contactlab.compose.simulation import Simulation
from contactlab.impact.scene import entry_unit
from contactlab.outcome.columns import ECCENTRIC_COLUMNS, components, json_value, unit_in
from contactlab.outcome.eccentric import EccentricResult
from contactlab.outcome.numerical_error import error_cautions
from contactlab.outcome.tables import answer, closing, evenly, heading, largest_imbalance
from contactlab.outcome.tables import time as time_words
from contactlab.outcome.text_table import table
from contactlab.scene_file import SceneFile

#: Columns of the table of a sweep.
SWEEP = ("psi1", "normal_velocity", "psi2", "compressions", "friction_work", "status")
#: Columns of the table of one impact that stand before and after the impact.
MOVING = (
    ("psi", "psi1", "psi2", "1"),
    ("slip velocity", "slip_velocity", "rebound_slip_velocity", "m/s"),
)
#: Options of compare that have no meaning for an eccentric impact.
SPHERES_ONLY = ("figure", "loops", "csv", "quantity", "measured", "estimate_error")


def describe(
    result: EccentricResult,
    *,
    title: str,
    varied: Mapping[str, Any],
    collision: BodyCollision | None,
) -> str:
    """Return the report of one impact or a sweep of any two bodies."""
    ending = "\n".join(f"{name + ':':9} {words}" for name, words in closing(result))
    if result.scene.shape:
        body = [sweep_table(result, varied), largest_imbalance(result)]
    else:
        lines = "\n".join(f"{name:24} {words}" for name, words in answer(result)[1:])
        body = [lines, _one(result)]
        if collision is not None:
            body.insert(1, in_space(collision))
    cautions = "\n".join(f"caution:  {text}" for text in error_cautions(result))
    parts = [title, *body, cautions, str(result.plan), ending]
    return "\n\n".join(part for part in parts if part)


def _one(result: EccentricResult) -> str:
    """Return velocities, contact and energy of one impact."""
    scene, energy = result.scene, result.energy
    speed = float(np.asarray(scene.normal_speed))
    velocity = [["normal velocity", speed, speed * result.normal_velocity, unit_in("m/s", scene)]]
    for name, before, after, unit in MOVING:
        pairs = [*zip(_parts(result, before), _parts(result, after), strict=True)]
        for place, ((_, one), (_, other)) in enumerate(pairs, start=1):
            shown = name if len(pairs) == 1 else f"{name} along t{place}"
            velocity.append([shown, float(one), float(other), unit_in(unit, scene)])
    contact: list[list[Any]] = [
        *(
            [name, float(value), "1"]
            for key in ("chi", "lam", "eta")
            for name, value in _parts(result, key)
        ),
        ["V2, rebound over approach", result.normal_velocity, "1"],
        ["compressions", float(result.compressions), "1"],
        ["contact time", float(result.motion.duration), unit_in("s", scene)],
        ["largest normal force", float(result.motion.maximum_force), unit_in("N", scene)],
    ]
    books: list[list[Any]] = [
        [name.replace("_", " "), float(getattr(energy, name)), unit_in("J", scene)]
        for name in ("start", "end", "normal_loss", "friction_work", "imbalance")
    ]
    return "\n\n".join(
        (
            table(["", "before", "after", "unit"], velocity),
            table(["contact", "value", "unit"], contact),
            table(["energy", "value", "unit"], books),
        )
    )


def _parts(result: EccentricResult, name: str) -> list[tuple[str, Any]]:
    """Return the components of a column by name; in the plane the slip has only one."""
    column = next(each for each in ECCENTRIC_COLUMNS if each.name == name)
    found = components(name, column.read(result), result.scene.shape)
    return found[:1] if result.scene.planar and "slip" in name else found


def sweep_table(
    result: EccentricResult, varied: Mapping[str, Any], *, most: int | None = None
) -> str:
    """Return one row for each impact, or for at most ``most``, evenly spread with both ends."""
    columns = {heading(name, entry_unit(name)): np.asarray(each) for name, each in varied.items()}
    for name in SWEEP[:-1]:
        column = next(each for each in ECCENTRIC_COLUMNS if each.name == name)
        for part, values in components(name, column.read(result), result.scene.shape):
            if part not in varied:
                columns[heading(part, unit_in(column.unit, result.scene))] = np.asarray(values)
    names = [status.name for status in np.ravel(np.array(result.status, dtype=object))]
    rows = [
        [*(float(np.broadcast_to(values, len(names))[row]) for values in columns.values()), name]
        for row, name in [(row, names[row]) for row in evenly(len(names), most)]
    ]
    return table([*columns, "status"], rows)


def compare(
    arguments: argparse.Namespace, file: SceneFile, compared: Mapping[str, Simulation]
) -> int:
    """Run laws on the scene of a file, print a row for each, and name those without an answer."""
    for name in SPHERES_ONLY:
        if getattr(arguments, name):
            option = f"--{name.replace('_', '-')}"
            raise ValueError(f"{option}: is for impacts of spheres; leave out {option}")
    rows: list[list[Any]] = []
    found: dict[str, EccentricResult] = {}
    failures = []
    for name, simulation in compared.items():
        try:
            result: Any = simulation.run(file.scene)
        except ValueError as error:
            reason = str(error).partition("; take ")[0]
            print(f"contactlab compare: {name} is left out: {reason}", file=sys.stderr)
            continue
        took = result.run_time / np.size(result.normal_velocity)
        found[name] = result
        failures += [f"{name}: {sentence}" for sentence in [*result.failures.values()][:1]]
        rows.append([name, *_scores(result, next(iter(found.values()))), time_words(took)])
    if arguments.json:
        told = {
            name: {
                key: json_value(np.asarray(getattr(result, key)))
                for key in ("normal_velocity", "psi2", "compressions")
            }
            for name, result in found.items()
        }
        shared.print_json({"title": file.title, "varied": json_value(file.varied), "laws": told})
    else:
        print("\n\n".join(filter(None, [file.title, table(_headings(file.scene), rows)])))
    shared.tell_normal_spin(file.encounter)
    for sentence in failures:
        print(f"contactlab compare: failed: {sentence}", file=sys.stderr)
    return shared.FAILED if failures or not found else shared.OK


def _headings(scene: Any) -> list[str]:
    """Return the headings of a comparison: values of one impact, distances over a sweep."""
    if scene.shape:
        return ["law", "V2: rms", "worst", "psi2: rms", "worst", "friction work / start", "time"]
    slip = ["psi2"] if scene.planar else ["psi2_1", "psi2_2"]
    return ["law", "V2", *slip, "compressions", "friction work / start", "time"]


def _scores(result: EccentricResult, reference: EccentricResult) -> list[float]:
    """Return values of one impact, or distances over a sweep from the first law's answers."""
    books = result.energy
    work = float(np.nanmean(np.asarray(books.friction_work) / np.asarray(books.start)))
    if not result.scene.shape:
        slip = np.atleast_1d(np.asarray(result.psi2)).tolist()
        return [result.normal_velocity, *slip, float(result.compressions), work]
    told = []
    for name in ("normal_velocity", "psi2"):
        apart = np.abs(np.asarray(getattr(result, name)) - np.asarray(getattr(reference, name)))
        apart = apart if apart.ndim == len(result.scene.shape) else np.linalg.norm(apart, axis=-1)
        told += [float(np.sqrt(np.mean(apart**2))), float(np.max(apart))]
    return [*told, work]
