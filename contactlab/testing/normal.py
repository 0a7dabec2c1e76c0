"""Checks of a normal law's answers: form, batches, units, and a state that is a value."""

from __future__ import annotations

import copy
import math

import numpy as np

from contactlab.contracts import NormalContact, NormalLaw
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import lock_arrays
from contactlab.numeric.types import Array, Real
from contactlab.testing import limits
from contactlab.testing.check import CheckFailedError, check, hold, within
from contactlab.testing.compare import has_numbers, hold_read_only, same
from contactlab.testing.load_paths import bodies, scene, vary
from contactlab.testing.units import ODD_UNITS, Units, in_units

#: Steps to the largest approach, which is that of a Hertz impact.
STEPS = 60
#: Rounding of force, radius and overlap, over the largest of each.
ROUNDING = 1e-9
#: A divisor in place of 0, the largest value of a law without force.
TINY = 1e-300
ENTRIES = NormalContact._fields
#: Quantities in which the contacts of a batch differ, and the stride over approaches there.
DIFFERENT, SPARSE = ("normal_speed", "radius", "effective_modulus", "normal_mass"), 4


def strokes(
    units: Units | None = None, *, bodies: Real = 1.0, given: Scene | None = None
) -> tuple[Scene, Array, Array]:
    """Return a scene, and approach (m) and rate (m/s) of a press and release, shape (K, ...).

    The course leads from first touch to out of contact, as in an impact.
    """
    given = given or scene(0.0, 1.0, units=units, bodies=bodies)
    x = np.linspace(0.0, 1.05 * math.pi, 2 * STEPS + 1)
    approach = np.multiply.outer(np.sin(x), hertz_scales(given).approach)
    return given, approach, np.multiply.outer(np.cos(x), given.normal_speed)


def respond(law: NormalLaw, impact: Scene, approach: Array, rate: Array) -> Array:
    """Return force, radius, overlap and friction load along a course, shape (4, K, ...).

    Parameters
    ----------
    law : NormalLaw
    impact : Scene
    approach, rate : array, shape (K, ...)
        In m and m/s, in the order of the course.
    """
    state = law.start(impact)
    answers = np.empty((len(ENTRIES), len(approach), *impact.shape))
    limits.begin(f"a course of {len(approach)} depths")
    for row, (depth, speed) in enumerate(zip(_rows(approach), _rows(rate), strict=True)):
        limits.DOING.steps += 1
        contact, state = law.respond(state, depth, speed)
        for entry, part in enumerate(_complete(contact)):
            answers[entry, row] = part
    return answers


def _rows(column: Array) -> list[Real]:
    """Return the rows of a column: floats for one impact, read-only arrays for a batch."""
    return column.tolist() if column.ndim == 1 else [lock_arrays(row.copy()) for row in column]


def _complete(contact: object) -> NormalContact:
    """Return a contact with its friction load, or fail a law that returns anything else."""
    if isinstance(contact, NormalContact):
        return contact.complete
    raise CheckFailedError(f"respond returned {contact!r}, no NormalContact.")


@check(NormalLaw)
def contacts(law: NormalLaw) -> None:
    """Every answer holds real, finite numbers of the batch's shape (NormalContact)."""
    for shape in ((), (3,), (2, 3)):
        impact, approach, rate = strokes(bodies=bodies(*shape) if shape else 1.0)
        state = law.start(impact)
        for depth, speed in zip(_rows(approach), _rows(rate), strict=True):
            contact, state = law.respond(state, depth, speed)
            for name, value in zip(ENTRIES, contact, strict=True):
                if name == "friction_load" and value is None:
                    continue
                if not (has_numbers(value, shape) and np.all(np.isfinite(np.asarray(value)))):
                    where = f"at approach {depth!s:.60}, batch shape {shape}"
                    hold(False, f"{name} = {value!r} {where}.")


@check(NormalLaw)
def contacts_batch(law: NormalLaw) -> None:
    """A batch of unlike bodies gives the same as each contact alone (NormalLaw, 2)."""
    for quantity in DIFFERENT:
        impact, approach, rate = strokes(given=vary(quantity))
        words = f"of a batch that differs in {quantity} only"
        _alike(law, impact, approach[::SPARSE], rate[::SPARSE], words)
    impact, approach, rate = strokes(bodies=bodies(3))
    factors = np.array([0.3, 0.7, 1.0])
    _alike(law, impact, approach * factors, rate * factors, "of a batch")
    _alike(law, *strokes(bodies=bodies(2, 3)), "of a batch of shape (2, 3)")


def _alike(law: NormalLaw, impacts: Scene, approach: Array, rate: Array, words: str) -> None:
    """Hold that the contacts of a batch answer as each contact does alone."""
    shape = (len(approach), *impacts.shape)
    approach, rate = (np.broadcast_to(column.T, shape[::-1]).T for column in (approach, rate))
    together = respond(law, impacts, approach, rate)
    for place in np.ndindex(impacts.shape):
        at = (slice(None), *place)
        alone = respond(law, impacts.take(place), approach[at], rate[at])
        scale = np.maximum(np.abs(alone).max(axis=1, keepdims=True), TINY)
        gap = float(np.max(np.abs(together[(slice(None), *at)] - alone) / scale))
        name = place[0] if len(place) == 1 else place
        within(gap, ROUNDING, f"Contact {name} {words} is off by {gap:.1e}.")


@check(NormalLaw)
def contacts_pure(law: NormalLaw) -> None:
    """``respond`` changes neither the state passed to it nor the law (NormalLaw, 1)."""
    impact, approach, rate = strokes()
    kept_law, state = copy.deepcopy(law), law.start(impact)
    for depth, speed in zip(approach.tolist(), rate.tolist(), strict=True):
        kept = copy.deepcopy(state)
        first, new = law.respond(state, depth, speed)
        law.respond(state, 1.7 * depth, -speed)
        again, _ = law.respond(state, depth, speed)
        hold(same(state, kept), f"The state that went in was changed at approach {depth:.3g}.")
        hold(same(first, again), "A step tried and thrown away changed the next one.")
        state = new
    hold(same(law, kept_law), "The law itself was changed by a run.")


@check(NormalLaw)
def contacts_read_only(law: NormalLaw) -> None:
    """The law does not write into its arguments (Law, 1)."""
    impacts, approach, rate = strokes(bodies=bodies(3))
    hold_read_only(lambda: respond(law, impacts, approach, rate), impacts)


@check(NormalLaw)
def contacts_units(law: NormalLaw) -> None:
    """Answers do not depend on the units of length, time and mass (theory §7)."""
    length, time, mass = ODD_UNITS
    in_si = respond(law, *strokes())
    in_odd_units = respond(in_units(law, ODD_UNITS), *strokes(ODD_UNITS))
    newton = mass * length / time**2
    for name, expected, value, unit in zip(
        ENTRIES, in_si, in_odd_units, (newton, length, length, newton), strict=True
    ):
        gap = float(np.max(np.abs(value / unit - expected))) / max(
            float(np.max(np.abs(expected))), TINY
        )
        within(gap, ROUNDING, f"In other units the {name} differs by {gap:.1e}.")


@check(NormalLaw)
def contacts_non_finite(law: NormalLaw) -> None:
    """NaN as approach or rate gives NaN, never "no contact" (NormalLaw, 2)."""
    impact, approach, rate = strokes()
    batch = strokes(bodies=bodies(2))[0]
    depth, speed = float(approach[STEPS]), float(rate[0])
    for scene_of_nan, *motion in (
        (impact, math.nan, speed),
        (batch, np.array([math.nan, depth]), np.array([speed, speed])),
    ):
        try:
            contact, _ = law.respond(law.start(scene_of_nan), *motion)
        except (ValueError, ArithmeticError):
            continue
        force, _, overlap, load = (float(np.ravel(part)[0]) for part in contact.complete)
        hold(math.isnan(force), f"An approach of NaN gives a force of {force!r}.")
        hold(not overlap <= 0.0, "An approach of NaN is taken for no contact; keep the NaN.")
        hold(math.isnan(load), f"An approach of NaN gives a friction load of {load!r}.")
    try:
        unsure, *_ = law.respond(law.start(impact), depth, math.nan)[0].complete
        at_rest, *_ = law.respond(law.start(impact), depth, 0.0)[0].complete
        moving, *_ = law.respond(law.start(impact), depth, speed)[0].complete
    except (ValueError, ArithmeticError):
        return
    if at_rest != moving:  # a force that does not depend on the rate may ignore a rate of NaN
        told = f"A rate of NaN gives a force of {float(unsure)!r}, as if at rest."
        hold(math.isnan(unsure), told)
