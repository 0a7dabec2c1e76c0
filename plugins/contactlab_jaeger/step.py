"""One step of any number of impacts: w follows the surfaces and is cut back to its limit."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.checks import Real
from contactlab_jaeger.geometry import Geometry, of_each, of_one
from contactlab_jaeger.places import Array, Places

#: Numbers of a batch that differ by less than this, relatively, are taken as one: impacts of
#: any size and speed go through one course in units of their own, up to rounding.
ROUNDING = 1e-14


class Memory(NamedTuple):
    """What the contacts remember. Places lead, so that each row is contiguous over the batch."""

    stretch: Array  # w at the places in contact in some impact, shape (reach, items)
    limit: Array  # l there, shape (reach, items) or (reach, 1)
    square: Real  # b², a float where all impacts agree


def start() -> Memory:
    """Return contacts that have not begun."""
    nothing = np.zeros((0, 1))
    return Memory(nothing, nothing, 0.0)


def common(value: Real, shape: tuple[int, ...]) -> Real:
    """Return ``value`` as a float where the whole batch agrees on it, else flat."""
    if isinstance(value, float):
        return value
    first = float(value.flat[0])
    if value.size == 1 or np.ptp(value) <= ROUNDING * abs(first):
        return first
    return np.broadcast_to(value, shape).reshape(-1)


def plain(value: Real) -> Any:
    """Return an array of one number as a float: arithmetic with it is faster."""
    return value if isinstance(value, float) or value.size > 1 else value.item()


def advance(
    places: Places, memory: Memory, displacement: Real, radius: Real, pressure: Real, items: int
) -> tuple[Array, Array, Memory]:
    """Return force, friction work and new memory after a step.

    Parameters
    ----------
    displacement, radius, pressure : float, or array of shape (items,)
        D of the step; b and p at its end.

    Returns
    -------
    force, work : array, shape (items,)
        The work of each place is the mean of w before and after times its slip: of second
        order also for places that let go within the step, where the limit before is far
        above what they carried.
    memory : Memory
    """
    square = radius * radius
    if isinstance(square, float) and isinstance(memory.square, float):
        if square != square:
            return np.full(items, np.nan), np.full(items, np.nan), memory
        geometry = of_one(places, memory.square, square, pressure)
    else:
        each = np.broadcast_to(square, (items,))
        geometry = of_each(places, memory.square, each, pressure)
    force, work, stretch = follow(places, memory.stretch, geometry, displacement, items)
    if not len(stretch):  # no contact must not hide what is not a number
        force = force + 0.0 * (displacement * pressure)
    return force, work, Memory(stretch, geometry.limit, square)


def follow(
    places: Places, old: Array, geometry: Geometry, displacement: Real, items: int
) -> tuple[Array, Array, Array]:
    """Return force, friction work and the new w: w <- clip(w + share D, -l, l)."""
    settled, share, limit, weights = geometry
    reach, known = len(limit), min(len(old), len(limit))
    trial = np.empty((reach, items))
    np.add(old[:settled], displacement, out=trial[:settled])
    if settled < reach:
        np.multiply(share, displacement, out=trial[settled:])
        trial[settled:known] += old[settled:known]
    stretch = np.minimum(trial, limit)
    np.maximum(stretch, -limit, out=stretch)

    work = np.subtract(trial, stretch, out=trial)  # the slip, to begin with
    if known == reach:
        work *= stretch + old[:reach]
    else:
        work[:known] *= stretch[:known] + old[:known]
        work[known:] *= stretch[known:]
    done = _weighed(weights, work)
    if reach < len(old):  # places that came out of contact let go of all they held
        left = old[reach:]
        done = done + places.measure[reach : len(old)] @ (left * (left + displacement))
    return _weighed(weights, stretch), 0.5 * np.maximum(done, 0.0), stretch


def _weighed(weights: Array, values: Array) -> Array:
    if weights.ndim == 1:
        return np.asarray(weights @ values)
    return np.asarray(np.einsum("ij,ij->j", weights, values))
