"""A step of any number of impacts: w grows with the displacement and is cut to its limit."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab.numeric.types import Array, Real
from contactlab_laws.jaeger.bundle import Bundle, Geometry, of_each, of_one

#: Relative difference up to which numbers of a batch count as equal: scaled impacts of any size
#: and speed agree up to rounding.
ROUNDING = 1e-14


class SpringState(NamedTuple):
    """The memory of springs, which lead, so that each row is contiguous over the batch.

    Attributes
    ----------
    deflection : array, shape (touching, items)
        w of the springs that touch in some impact.
    limit : array, shape (touching, items) or (touching, 1)
        l of the same springs.
    square : float or array, shape (items,)
        b², a float where all impacts agree.
    """

    deflection: Array
    limit: Array
    square: Real


def start() -> SpringState:
    """Return springs before first touch."""
    none = np.zeros((0, 1))
    return SpringState(none, none, 0.0)


def common(value: Real, shape: tuple[int, ...]) -> Real:
    """Return ``value`` as a float where the whole batch agrees on it, else with shape (items,)."""
    if isinstance(value, float):
        return value
    first = float(value.flat[0])
    if value.size == 1 or np.ptp(value) <= ROUNDING * abs(first):
        return first
    return np.broadcast_to(value, shape).reshape(-1)


def float_of_one(value: Real) -> Real:
    """Return an array of one number as a float: arithmetic with a float is faster."""
    return value if isinstance(value, float) or value.size > 1 else value.item()


def advance(
    bundle: Bundle,
    before: SpringState,
    displacement: Real,
    radius: Real,
    pressure: Real,
    items: int,
) -> tuple[Array, Array, SpringState]:
    """Return force and friction work, shape (items,), and the springs after a step."""
    # The work of each spring is the mean of w before and after times its slip: of second order
    # also for springs that leave the contact, where the limit before is far above their w.
    square = radius * radius
    if isinstance(square, float) and isinstance(before.square, float):
        if square != square:
            return np.full(items, np.nan), np.full(items, np.nan), before
        geometry = of_one(bundle, before.square, square, pressure)
    else:
        each = np.broadcast_to(square, (items,))
        geometry = of_each(bundle, before.square, each, pressure)
    force, work, deflection = _return_map(bundle, before.deflection, geometry, displacement, items)
    if not len(deflection):  # out of contact NaN stays NaN
        force = force + 0.0 * (displacement * pressure)
    return force, work, SpringState(deflection, geometry.limit, square)


def _return_map(
    bundle: Bundle, before: Array, geometry: Geometry, displacement: Real, items: int
) -> tuple[Array, Array, Array]:
    """Return force, friction work and the new w = clip(w + part D, -l, l), a return mapping."""
    throughout, part, limit, weights = geometry
    touching = len(limit)
    still = min(len(before), touching)  # springs that touch at both ends of the step
    trial = np.empty((touching, items))
    np.add(before[:throughout], displacement, out=trial[:throughout])
    if throughout < touching:
        np.multiply(part, displacement, out=trial[throughout:])
        trial[throughout:still] += before[throughout:still]
    after = np.minimum(trial, limit)
    np.maximum(after, -limit, out=after)

    work = np.subtract(trial, after, out=trial)  # the slip, then times the mean w
    if still == touching:
        work *= after + before[:touching]
    else:
        work[:still] *= after[:still] + before[:still]
        work[still:] *= after[still:]
    total = _weigh(weights, work)
    if touching < len(before):  # springs that left the contact lose their deflection
        left = before[touching:]
        slip = left + displacement
        total = total + bundle.full_weights[touching : len(before)] @ (left * slip)
    return _weigh(weights, after), 0.5 * np.maximum(total, 0.0), after


def _weigh(weights: Array, values: Array) -> Array:
    """Return the sum over the springs, shape (items,)."""
    if weights.ndim == 1:
        return np.asarray(weights @ values)
    return np.asarray(np.einsum("ij,ij->j", weights, values))
