"""One step of any number of impacts: w grows with the displacement and is cut to its limit."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.numeric.checks import Real
from contactlab_laws.jaeger.bundle import Array, Bundle
from contactlab_laws.jaeger.geometry import Geometry, of_each, of_one

#: Numbers of a batch that differ by less than this, relatively, are taken as one: impacts of
#: any size and speed are the same in units of their own, up to rounding.
ROUNDING = 1e-14


class Memory(NamedTuple):
    """What the contacts remember. Springs lead, so that each row is contiguous over the batch.

    Attributes
    ----------
    deflection : array, shape (touching, items)
        w of the springs that touch in some impact.
    limit : array, shape (touching, items) or (touching, 1)
        l there.
    square : float or array, shape (items,)
        b², a float where all impacts agree.
    """

    deflection: Array
    limit: Array
    square: Real


def start() -> Memory:
    """Return contacts that have not begun."""
    nothing = np.zeros((0, 1))
    return Memory(nothing, nothing, 0.0)


def common(value: Real, shape: tuple[int, ...]) -> Real:
    """Return ``value`` as a float where the whole batch agrees on it, else with shape (items,)."""
    if isinstance(value, float):
        return value
    first = float(value.flat[0])
    if value.size == 1 or np.ptp(value) <= ROUNDING * abs(first):
        return first
    return np.broadcast_to(value, shape).reshape(-1)


def float_of_one(value: Real) -> Any:
    """Return an array of one number as a float: arithmetic with it is faster."""
    return value if isinstance(value, float) or value.size > 1 else value.item()


def advance(
    bundle: Bundle, memory: Memory, displacement: Real, radius: Real, pressure: Real, items: int
) -> tuple[Array, Array, Memory]:
    """Return force, friction work and new memory after a step.

    Parameters
    ----------
    bundle : Bundle
    memory : Memory
    displacement, radius, pressure : float, or array of shape (items,)
        D of the step; b and p at its end.
    items : int
        Impacts.

    Returns
    -------
    force, work : array, shape (items,)
        The work of each spring is the mean of w before and after times its slip: of second
        order also for springs that leave the contact within the step, where the limit before is
        far above what they carried.
    memory : Memory
    """
    square = radius * radius
    if isinstance(square, float) and isinstance(memory.square, float):
        if square != square:
            return np.full(items, np.nan), np.full(items, np.nan), memory
        geometry = of_one(bundle, memory.square, square, pressure)
    else:
        each = np.broadcast_to(square, (items,))
        geometry = of_each(bundle, memory.square, each, pressure)
    force, work, deflection = _returned(bundle, memory.deflection, geometry, displacement, items)
    if not len(deflection):  # no contact must not hide what is not a number
        force = force + 0.0 * (displacement * pressure)
    return force, work, Memory(deflection, geometry.limit, square)


def _returned(
    bundle: Bundle, before: Array, geometry: Geometry, displacement: Real, items: int
) -> tuple[Array, Array, Array]:
    """Return force, friction work and the new w: w <- clip(w + part D, -l, l), a return mapping.

    Parameters
    ----------
    bundle : Bundle
    before : array, shape (touching before, items)
        w at the beginning of the step.
    geometry : Geometry
    displacement : float or array, shape (items,)
        D of the step.
    items : int
        Impacts.
    """
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

    work = np.subtract(trial, after, out=trial)  # the slip, to begin with
    if still == touching:
        work *= after + before[:touching]
    else:
        work[:still] *= after[:still] + before[:still]
        work[still:] *= after[still:]
    done = _weighed(weights, work)
    if touching < len(before):  # springs that left the contact lose all they held
        left = before[touching:]
        slip = left + displacement
        done = done + bundle.full_weights[touching : len(before)] @ (left * slip)
    return _weighed(weights, after), 0.5 * np.maximum(done, 0.0), after


def _weighed(weights: Array, values: Array) -> Array:
    """Return the sum over the springs, shape (items,)."""
    if weights.ndim == 1:
        return np.asarray(weights @ values)
    return np.asarray(np.einsum("ij,ij->j", weights, values))
