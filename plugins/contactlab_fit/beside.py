"""Measured impacts of a scene: relative to its struck body, and as series of its file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from contactlab.impact.bodies import Sphere
from contactlab.impact.body_contact import resolve_velocity, sides
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real
from contactlab.numeric.vectors import components, dot
from contactlab.scene_file import SceneFile, read_scene
from contactlab.scene_file.entries import (
    CARTESIAN,
    POLAR,
    STRUCK_KEYS,
    entry_path,
    replace_entry,
    without_rivals,
)
from contactlab.scene_file.measured import Measured
from contactlab.scene_file.plane import check_spin, rim
from contactlab_fit.measurements import Measurements
from contactlab_fit.struck import SPIN, VELOCITY, to_the_struck_body
from contactlab_fit.unseen_spin import with_spins

#: A column that varies by less than this share of its mean was kept constant.
SAME = 0.1
#: Points of a sweep over the measured range, for a file that has none.
SWEPT = 61
#: The entry of the spin of the first body.
SPIN_BEFORE = "spin"
#: Stand-ins for missing entries of a file of which only the geometry is read.
DEFAULTS = {"friction_coefficient": 0.1}


def as_target_sees(table: Measurements, scene: Scene | SceneFile | str | Path) -> Measurements:
    """Return measurements relative to the surface of the struck body of a scene.

    The spin of the struck body moves its surface at the contact; a file may have the motion that
    the table lacks.

    Parameters
    ----------
    table : Measurements
    scene : Scene, SceneFile or path

    Raises
    ------
    ValueError
        If a column cannot be changed without another one, or a half-space has a spin.
    """
    if table.thrown:
        table = _with_spins(table, scene)
    own: Mapping[str, float] = {}
    arm: tuple[Real, Real] | None = None
    if isinstance(scene, SceneFile | str | Path):
        own, arm = _struck_motion(scene, table)
    elif isinstance(scene, Scene) and scene.sphere is None:
        return table  # for other bodies the columns change the file
    elif isinstance(scene, Scene) and isinstance(scene.target, Sphere):
        arm = -np.asarray(scene.target.radius), 0.0
    spin = table.given.get(SPIN, None if table.struck else own.get(SPIN))
    if spin is not None and arm is None:
        check_spin(f"{table.source}: {SPIN}" if table.source else SPIN, spin)
        spin = None
    moving = {name: own[name] for name in VELOCITY if name in own and not table.struck}
    at_rest = {name: np.zeros(len(table)) for name in own}
    given = {name: values for name, values in table.given.items() if name != SPIN} | at_rest
    if spin is None and not moving:
        return attrs.evolve(table, given=given)
    zeros = np.zeros(len(table))
    normal, along = (moving.get(name, 0.0) + zeros for name in VELOCITY)
    if spin is not None and arm is not None:
        inward, sideward = rim(spin, arm)
        normal, along = normal + inward, along + sideward
    measured, errors = dict(table.measured), dict(table.errors)
    given |= dict(zip(VELOCITY, (normal, along), strict=True))
    to_the_struck_body(given, measured, errors)
    struck = tuple({*table.struck, SPIN, *moving})
    return attrs.evolve(
        table, given=given | at_rest, measured=measured, errors=errors, struck=struck
    )


def _with_spins(table: Measurements, scene: Scene | SceneFile | str | Path) -> Measurements:
    """Return the impacts of a film without an angle with their spins before."""
    if isinstance(scene, Scene):
        return with_spins(table, scene, np.asarray(scene.spin) if np.any(scene.spin) else None)
    path = scene.path if isinstance(scene, SceneFile) else scene
    file = read_scene(path, entries=table.given, defaults=DEFAULTS)
    impact = _impact(file)
    spin = impact.get(SPIN_BEFORE)
    assert spin is None or isinstance(spin, float | int | np.ndarray)
    return with_spins(table, file.scene, spin)


def _impact(file: SceneFile) -> Mapping[str, object]:
    """Return the table ``[impact]`` of a file, empty if it has none."""
    impact = file.tables.get("impact", {})
    assert isinstance(impact, Mapping)
    return impact


def _struck_motion(
    scene: SceneFile | str | Path, table: Measurements
) -> tuple[Mapping[str, float], tuple[Real, Real] | None]:
    """Return the motion of the struck body of a file, and its arm; None for a half-space."""
    path = scene.path if isinstance(scene, SceneFile) else scene
    entries = {name: values for name, values in table.given.items() if name != SPIN}
    if table.struck:
        entries |= dict.fromkeys(VELOCITY, np.zeros(len(table)))
    file = read_scene(path, entries=entries, defaults=DEFAULTS)
    impact = _impact(file)
    own = {
        name: value for name in STRUCK_KEYS if isinstance(value := impact.get(name), float | int)
    }
    if file.encounter is not None and file.scene.along is not None:
        n = components(file.encounter.normal)
        struck = (side.arm for side in sides(file.encounter, n) if side.name)
        arms = [(dot(arm, n), dot(arm, file.scene.along)) for arm in struck]
        return own, (arms[0] if arms else None)
    if SPIN in table.given and file.scene.sphere is None:
        rule = "has no speeds of bodies, which columns could replace"
        raise ValueError(f"{SPIN}: {path} {rule}; give them, beside along = [x, y, z] of a body")
    target = file.scene.target
    return own, (-np.asarray(target.radius), 0.0) if isinstance(target, Sphere) else None


def first_velocities(table: Measurements) -> dict[str, float]:
    """Return velocities of the first impact of a table, for a file without velocities."""
    names = (*POLAR, *CARTESIAN)
    return {name: float(table.given[name][0]) for name in names if name in table.given}


def with_measurements(file: SceneFile, table: Measurements) -> SceneFile:
    """Return a scene file whose measured series are the columns of a table.

    Each impact has the entries of its row; the scene provides all others. The abscissa is the one
    column that varies; of several the angle, or else the most spread. A file without a sweep gets
    one over the measured range, or the measured impacts themselves where several columns vary.

    Raises
    ------
    ValueError
        If the table has no column before the impact; or, beside a sweep, if several columns vary,
        or the speeds differ.
    """
    impact = _impact(file)
    own = [name for name in STRUCK_KEYS if name in impact]
    if own and file.varied:
        raise ValueError(
            f"{file.path}: the struck body moves, but measured impacts are relative; leave out "
            "[sweep]"
        )
    table = _by_angle(as_target_sees(table, file))
    if not table.given:
        raise ValueError(
            f"{table.source}: no column describes the impact before contact; give one, such as "
            "angle_deg"
        )
    moving = _moving(table)
    spread = {name: np.ptp(x) / (np.max(np.abs(x)) or 1.0) for name, x in table.given.items()}
    x_name = (
        "angle_deg" if "angle_deg" in moving else max(moving or table.given, key=spread.__getitem__)
    )
    if file.varied and len(moving) > 1:
        raise ValueError(
            f"{table.source}: {', '.join(moving)} vary, but [sweep] of {file.path} varies "
            f"{', '.join(file.varied)}; leave out [sweep] to run each impact as measured"
        )
    if file.varied:
        _check_speed(file, table)
    else:
        file = _sweep_file(_relative(file, table), table, x_name, alone=len(moving) == 1)
    return attrs.evolve(
        file, measured=tuple(_series(table, name, x_name) for name in table.measured)
    )


def _by_angle(table: Measurements) -> Measurements:
    """Return velocities that vary along both directions as speeds and angles."""
    if not set(CARTESIAN) <= {*_moving(table)}:
        return table
    given = dict(table.given)
    normal, along = (given.pop(name) for name in CARTESIAN)
    given |= {"speed": np.hypot(normal, along), "angle_deg": np.degrees(np.arctan2(along, normal))}
    return attrs.evolve(table, given=given)


def _moving(table: Measurements) -> list[str]:
    """Return the columns before the impact that vary by more than a tenth of their mean."""
    return [
        name
        for name, values in table.given.items()
        if np.ptp(values) > SAME * abs(float(np.mean(values)))
    ]


def _sweep_file(file: SceneFile, table: Measurements, x_name: str, *, alone: bool) -> SceneFile:
    """Return a file with a sweep over the one column that varies, or with the rows as a sweep."""
    x = table.given[x_name]
    varied: dict[str, Array] = {x_name: np.linspace(float(np.min(x)), float(np.max(x)), SWEPT)}
    if not alone:
        order = np.argsort(x, kind="stable")
        rest = {name: values[order] for name, values in table.given.items() if np.ptp(values)}
        varied = {x_name: x[order]} | rest
    return attrs.evolve(file, varied=varied, scene=file.scene_at(**varied))


def _relative(file: SceneFile, table: Measurements) -> SceneFile:
    """Return a file with the mean impact of the measurements, relative to the struck body."""
    tables: Mapping[str, Any] = without_rivals(file.tables, table.given)
    for name, values in table.given.items():
        same = float(values[0]) if not np.ptp(values) else float(np.mean(values))
        tables = replace_entry(tables, entry_path(name), same)
    return attrs.evolve(file, tables=tables)


def _check_speed(file: SceneFile, table: Measurements) -> None:
    """Refuse a scene at another speed than the measurement."""
    scene = file.scene if file.scene.along else file.of_spheres
    normal, along = scene.normal_speed, scene.tangential_velocity
    if scene.along and file.encounter is not None:
        normal, along = resolve_velocity(scene, file.encounter.velocity)
    own = {"speed": np.hypot(normal, along), "normal_speed": np.asarray(normal)}
    for name in own.keys() & table.given.keys() - file.varied.keys():
        measured, in_scene = float(np.mean(table.given[name])), float(np.mean(own[name]))
        if abs(measured - in_scene) > SAME * measured:
            raise ValueError(
                f"{table.source}: {name} is {measured:.4g} m/s, and {in_scene:.4g} m/s in "
                f"{file.path}; write the measured one in the scene"
            )


def _series(table: Measurements, quantity: str, against: str) -> Measured:
    """Return the measured numbers of one quantity over the entry ``against``."""
    values = table.measured[quantity]
    present = np.isfinite(values)
    errors = table.errors.get(quantity, np.zeros(len(values)))
    given = {name: entries[present] for name, entries in table.given.items()}
    return Measured(
        quantity=quantity,
        against=against,
        x=given.pop(against),
        beside=given,
        values=values[present],
        x_error=np.zeros(int(present.sum())),
        error=errors[present],
        label="measured",
        source=table.source or "the data",
    )
