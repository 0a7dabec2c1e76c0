"""Springs whose displacement is a vector of the tangent plane, held as a complex number.

A spring sticks, or slips along its force, which stays as long as its limit. Cutting it to its
limit at the end of a step is of first order in the step where slip turns. Two such cuts, after
``EARLY`` of the step and at its end, are of second order: the implicit scheme of Alexander, SIAM J.
Numer. Anal. 14 (1977) 1006-1021, doi:10.1137/0714068.

On an elliptic contact the stiffness depends on direction (theory §16), and so does the point of the
limit that a spring slips to: the closest in the energy of the springs. w is then the force over the
stiffness along the first axis.
"""

from __future__ import annotations

import math
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array

#: Displacements or forces of the tangent plane, as complex numbers; along one line real ones.
Vectors: TypeAlias = NDArray[np.number]
Some = TypeVar("Some", Array, Vectors)

#: Share of the step after which springs are cut first, and what that cut weighs at the end.
EARLY = 1.0 - math.sqrt(0.5)
WEIGHT = (1.0 - EARLY) / EARLY
#: Added to lengths that divide, so that none is zero.
TINY = 1e-300
#: Steps of Newton's method for the point of the limit on an ellipse (right to 5e-11 for stiffnesses
#: that differ by less than a factor of 2, as those of ellipses do); force over the limit beyond
#: which it no longer turns.
STEPS, FAR = 2, 1e60
#: Forces whose points are sought at a time, so that the numbers stay in the cache.
BLOCK = 4096


def turn_springs(
    held: Vectors, move: Vectors, least: Array, most: Array, cross: Array | None = None
) -> tuple[Vectors, Array]:
    """Return w after a step, and twice the friction work over the stiffness of one spring.

    Parameters
    ----------
    held, move : array, shape (springs, items)
        w before the step, and the displacement in it, complex, in m.
    least, most : array, shape (springs, items)
        Limit before and after, in m.
    cross : array, shape (items,), optional
        Stiffness along the second axis over that along the first; 1 by default.
    """
    moved = stretch(move, cross)
    early = beyond(held + EARLY * moved, least + EARLY * (most - least), cross)
    trial = held + moved - WEIGHT * early
    late = beyond(trial, most, cross)
    after = trial - late
    slip = relax(WEIGHT * early + late, cross)
    return after, (slip.conj() * (held + after)).real.sum(axis=0)


def drag_springs(
    held: Vectors,
    move: Vectors,
    pull: Vectors,
    first: Array,
    most: Array,
    decay: Array,
    cross: Array | None = None,
) -> Vectors:
    """Return w of viscous springs after a step (theory §15): the force is w + A w'.

    Parameters
    ----------
    held, move : array, shape (springs, items)
        w before the step, and the displacement in it, complex.
    pull : array, shape (items,)
        A v, complex.
    first, most : array, shape (springs, items) or (springs, 1)
        Limit before and after.
    decay : array, shape (springs, items) or (springs, 1)
        Time of the step over A.
    cross : array, shape (items,), optional
        As in ``turn_springs``.
    """
    moved, pull = stretch(move, cross), stretch(pull, cross)
    share = EARLY * decay / (1.0 + EARLY * decay)
    early = beyond(held + EARLY * moved + pull, first + EARLY * (most - first), cross)
    trial: Vectors = held + moved - WEIGHT * share * early
    return trial - share * beyond(trial + pull, most, cross)


def beyond(force: Vectors, limit: Array, cross: Array | None = None) -> Vectors:
    """Return the excess of forces over their limit, complex; a force slips to the closest point."""
    size = np.abs(force)
    slips = size > limit
    if cross is None:
        whole: Vectors = force * np.where(slips, 1.0 - limit / (size + TINY), 0.0)
        return whole
    over = np.zeros_like(force)
    parts = force.real, force.imag, limit, cross
    along, across, limits, ratio = (np.broadcast_to(each, force.shape)[slips] for each in parts)
    for start in range(0, along.size, BLOCK):
        block = slice(start, start + BLOCK)
        first, second = _closest(along[block], across[block], limits[block], ratio[block])
        along[block] -= first
        across[block] -= second
    over.real[slips], over.imag[slips] = along, across
    return over


def stretch(move: Vectors, cross: Array | None) -> Vectors:
    """Return displacements times the stiffness over that along the first axis."""
    return move if cross is None else move.real + 1j * (cross * move.imag)


def relax(force: Vectors, cross: Array | None) -> Vectors:
    """Return displacements from forces, the inverse of ``stretch``."""
    return force if cross is None else force.real + 1j * (force.imag / cross)


def energy(force: Vectors, cross: Array | None) -> Array:
    """Return abs(w)² of springs, on an ellipse force times displacement."""
    return (force.conj() * relax(force, cross)).real


def _closest(along: Array, across: Array, limit: Array, cross: Array) -> tuple[Array, Array]:
    """Return the forces of length ``limit`` that are closest in the energy of the springs."""
    # force/(1 + g stiffness) along each axis, in units of the limit. 1/length is nearly linear in
    # g, and Newton's method begins with the stiffness along the force.
    unit = 1.0 / np.maximum(limit, np.hypot(along, across) / FAR + TINY)
    u, v = along * unit, across * unit
    x, y = u * u, v * v
    square = x + y
    g = (np.sqrt(square) - 1.0) * square / (x + cross * y)
    for _ in range(STEPS):
        one, other = 1.0 / (1.0 + g), 1.0 / (1.0 + cross * g)
        first, second = x * one * one, y * other * other
        square = first + second
        g += (np.sqrt(square) - 1.0) * square / (first * one + cross * second * other)
    u /= 1.0 + g
    v /= 1.0 + cross * g
    unit = limit / np.hypot(u, v)
    return unit * u, unit * v
