"""The traction of a contact as a sum of Hertz-like components, and its change over a step.

Lengths are over the largest radius and displacements in ``Scales``, so that no square underflows.
A component of radius r_k and strength c_k has the traction (kappa/pi) c_k sqrt(r_k² - r²) and moves
springs along the radius by c_k (r_k² - x²). Their sum w is linear in x² between the radii, so a
stack is told by its knots: r_k², and w there. The limit of a hemispherical pressure, A (b² - x²),
is linear too. A step in which displacement, b² and limit change in proportion is exact:

    w <- w + dD within the old contact, falling to 0 over the ring by which it grew,
    w <- min(max(w, -limit), limit), with a knot wherever the limit is met.

Components overtaken by slip lie on the limit and become one.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from contactlab.numeric.types import Array

#: Gauss's rule on (0, 1): exact for products of two functions that are linear in x².
NODES = 0.5 + np.array([-0.5, 0.0, 0.5]) * 0.6**0.5
WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
#: Rounding of w over its limit where the surfaces slip.
CLOSE = 1e-12
#: Rounding of squares at the edge, over b².
EDGE = 1e-15


class Stack(NamedTuple):
    """Knots of one contact: squares of radii from 0 to b², w there, 0 at the edge; and A."""

    squares: Array
    moved: Array
    steepness: float = 0.0

    def traction(self, radius: Array) -> Array:
        """Return the traction at radii, over kappa/pi."""
        if len(self.squares) == 1:
            return np.zeros_like(radius)
        strengths = np.diff(np.diff(self.moved) / np.diff(self.squares), append=0.0)
        inside = np.maximum(self.squares[1:] - np.square(radius)[:, None], 0.0)
        return np.asarray(np.sqrt(inside) @ strengths)

    def slipping(self, radius: Array) -> Array:
        """Return the sign of the slip at radii, 0 where the surfaces stick."""
        at = np.square(radius)
        moved = np.interp(at, self.squares, self.moved)
        limit = self.steepness * (self.squares[-1] - at)
        return np.asarray(np.sign(moved) * (np.abs(moved) >= (1.0 - CLOSE) * limit))

    def merge(self, most: int) -> Stack:
        """Return the stack with at most ``most`` components, by the merges that move it least.

        A merge drops a knot: w becomes the chord of its neighbours, which stays within the limit,
        as the limit is linear.
        """
        squares, moved = self.squares, self.moved
        while len(squares) - 1 > most:
            share = (squares[1:-1] - squares[:-2]) / (squares[2:] - squares[:-2])
            chord = moved[:-2] + share * (moved[2:] - moved[:-2])
            roots = np.sqrt(squares)
            lost = np.abs(chord - moved[1:-1]) * (roots[2:] - roots[:-2])  # twice the force
            least = 1 + int(np.argmin(lost))
            squares, moved = np.delete(squares, least), np.delete(moved, least)
        return Stack(squares, moved, self.steepness)


EMPTY = Stack(np.zeros(1), np.zeros(1))


def follow_step(
    old: Stack, displacement: float, radius: float, steepness: float
) -> tuple[Stack, float, float]:
    """Return the stack after a step, and the integrals over the radius of force and work.

    ``displacement`` is dD; ``radius``, b, and ``steepness``, A, are at the end.
    """
    if not math.isfinite(displacement + radius + steepness):
        return old, math.nan, math.nan
    square = radius * radius
    squares, trial = old.squares, old.moved + displacement
    if square > squares[-1]:
        squares, trial = np.append(squares, square), np.append(trial, 0.0)
    room = steepness * (square - squares)
    places = [squares, np.array([square])]
    for gap in (room - trial, room + trial):
        side = np.sign(gap)
        meets = np.flatnonzero(side[:-1] * side[1:] < 0.0)
        share = gap[meets] / (gap[meets] - gap[meets + 1])
        place = squares[meets] + share * (squares[meets + 1] - squares[meets])
        # A slip zone too thin to resolve begins at the last square before b².
        thin = np.abs(place - square) <= EDGE * square
        places.append(np.where(thin, np.nextafter(square, 0.0), place))
    at: Array = np.unique(np.concatenate(places))  # equal squares would have no slope
    limit = np.maximum(steepness * (square - at), 0.0)
    trial = np.interp(at, squares, trial)
    moved = np.minimum(np.maximum(trial, -limit), limit)
    before = np.interp(at, old.squares, old.moved, right=0.0)
    force, work = _integrate(at, moved, 0.5 * (before + moved), trial - moved)
    inside = at <= square
    at, moved, limit = at[inside], moved[inside], limit[inside]
    # Only the two ends of a run of knots on one side of the limit are kept.
    side = np.where(moved == limit, 1, 0) - np.where(moved == -limit, 1, 0)
    run = (side[1:-1] != 0) & (side[:-2] == side[1:-1]) & (side[2:] == side[1:-1])
    ends = np.concatenate([[True], ~run, [True]])[: len(at)]
    # Where w changes sign within a step, mean traction times slip may round to less than 0.
    return Stack(at[ends], moved[ends], steepness), force, max(work, 0.0)


def _integrate(at: Array, moved: Array, mean: Array, slid: Array) -> tuple[float, float]:
    """Return the integrals over the radius of w, and of its mean over the step times the slip."""
    roots = np.sqrt(at)
    widths = np.diff(roots)
    share = (roots[:-1, None] + widths[:, None] * NODES) ** 2 - at[:-1, None]
    share = share / np.diff(at)[:, None]

    def within(values: Array) -> Array:
        return np.asarray(values[:-1, None] + np.diff(values)[:, None] * share)

    force = widths @ (within(moved) @ WEIGHTS)
    work = widths @ ((within(mean) * within(slid)) @ WEIGHTS)
    return float(force), float(work)
