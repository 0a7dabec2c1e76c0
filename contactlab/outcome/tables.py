"""A result as tables, for a terminal, a notebook or a page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from contactlab.impact import kinetics
from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.cautions import size_of_contact
from contactlab.impact.hertz import semi_axes
from contactlab.impact.scene import Scene, entry_unit
from contactlab.numeric.types import Array, Real
from contactlab.outcome.columns import (
    QUANTITIES,
    SWEEP_TABLE,
    Column,
    columns_of,
    components,
    foreign,
    unit_in,
)
from contactlab.outcome.numerical_error import error_words
from contactlab.outcome.result import ImpactResult

#: Most sentences on failed impacts that are shown.
SENTENCES = 3
#: Entries of a scene that are shown beside its bodies.
SCENE = ("friction_coefficient", "normal_speed", "tangential_velocity", "spin")
#: Vectors in space of bodies that are no spheres, which tables leave to their own section.
IN_SPACE = ("rebound_spin",)
#: In place of an imbalance, where the friction work is what the velocities lose.
CLOSED = "balances by construction"

Row = list[Any]


class Section(NamedTuple):
    """A table: rows of numbers and text under their headings."""

    headings: Sequence[str]
    rows: Sequence[Row]


def number(value: object, *, digits: int = 6) -> str:
    """Return a number as text with ``digits`` significant digits, a dash if undefined."""
    if value is None or (isinstance(value, float | np.floating) and np.isnan(value)):
        return "-"
    if isinstance(value, float | np.floating):
        text = f"{float(value):.{digits}g}"
        return "0" if text == "-0" else text
    return str(value)


def time(seconds: float) -> str:
    """Return a time as text in s, ms, µs or ns."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def answer(result: ImpactResult) -> list[tuple[str, str]]:
    """Return psi2 of one impact, its numerical error and the run time, as (name, words).

    The dimensionless groups of bodies follow.
    """
    groups = _groups(result.scene) if has_bodies(result.scene) else []
    return [
        *((name, number(value)) for name, value in groups),
        *((name, number(value, digits=10)) for name, value in _each("psi2", result.psi2)),
        ("numerical error of psi2", error_words(result)),
        ("run time", time(result.run_time)),
    ]


def scene_section(scene: Scene) -> Section:
    """Return bodies, friction and velocities of a scene, as ranges for a batch."""
    rows: list[Row] = []
    if scene.sphere is not None:
        sphere_target = isinstance(scene.target, Sphere)
        rows += _body("sphere", scene.sphere)
        if scene.target is not None:
            rows += _body("struck sphere" if sphere_target else "half-space", scene.target)
    spins = ("normal_spin",) if kinetics.turns(scene) else ()
    for name in (*SCENE, *spins, *kinetics.groups(scene)):
        unit = unit_in(entry_unit(name), scene)
        for part, values in components(name, getattr(scene, name), scene.shape):
            rows.append([part.replace("_", " "), _range(values), unit])
    return Section(["", "value", "unit"], rows)


def _body(name: str, body: Sphere | HalfSpace) -> list[Row]:
    """Return radius, mass and elastic constants of a body."""
    rows: list[Row] = []
    if isinstance(body, Sphere):
        rows += [[f"{name}: radius", _range(body.radius), "m"]]
        rows += [[f"{name}: mass", _range(body.mass), "kg"]]
    material = body.material
    return [
        *rows,
        [f"{name}: Young's modulus", _range(material.young_modulus), "Pa"],
        [f"{name}: Poisson's ratio", _range(material.poisson_ratio), "1"],
    ]


def _range(value: Real) -> str:
    """Return the least and the greatest value, or the single value of all impacts."""
    low, high = float(np.min(value)), float(np.max(value))
    return number(low) if low == high else f"{number(low)} to {number(high)}"


def sections(result: ImpactResult) -> list[Section]:
    """Return velocities, contact and energy of one impact, without undefined rows."""
    return [
        _drop_gaps(result, ["", "before", "after", "unit"], _velocities(result)),
        _drop_gaps(result, ["contact", "value", "unit"], _contact(result)),
        _drop_gaps(result, ["energy", "value", "unit"], _energy(result)),
    ]


def sweep_section(
    result: ImpactResult, varied: Mapping[str, Real], *, most: int | None = None
) -> Section:
    """Return one row for each impact: entries that vary, by name, quantities, status.

    If ``most`` is not None, at most this number of rows, evenly spread with both ends.
    """
    scene, columns = result.scene, {}
    for name, values in varied.items():
        columns[heading(name, entry_unit(name))] = np.broadcast_to(values, scene.shape)
    for column in _show_columns(scene, (*SWEEP_TABLE, *foreign())):
        for part, values in _parts(result, column):
            if part not in varied and not np.isnan(values).all():
                columns[heading(part, column.unit_in(scene))] = values
    statuses = np.array(result.status, dtype=object)
    rows = [
        [*(float(values[index]) for values in columns.values()), statuses[index].name]
        for index in evenly(len(result), most)
    ]
    return Section([*columns, "status"], rows)


def _show_columns(scene: Scene, names: Sequence[str]) -> Iterator[Column]:
    """Yield the columns of a table that a scene has, without vectors in space."""
    known = {column.name for column in columns_of(scene)}
    if scene.along is not None:
        known |= {"tangential_restitution", "rebound_angle"}
    for name in names:
        column = QUANTITIES[name]
        if name.removesuffix("_deg") in known and not (scene.sphere is None and name in IN_SPACE):
            yield column


def _parts(result: ImpactResult, column: Column) -> Iterator[tuple[str, Array]]:
    """Yield the components of a column by name, each of the scene's shape; NaN if undefined."""
    shape, value = result.scene.shape, column.read(result)
    for name, values in components(column.name, np.nan if value is None else value, shape):
        yield name, np.broadcast_to(np.asarray(values, dtype=float), shape)


def evenly(count: int, most: int | None) -> list[int]:
    """Return the indices of at most ``most`` of ``count`` rows, evenly spread with both ends."""
    shown = count if most is None else min(count, most)
    return [int(index) for index in np.round(np.linspace(0, count - 1, shown))]


def largest_imbalance(result: ImpactResult) -> str:
    """Return the largest relative imbalance of the energy books of a batch, as a line."""
    imbalance = np.abs(result.energy.relative_imbalance)
    checked = np.broadcast_to(result.energy.checked, np.shape(imbalance))
    if checked.all():
        return f"largest energy imbalance / start: {number(float(np.max(imbalance)), digits=3)}"
    count = f"{CLOSED}: {np.size(checked) - np.count_nonzero(checked)} of {len(result)} impacts"
    if not checked.any():
        return f"energy books: {count}"
    largest = number(float(np.max(imbalance[checked])), digits=3)
    return f"largest energy imbalance / start: {largest}; {count}"


def closing(result: ImpactResult) -> list[tuple[str, str]]:
    """Return laws, counters, run time and statuses, as (name, words)."""
    laws = [f"{name} [{kind}]" for kind, name in result.laws.items()]
    counters = ", ".join(f"{count} {key}" for key, count in result.counters.items()) or "none"
    lines = [("laws", ", ".join(laws)), ("counters", counters)]
    if result.scene.shape:
        lines.append(("run time", f"{time(result.run_time)} for {len(result)} impacts"))
    failures = Counter(result.failures.values())
    if failures.total() < np.size(result.status):
        lines.append(("status", "success"))
    for sentence, count in failures.most_common(SENTENCES):
        lines.append(("status", sentence + (f" ({count} impacts)" if count > 1 else "")))
    if len(failures) > SENTENCES:
        lines.append(("status", f"... and {len(failures) - SENTENCES} more sentences"))
    return lines


def heading(name: str, unit: str) -> str:
    """Return a heading with its unit, unless that is 1."""
    return name if unit == "1" else f"{name} ({unit})"


def _drop_gaps(result: ImpactResult, headings: list[str], rows: list[Row]) -> Section:
    """Return a section without undefined rows; the unit is 1 if the scene has no bodies."""
    shown = []
    for *cells, unit in rows:
        if not any(cell is None for cell in cells):
            unit = unit_in(unit, result.scene) if unit else unit
            shown.append([c if isinstance(c, str) else float(c) for c in cells] + [unit])
    return Section(headings, shown)


def has_bodies(scene: Scene) -> bool:
    """Return whether a scene is of bodies, not of psi1 and chi alone."""
    return scene.sphere is not None or scene.encounter is not None


def _velocities(result: ImpactResult) -> list[Row]:
    """Return velocities before and after the impact; of bodies psi is the last."""
    scene, bodies = result.scene, result.scene.sphere is not None
    slip = scene.slip_velocity, result.rebound_slip_velocity
    local = [
        *_pairs("slip velocity", *slip, "m/s"),
        *_pairs("local angle psi", scene.psi1, result.psi2, "1"),
    ]
    rows: list[Row] = []
    if kinetics.turns(scene):
        spins = scene.normal_spin, result.rebound_normal_spin
        rows.append(["spin about the normal", *spins, "rad/s"])
    if not bodies:
        normal = ["normal velocity", scene.normal_speed, result.normal_velocity, "m/s"]
        return [normal, *rows, *local] if has_bodies(scene) else [*local[::-1], *rows, normal]
    after_tangential = result.rebound_tangential_velocity
    after_angle = QUANTITIES["rebound_angle_deg"].read(result)
    rows = [
        ["normal velocity", scene.normal_speed, result.rebound_normal_velocity, "m/s"],
        ["tangential velocity", scene.tangential_velocity, after_tangential, "m/s"],
        ["spin", scene.spin, result.rebound_spin, "rad/s"],
        *rows,
        ["angle of the path", np.degrees(result.incidence_angle), after_angle, "deg"],
    ]
    if isinstance(scene.target, Sphere):
        rows += [
            ["target: normal velocity", 0.0, result.target_rebound_normal_velocity, "m/s"],
            ["target: tangential velocity", 0.0, result.target_rebound_tangential_velocity, "m/s"],
            ["target: spin", 0.0, result.target_rebound_spin, "rad/s"],
        ]
    return [*rows, *local]


def _pairs(name: str, before: Real, after: Real, unit: str) -> list[Row]:
    """Return a row of a number before and after, or one for each component of a vector."""
    if np.ndim(before) == 0:
        return [[name, before, after, unit]]
    pairs = enumerate(zip(np.ravel(before), np.ravel(after), strict=True), start=1)
    return [[f"{name} along t{place}", one, other, unit] for place, (one, other) in pairs]


def _each(name: str, value: Real) -> list[tuple[str, float]]:
    """Return a number, or the components of a vector or tensor, by name."""
    return [(part, float(each)) for part, each in components(name, np.asarray(value), ())]


def _groups(scene: Scene) -> list[tuple[str, float]]:
    """Return the dimensionless groups but psi1, by name."""
    groups = [*kinetics.groups(scene).items()][1:]
    return [each for name, group in groups for each in _each(name, group)]


def _contact(result: ImpactResult) -> list[Row]:
    """Return restitutions, duration and maxima of the contact."""
    scene, motion = result.scene, result.motion
    groups = [] if has_bodies(scene) else _groups(scene)
    rows: list[Row] = [
        *([name, value, "1"] for name, value in groups),
        ["normal restitution e", result.normal_restitution, "1"],
        ["tangential restitution e_t", result.tangential_restitution, "1"],
        ["contact time", motion.duration, "s"],
    ]
    if "compressions" in {column.name for column in columns_of(scene)}:
        rows.append(["compressions", result.compressions, "1"])
    rows += [
        [column.name.replace("_", " "), column.read(result), column.unit]
        for column in columns_of(scene)
        if column.name in foreign()
    ]
    if not has_bodies(scene):
        return rows
    size = size_of_contact(scene, motion.maximum_radius)
    sizes: list[Row] = [["largest contact radius", motion.maximum_radius, "m"]]
    if scene.pair.axis_ratio != 1.0:
        axes = zip(("t1", "t2"), semi_axes(scene.pair), strict=True)
        sizes[0][0] = "largest contact radius, of the circle as stiff"
        sizes += [
            [f"largest semi-axis along {name}", motion.maximum_radius * axis, "m"]
            for name, axis in axes
        ]
    return [
        *rows,
        *sizes,
        ["largest contact radius over R, C (9)", size, "1"],
        ["largest normal force", motion.maximum_force, "N"],
    ]


def _energy(result: ImpactResult) -> list[Row]:
    energy = result.energy
    rows: list[Row] = [
        ["start", energy.start, "J"],
        ["end", energy.end, "J"],
        ["loss of the normal motion", energy.normal_loss, "J"],
    ]
    if not energy.checked:
        rows.append(["friction work, of the velocities", energy.friction_work, "J"])
        return [*rows, ["imbalance", CLOSED, ""]]
    return [
        *rows,
        ["friction work, added up", energy.friction_work, "J"],
        *([["loss in shear", energy.shear_loss, "J"]] if energy.shear_loss else []),
        ["imbalance", energy.imbalance, "J"],
        ["imbalance / start", energy.relative_imbalance, "1"],
    ]
