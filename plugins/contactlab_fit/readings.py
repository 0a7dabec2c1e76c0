"""Other readings of the columns of a measurement: mistaken units, angles, signs and rows."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real
from contactlab.outcome.columns import QUANTITIES
from contactlab_fit.problem import Problem

RPM = 2.0 * math.pi / 60.0
#: Mistaken units of numbers, by the unit of their quantity, with factors to that unit.
MISTAKEN = {
    "deg": {"in radians": math.degrees(1.0), "in degrees under a heading in rad": math.radians(1)},
    "rad/s": {
        "in rpm": RPM, "in rad/s under a heading in rpm": 1.0 / RPM,
        "in rev/s": 2.0 * math.pi, "in deg/s": math.radians(1.0),
    },
    "m/s": {
        "in mm/s": 1e-3, "in cm/s": 1e-2, "in km/h": 1.0 / 3.6,
        "in m/s under a heading in mm/s": 1e3, "in m/s under a heading in cm/s": 1e2,
    },
    "1": {"in percent": 1e-2},
    "s": {
        "in ms": 1e-3, "in µs": 1e-6,
        "in s under a heading in ms": 1e3, "in ms under a heading in µs": 1e3,
        "in s under a heading in µs": 1e6,
    },
}  # fmt: skip
MISTAKEN["rad"] = MISTAKEN["deg"]
#: Least count of numbers that shows a shift by a row.
ROWS = 6
SURFACE, SIGN = "measured from the surface, not from the normal", "of the opposite sign"
#: Words for units in the ways of mistaken units; no heading can be in percent.
IN_UNIT = re.compile(r"in (?!percent)(\S+)(?: under a heading in \S+)?")
UNITS = {"radians": "rad", "degrees": "deg"}
#: Quantities of the centre and of the contact point, which are easily exchanged.
TAKEN_FOR = {
    "rebound_angle_deg": "local_rebound_angle_deg",
    "rebound_angle": "local_rebound_angle",
    "rebound_tangential_velocity": "rebound_slip_velocity",
}
TAKEN_FOR |= {local: centre for centre, local in TAKEN_FOR.items()}
#: Restitutions that are easily exchanged: the true quantity of the numbers, its sign, and words.
RESTITUTIONS = {
    "tangential_restitution": (("beta0", 1.0, "beta0"), ("beta0", -1.0, "psi2/psi1, -beta0")),
    "beta0": (("tangential_restitution", 1.0, "tangential_restitution"),),
}


class Reading(NamedTuple):
    """A measurement with columns read another way.

    ``words`` state the supposed mistake. ``problem`` has the impacts and numbers of this reading,
    in the order of the measured quantities. ``factors`` are the factors on the numbers, by
    quantity. ``rest`` are the original numbers without those that the reading drops; None if the
    reading drops no number. With ``names`` ``--column`` reads the columns in this way.
    """

    words: str
    problem: Problem
    factors: Mapping[str, float]
    rest: Mapping[str, Array] | None = None
    names: Mapping[str, str] = {}

    @property
    def turned(self) -> bool:
        """Whether the reading is that of the opposite sign."""
        return SIGN in self.words


def readings(problem: Problem, given: Collection[str]) -> Iterator[Reading]:
    """Yield every other reading; ``given`` are the columns before the impact."""
    impacts = {one.words: one for one in _impacts(problem.model.setup.scene, given)}
    for words, one in impacts.items():
        read = attrs.evolve(problem, model=problem.model.at(one.scene))
        yield Reading(words, read, {}, names=one.names)
    yield from _numbers(problem)
    angles = [name for name in problem.measured if QUANTITIES[name].unit in ("deg", "rad")]
    for way in ("in radians", SURFACE) if angles else ():
        for words, one in impacts.items():
            if words.endswith(way):
                both = attrs.evolve(problem, model=problem.model.at(one.scene))
                names = dict(one.names)
                factor = MISTAKEN["deg"].get(way, 1.0)
                for name in angles:
                    both = _correct(both, name, _correction(name, way))
                    names |= _name(name, way)
                head = words.partition(" looks")[0]
                words = f"{head} and {' and '.join(angles)} look as if {way}"
                yield Reading(words, both, dict.fromkeys(angles, factor), names=names)


class Met(NamedTuple):
    """Words on a mistake before the impact, the corrected scene, and names for its columns."""

    words: str
    scene: Scene
    names: Mapping[str, str] = {}


def _name(name: str, way: str) -> dict[str, str]:
    """Return names that read a column another way; empty without such names."""
    if way == SIGN:
        return {name: f"-{name}"}
    if way == SURFACE:
        return {name: name.replace("angle", "angle_from_surface")}
    if unit := IN_UNIT.fullmatch(way):
        return {name: f"{name} ({UNITS.get(unit[1], unit[1])})"}
    return {}


def _impacts(scene: Scene, given: Collection[str]) -> Iterator[Met]:
    """Yield scenes with another angle, speed, spin before, or size of the ball."""
    normal = np.asarray(scene.normal_speed)
    along = np.asarray(scene.tangential_velocity)
    angle: Real = np.degrees(np.arctan2(along, normal))
    name = "angle_deg" if "angle_deg" in given else "the angle of incidence"
    for way, reread in (("in radians", np.degrees(angle)), (SURFACE, 90.0 - angle)):
        if np.all(np.abs(reread) < 90.0):
            names = _name(name, way) if name in given else {}
            met = turn_scene(scene, np.radians(reread), given)
            yield Met(f"{name} looks as if {way}", met, names)
    if {"normal_speed", "tangential_velocity"} <= set(given) and np.all(along > 0.0):
        words = "normal_speed and tangential_velocity look as if exchanged"
        met = attrs.evolve(scene, normal_speed=along, tangential_velocity=normal)
        both = {"normal_speed": "tangential_velocity", "tangential_velocity": "normal_speed"}
        yield Met(words, met, both)
    for way, factor in MISTAKEN["m/s"].items():
        for name, fields in {
            "speed": ("normal_speed", "tangential_velocity"),
            "normal_speed": ("normal_speed",),
            "tangential_velocity": ("tangential_velocity",),
        }.items():
            if name in given:
                faster: dict[str, Any] = {
                    field: factor * np.asarray(getattr(scene, field)) for field in fields
                }
                met = attrs.evolve(scene, **faster)
                yield Met(f"{name} looks as if {way}", met, _name(name, way))
    if np.any(scene.spin):
        for way, factor in (MISTAKEN["rad/s"] | {SIGN: -1.0}).items():
            spin = factor * np.asarray(scene.spin)
            met = attrs.evolve(scene, spin=spin)
            yield Met(f"spin looks as if {way}", met, _name("spin", way))
    for way, factor in {"in mm": 1e-3, "in cm": 1e-2, "the diameter": 0.5}.items():
        assert scene.sphere is not None
        ball = attrs.evolve(scene.sphere, radius=factor * np.asarray(scene.sphere.radius)[()])
        met = attrs.evolve(scene, sphere=ball)
        yield Met(f"the radius of the sphere looks as if {way}", met)


def turn_scene(scene: Scene, angle: Array, given: Collection[str]) -> Scene:
    """Return impacts at other angles, in rad, with the normal speed or speed of the table."""
    normal = np.asarray(scene.normal_speed)
    if "normal_speed" in given:
        return attrs.evolve(scene, tangential_velocity=normal * np.tan(angle))
    speed: Real = np.hypot(normal, scene.tangential_velocity)
    along = speed * np.sin(angle)
    return attrs.evolve(scene, normal_speed=speed * np.cos(angle), tangential_velocity=along)


def _numbers(problem: Problem) -> Iterator[Reading]:
    """Yield readings with other numbers after the same impacts."""
    measured = problem.measured
    for name in measured:
        unit = QUANTITIES[name].unit
        for way, factor in (MISTAKEN.get(unit, {}) | {SIGN: -1.0}).items():
            read = _correct(problem, name, _correction(name, way))
            names = _name(name, way)
            yield Reading(f"{name} looks as if {way}", read, {name: abs(factor)}, names=names)
        if unit in ("deg", "rad"):
            read = _correct(problem, name, _correction(name, SURFACE))
            names = _name(name, SURFACE)
            yield Reading(f"{name} looks as if {SURFACE}", read, {}, names=names)
        twin = TAKEN_FOR.get(name, "")
        for other, sign, words in RESTITUTIONS.get(name, ((twin, 1.0, twin),)):
            if other and other not in measured:
                read = _rename(_correct(problem, name, partial(np.multiply, sign)), {name: other})
                words = f"{name} looks as if its numbers were those of {words}"
                names = {name: f"{'-' if sign < 0.0 else ''}{other}"}
                yield Reading(words, read, {}, names=names)
    every = list(measured)
    for place, first in enumerate(every):
        for second in every[place + 1 :]:
            if QUANTITIES[first].unit == QUANTITIES[second].unit:
                read = _rename(problem, {first: second, second: first})
                words = f"{first} and {second} look as if exchanged"
                yield Reading(words, read, {}, names={first: second, second: first})
    listed = " and ".join(every)
    look = "looks" if len(every) == 1 else "look"
    if min(problem.counts.values()) < ROWS:
        return
    for way, step in (("low", -1), ("high", 1)):
        read = problem
        for name in every:
            read = _correct(read, name, partial(_shift_rows, step=step))
        kept = {name: _shift_rows(_shift_rows(v, step), -step) for name, v in measured.items()}
        yield Reading(f"{listed} {look} as if written a row too {way}", read, {}, kept)


def _correction(name: str, way: str) -> Callable[[Array], Array]:
    """Return the function that corrects numbers of a quantity written in this way."""
    unit = QUANTITIES[name].unit
    if way == SURFACE:
        right = 90.0 if unit == "deg" else 0.5 * math.pi
        return lambda values: right - values
    factor = -1.0 if way == SIGN else MISTAKEN[unit][way]
    return lambda values: factor * values


def _correct(problem: Problem, name: str, change: Callable[[Array], Array]) -> Problem:
    """Return the problem with the numbers of one quantity changed."""
    numbers = change(problem.measured[name])
    return attrs.evolve(problem, measured={**problem.measured, name: numbers})


def _rename(problem: Problem, names: Mapping[str, str]) -> Problem:
    """Return the problem with quantities under other names, in the same order."""
    measured = {names.get(name, name): values for name, values in problem.measured.items()}
    errors = {names.get(name, name): values for name, values in problem.errors.items()}
    return attrs.evolve(problem, measured=measured, errors=errors)


def _shift_rows(values: Array, step: int) -> Array:
    """Return numbers moved by a row; the number at the open end is NaN."""
    moved = np.roll(values, step)
    moved[-1 if step < 0 else 0] = np.nan
    return moved
