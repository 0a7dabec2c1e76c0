"""Measured impacts beside a scene: relative to its struck body, and as series of its file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from contactlab.fitting.measurements import Measurements
from contactlab.fitting.struck import SPIN, VELOCITY, to_the_struck_body
from contactlab.impact.bodies import Sphere
from contactlab.impact.body_contact import seen, sides
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real
from contactlab.numeric.vectors import components, dot
from contactlab.scene_file import SceneFile, read_scene
from contactlab.scene_file.entries import STRUCK_KEYS, entry_path, replaced, without_rivals
from contactlab.scene_file.measured import Measured
from contactlab.scene_file.plane import rim

#: A column that varies by less than this share of its mean was kept constant.
SAME = 0.1
#: Points of a sweep over the measured range, for a file that has none.
SWEPT = 61
#: What the file of a fit may leave out, to be read at all.
DEFAULTS = {"friction_coefficient": 0.1}


def as_met(table: Measurements, scene: object) -> Measurements:
    """Return measurements relative to the surface of the struck body of a scene.

    Its spin moves the surface at the contact, and a file may have what the table does not say of
    its motion.

    Parameters
    ----------
    table : Measurements
    scene : Scene, SceneFile or path

    Raises
    ------
    ValueError
        If a column cannot be changed without another one, or the struck body does not spin.
    """
    own: Mapping[str, float] = {}
    arm: tuple[Real, Real] | None = None
    if isinstance(scene, SceneFile | str | Path):
        own, arm = _of_file(scene, table)
    elif isinstance(scene, Scene) and isinstance(scene.target, Sphere):
        arm = -np.asarray(scene.target.radius), 0.0
    spin: Any = table.given.get(SPIN, None if table.struck else own.get(SPIN))
    moving = {name: own[name] for name in VELOCITY if name in own and not table.struck}
    at_rest = {name: np.zeros(len(table)) for name in own}
    given = {name: values for name, values in table.given.items() if name != SPIN} | at_rest
    if spin is None and not moving:
        return attrs.evolve(table, given=given) if own else table
    zeros = np.zeros(len(table))
    normal, along = (moving.get(name, 0.0) + zeros for name in VELOCITY)
    if spin is not None:
        if arm is None:
            raise ValueError(f"{SPIN}: the struck body is no sphere and no body, and does not spin")
        inward, sideward = rim(spin, arm)
        normal, along = normal + inward, along + sideward
    measured, errors = dict(table.measured), dict(table.errors)
    given |= dict(zip(VELOCITY, (normal, along), strict=True))
    to_the_struck_body(given, measured, errors)
    struck = tuple({*table.struck, SPIN, *moving})
    return attrs.evolve(
        table, given=given | at_rest, measured=measured, errors=errors, struck=struck
    )


def _of_file(
    scene: SceneFile | str | Path, table: Measurements
) -> tuple[Mapping[str, float], tuple[Real, Real] | None]:
    """Return the motion of the struck body that a file tells, and its arm to the contact."""
    path = scene.path if isinstance(scene, SceneFile) else scene
    entries = {name: values for name, values in table.given.items() if name != SPIN}
    if table.struck:
        entries |= dict.fromkeys(VELOCITY, np.zeros(len(table)))
    file = read_scene(path, entries=entries, defaults=DEFAULTS)
    impact: Any = file.tables.get("impact", {})
    own = {name: impact[name] for name in STRUCK_KEYS if isinstance(impact.get(name), float | int)}
    if file.encounter is not None and file.scene.along is not None:
        n, still = components(file.encounter.normal), (0.0, 0.0, 0.0)  # a half-space has no arm
        struck = (side.arm for side in sides(file.encounter, n) if side.name)
        arm = next(struck, still)
        return own, (dot(arm, n), dot(arm, file.scene.along))
    target = file.scene.target
    return own, (-np.asarray(target.radius), 0.0) if isinstance(target, Sphere) else None


def with_measurements(file: SceneFile, table: Measurements) -> SceneFile:
    """Return a scene file whose measured series are the columns of a table.

    The one column that varies, such as the angle, is the abscissa. The scene provides all other
    entries, such as the speed. A file without a sweep gets one over the measured range.

    Raises
    ------
    ValueError
        If more than one column varies, or the speeds differ.
    """
    impact: Any = file.tables.get("impact", {})
    own = [name for name in STRUCK_KEYS if name in impact]
    if own and file.varied:
        raise ValueError(
            f"{file.path}: its struck body moves, and its sweep is of the laboratory, where the "
            "measured impacts are relative; leave out [sweep]"
        )
    table = as_met(table, file)
    moving = [name for name, values in table.given.items() if not _constant(values)]
    if len(moving) != 1:
        varying = f"these vary by more than {SAME:.0%}: {', '.join(moving) or 'none'}"
        raise ValueError(f"{table.source}: one column must vary, such as angle_deg; {varying}")
    _check_speed(file, table)
    x = table.given[moving[0]]
    if not file.varied:
        varied = {moving[0]: np.linspace(float(np.min(x)), float(np.max(x)), SWEPT)}
        if own:
            file = _relative(file, table)
        file = attrs.evolve(file, varied=varied, scene=file.scene_at(**varied))
    return attrs.evolve(
        file, measured=tuple(_series(table, name, moving[0], x) for name in table.measured)
    )


def _constant(values: Array) -> bool:
    return bool(np.ptp(values) <= SAME * abs(float(np.mean(values))))


def _relative(file: SceneFile, table: Measurements) -> SceneFile:
    """Return a file whose struck body moves with its numbers in the frame of the measurements."""
    tables: Mapping[str, Any] = without_rivals(file.tables, table.given)
    for name, values in table.given.items():
        tables = replaced(tables, entry_path(name), float(np.mean(values)))
    return attrs.evolve(file, tables=tables)


def _check_speed(file: SceneFile, table: Measurements) -> None:
    """Refuse a scene at another speed than the measurement."""
    scene = file.scene if file.scene.along else file.of_spheres
    normal, along = scene.normal_speed, scene.tangential_velocity
    if scene.along and file.encounter is not None:
        normal, along = seen(scene, file.encounter.velocity)
    own = {"speed": np.hypot(normal, along), "normal_speed": np.asarray(normal)}
    for name in own.keys() & table.given.keys() - file.varied.keys():
        measured, in_scene = float(np.mean(table.given[name])), float(np.mean(own[name]))
        if abs(measured - in_scene) > SAME * measured:
            raise ValueError(
                f"{table.source}: {name} is {measured:.4g} m/s, and {in_scene:.4g} m/s in "
                f"{file.path}; write the measured one in the scene"
            )


def _series(table: Measurements, quantity: str, against: str, x: Array) -> Measured:
    """Return the measured numbers of one quantity over the entry ``against``."""
    values = table.measured[quantity]
    present = np.isfinite(values)
    errors = table.errors.get(quantity, np.zeros(len(values)))
    return Measured(
        quantity=quantity,
        against=against,
        x=x[present],
        values=values[present],
        x_error=np.zeros(int(present.sum())),
        error=errors[present],
        label="measured",
        source=table.source or "the data",
    )
