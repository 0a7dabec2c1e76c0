"""A result in words and tables, for reading."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np

from contactlab.bodies import Sphere
from contactlab.cli.table import number, table, time
from contactlab.collision import Collision
from contactlab.export import SWEEP_TABLE, VECTORS
from contactlab.quantities import QUANTITIES
from contactlab.result import ImpactResult
from contactlab.scene_file.entries import entry_unit
from contactlab.status import Status

#: Different sentences about failed impacts that are shown.
SENTENCES = 3

Row = list[Any]


def describe(
    result: ImpactResult,
    *,
    title: str = "",
    varied: Mapping[str, Any],
    collision: Collision | None = None,
) -> str:
    """Return the whole report of one impact, or of a sweep.

    Parameters
    ----------
    result : ImpactResult
    title : str
    varied : mapping of str to array
        What a sweep varies.
    collision : Collision, optional
        Both bodies in space, where the scene was given by vectors.
    """
    plan = result.plan
    if result.scene.shape:
        body = _sweep(result, varied)
    else:
        body = [
            answer(result),
            _table(result, ["", "before", "after", "unit"], _velocities(result)),
            _table(result, ["contact", "value", "unit"], _contact(result)),
            _table(result, ["energy", "value", "unit"], _energy(result)),
        ]
        if collision is not None:
            rows = _space(collision)
            body.insert(1, table(["in space", "before", "after", "unit"], rows))
            plan = collision.plan
    return "\n\n".join([title] * bool(title) + [*body, str(plan), _closing(result)])


def answer(result: ImpactResult) -> str:
    """Return the answer, its numerical error and its run time, a line each."""
    estimate, declared = result.psi2_error_estimate, float(np.asarray(result.plan.psi2_error))
    known = []
    if estimate is not None and np.isfinite(estimate) and float(estimate) != declared:
        known.append(f"about {float(estimate):.1g}, estimated")
    if np.isfinite(declared):
        known.append(f"at most {declared:.1g}, declared")
    lines = [
        ("psi2", number(result.psi2, digits=10)),
        ("numerical error of psi2", "; ".join(known) or "not known"),
        ("run time", time(result.run_time)),
    ]
    return "\n".join(f"{name:24} {value}" for name, value in lines)


def _table(result: ImpactResult, headings: list[str], rows: list[Row]) -> str:
    """Return a table without the rows that are undefined; the paper's scenes have no units."""
    shown = []
    for *cells, unit in rows:
        if None not in cells:
            unit = "1" if result.scene.sphere is None else unit
            shown.append([c if isinstance(c, str) else float(c) for c in cells] + [unit])
    return table(headings, shown)


def _space(collision: Collision) -> list[Row]:
    """Return the vectors of both bodies, and the impulse."""
    rows: list[Row] = []
    for name, unit in VECTORS:
        before = getattr(collision.encounter, name, None)
        told = "" if before is None else _vector(before)
        rows.append([name.replace("_", " "), told, _vector(getattr(collision, name)), unit])
    return rows


def _vector(numbers: Any) -> str:
    return f"({', '.join(f'{each:.6g}' for each in numbers.tolist())})"


def _velocities(result: ImpactResult) -> list[Row]:
    scene, bodies = result.scene, result.scene.sphere is not None
    after = QUANTITIES["rebound_angle_deg"].read(result)
    rows: list[Row] = [
        ["local angle psi", scene.psi1, result.psi2, "1"],
        ["local tangential velocity", scene.slip_velocity, result.rebound_slip_velocity, "m/s"],
        ["normal velocity", scene.normal_speed, result.rebound_normal_velocity, "m/s"],
        [
            "tangential velocity",
            scene.tangential_velocity,
            result.rebound_tangential_velocity,
            "m/s",
        ],
        ["spin", scene.spin, result.rebound_spin, "rad/s"],
        ["angle of the path", np.degrees(result.incidence_angle), after, "deg"],
    ]
    if isinstance(scene.target, Sphere):
        rows += [
            ["target: normal velocity", 0.0, result.target_rebound_normal_velocity, "m/s"],
            ["target: tangential velocity", 0.0, result.target_rebound_tangential_velocity, "m/s"],
            ["target: spin", 0.0, result.target_rebound_spin, "rad/s"],
        ]
    return rows if bodies else rows[:3]


def _contact(result: ImpactResult) -> list[Row]:
    scene, motion = result.scene, result.motion
    rows: list[Row] = [
        ["chi", scene.chi, "1"],
        ["normal restitution e", result.normal_restitution, "1"],
        ["tangential restitution e_t", result.tangential_restitution, "1"],
        ["contact time", motion.duration, "s"],
        ["largest contact radius", motion.maximum_radius, "m"],
        ["largest contact radius over R, C (9)", motion.maximum_radius / scene.pair.radius, "1"],
        ["largest normal force", motion.maximum_force, "N"],
    ]
    return rows if scene.sphere is not None else rows[:4]


def _energy(result: ImpactResult) -> list[Row]:
    energy = result.energy
    return [
        ["start", energy.start, "J"],
        ["end", energy.end, "J"],
        ["loss of the normal motion", energy.normal_loss, "J"],
        ["friction work, added up", energy.friction_work, "J"],
        ["imbalance", energy.imbalance, "J"],
        ["imbalance / start", energy.relative_imbalance, "1"],
    ]


def _sweep(result: ImpactResult, varied: Mapping[str, Any]) -> list[str]:
    columns = {_heading(name, entry_unit(name)): values for name, values in varied.items()}
    for name in SWEEP_TABLE:
        values = QUANTITIES[name].of(result)
        if name not in varied and not np.isnan(values).all():
            columns[_heading(name, QUANTITIES[name].unit_in(result.scene))] = values
    statuses = np.array(result.status, dtype=object)
    rows = [
        [*(float(values[index]) for values in columns.values()), statuses[index].name]
        for index in range(len(result))
    ]
    imbalance = float(np.max(np.abs(result.energy.relative_imbalance)))
    note = f"largest energy imbalance / start: {number(imbalance, digits=3)}"
    return [table([*columns, "status"], rows), note]


def _heading(name: str, unit: str) -> str:
    return name if unit == "1" else f"{name} ({unit})"


def _closing(result: ImpactResult) -> str:
    laws = [f"{name} [{kind}]" for kind, name in result.laws.items()]
    counters = ", ".join(f"{count} {key}" for key, count in result.counters.items()) or "none"
    impacts = f" for {len(result)} impacts" if result.scene.shape else ""
    lines = [f"laws:     {', '.join(laws)}", f"counters: {counters}"]
    if result.scene.shape:
        lines += [f"run time: {time(result.run_time)}{impacts}"]
    failures = Counter(result.failures.values())
    if failures.total() < np.size(result.status):
        lines += [f"status:   {Status.SUCCESS.value}"]
    for sentence, count in failures.most_common(SENTENCES):
        lines += [f"status:   {sentence}" + (f" ({count} impacts)" if count > 1 else "")]
    if len(failures) > SENTENCES:
        lines += [f"status:   ... and {len(failures) - SENTENCES} more sentences"]
    return "\n".join(lines)
