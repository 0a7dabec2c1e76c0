"""Checks of a normal law: force, radius, memory."""

from __future__ import annotations

import copy
import math
from typing import Any

import numpy as np

from contactlab.bodies import Pair
from contactlab.contracts import NormalLaw
from contactlab.testing.bench import scene
from contactlab.testing.check import check, hold
from contactlab.testing.compare import same, well_formed
from contactlab.testing.units import ODD_UNITS, Units, in_units

#: Deepest approach of these checks over C²R, and steps to it.
STEPS = 60
ROUNDING = 1e-9
#: Trapezium rule and central differences on these grids.
QUADRATURE = 1e-3


def strokes(units: Units | None = None) -> tuple[Pair, Any, Any]:
    """Return a pair, and approach and rate along a press and a release, out of contact too."""
    given = scene(0.0, 1.0, units=units)
    x = np.linspace(-0.05 * math.pi, 1.05 * math.pi, 2 * STEPS + 1)
    approach = given.maximum_approach * np.sin(x)
    return given.pair, approach, given.normal_speed * np.cos(x)


def respond(law: Any, pair: Pair, approach: Any, rate: Any) -> Any:
    """Return force, radius and overlap along a course, rows of an array."""
    state, rows = law.start(pair), []
    for depth, speed in zip(approach.tolist(), rate.tolist(), strict=True):
        contact, state = law.respond(state, depth, speed)
        rows.append(tuple(contact))
    return np.array(rows).T


@check(NormalLaw)
def contacts(law: Any) -> None:
    """Every answer holds real, finite numbers of the batch's shape (NormalContact)."""
    pair, approach, rate = strokes()
    for shape in ((), (3,), (2, 3)):
        factor: Any = np.linspace(0.5, 1.0, math.prod(shape)).reshape(shape) if shape else 1.0
        state = law.start(pair)
        for depth, speed in zip(approach.tolist(), rate.tolist(), strict=True):
            contact, state = law.respond(state, depth * factor, speed * factor)
            for name, value in zip(("force", "radius", "overlap"), contact, strict=True):
                good = well_formed(value, shape) and np.all(np.isfinite(np.asarray(value)))
                hold(good, f"{name} = {value!r} at approach {depth:.3g}, batch shape {shape}.")


@check(NormalLaw)
def contacts_batch(law: Any) -> None:
    """A batch answers as its contacts do one by one (design: one code path)."""
    pair, approach, rate = strokes()
    factors = np.array([0.3, 0.7, 1.0])
    state, rows = law.start(pair), []
    for depth, speed in zip(approach.tolist(), rate.tolist(), strict=True):
        contact, state = law.respond(state, depth * factors, speed * factors)
        rows.append(np.array([np.broadcast_to(part, 3) for part in contact]))
    together = np.array(rows)
    for place, factor in enumerate(factors.tolist()):
        alone = respond(law, pair, approach * factor, rate * factor).T
        scale = np.maximum(np.abs(alone).max(axis=0), 1e-300)
        gap = float(np.max(np.abs(together[:, :, place] - alone) / scale))
        hold(gap <= ROUNDING, f"Contact {place} of a batch is off by {gap:.1e}.")


@check(NormalLaw)
def contacts_pure(law: Any) -> None:
    """``respond`` changes neither the state that goes in nor the law (NormalLaw, 2)."""
    pair, approach, rate = strokes()
    kept_law, state = copy.deepcopy(law), law.start(pair)
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
def contacts_units(law: Any) -> None:
    """Metres, seconds and kilograms may be called anything (theory §7)."""
    length, time, mass = ODD_UNITS
    here = respond(law, *strokes())
    there = respond(in_units(law, ODD_UNITS), *strokes(ODD_UNITS))
    for name, one, other, unit in zip(
        ("force", "radius", "overlap"), here, there, (mass * length / time**2, length, length),
        strict=True,
    ):  # fmt: skip
        gap = float(np.max(np.abs(other / unit - one))) / max(float(np.max(np.abs(one))), 1e-300)
        hold(gap <= ROUNDING, f"In other units the {name} differs by {gap:.1e}.")


@check(NormalLaw)
def presses(law: Any) -> None:
    """Force is never a pull; force and radius are zero out of contact (NormalContact)."""
    pair, approach, rate = strokes()
    force, radius, overlap = respond(law, pair, approach, rate)
    hold(force.min() >= 0.0, f"A force of {force.min():.3g} N pulls.")
    outside = overlap <= 0.0
    hold(np.all(force[outside] == 0.0), "There is force out of contact.")
    hold(np.all(radius[outside] == 0.0), "There is a contact radius out of contact.")
    hold(force.max() > 0.0, "There is no force at any approach.")
    hold(overlap[0] <= 0.0 and overlap[STEPS] > 0.0, "The overlap does not tell contact from none.")


@check(NormalLaw)
def grows(law: Any) -> None:
    """Deeper is not weaker nor narrower: force and radius do not fall in compression.

    At a steady rate: in an impact a damped force is greatest before the approach is.
    """
    pair, approach, rate = strokes()
    depths = np.linspace(float(approach[0]), float(approach[STEPS]), STEPS + 1)
    force, radius, _ = respond(law, pair, depths, np.full_like(depths, 0.5 * float(rate.max())))
    for name, column in (("force", force), ("radius", radius)):
        fall = -float(np.min(np.diff(column))) / max(float(column.max()), 1e-300)
        hold(fall <= ROUNDING, f"The {name} falls by {fall:.2g} of its maximum in compression.")
    if "radius" in law.offers:
        hold(radius[STEPS] > 0.0, "It offers 'radius', and has none in contact.")


@check(NormalLaw)
def normal_passive(law: Any) -> None:
    """Pressing and releasing gives back no more energy than it took."""
    force, _, _ = respond(law, *strokes())
    approach = strokes()[1]
    work = np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(approach))
    hold(
        work.min() >= -QUADRATURE * work.max(),
        f"It takes {work.max():.4g} J and gives back {work.max() - work.min():.4g} J.",
    )


@check(NormalLaw)
def contacts_non_finite(law: Any) -> None:
    """NaN in gives NaN out, never "no contact" (NormalLaw, 4)."""
    pair, approach, rate = strokes()
    depth, speed = float(approach[STEPS]), float(rate[0])
    for given in ((math.nan, speed), (np.array([math.nan, depth]), np.array([speed, speed]))):
        try:
            contact, _ = law.respond(law.start(pair), *given)
        except (ValueError, ArithmeticError):
            continue
        first = [float(np.ravel(part)[0]) for part in contact]
        hold(math.isnan(first[0]), f"An approach of NaN gives a force of {first[0]!r}.")
        hold(not first[2] <= 0.0, "An approach of NaN is taken for no contact.")
