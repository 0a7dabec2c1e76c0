"""The bundle of springs, at whose positions s a law keeps w(s), and its geometry in a step."""

from __future__ import annotations

from bisect import bisect_left
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Real


class Bundle:
    """Springs in the middle of equal cells: F = mu P times the sum of w over the sum of l.

    With this rule, rather than 1.5/n times the sum, gross slip gives mu P to rounding and
    abs(F) never exceeds it. While the contact holds the first spring only, the factor would
    fall from infinity to 9/8 of 1.5/n, and a stretched spring that becomes softer or stiffer
    makes or loses energy: the factor stays at 9/8 then, and the limit grows instead.

    Parameters
    ----------
    springs : int
        n, along the radius of the largest contact.

    Attributes
    ----------
    squares : array, shape (n,)
        s² of each spring over that of the largest contact; ``squares_listed`` is the same as a
        list.
    full_weights : array, shape (n,)
        Weights of 1.5 times the integral of w over the largest contact.
    """

    def __init__(self, springs: int) -> None:
        positions = (np.arange(springs) + 0.5) / springs
        self.squares = positions * positions
        self.squares_listed = self.squares.tolist()
        self.full_weights = np.full(springs, 1.5 / springs)
        for array in (self.squares, self.full_weights):
            array.flags.writeable = False
        self.sums = np.concatenate(([0.0], np.cumsum(self.squares)))  # of s² over the first m
        self.sums_listed = self.sums.tolist()
        self.ones = np.ones(springs)
        self.heaviest = 1.125 * 1.5 / springs

    def weights(self, square: Array) -> Array:
        """Return weights of F in w, shape (n, K), for contacts of b² = ``square``, shape (K,)."""
        # b³ over the sum of b² - s², equal for all springs.
        factor = np.minimum(self._factor(square), self.heaviest)
        return np.broadcast_to(factor, (len(self.squares), len(square)))

    def weights_of_one(self, square: float, touching: int) -> Array:
        """Return the weights of the innermost springs of one contact, shape (touching,)."""
        return self.ones[:touching] * min(self._factor_of_one(square), self.heaviest)

    def limit_factor(self, square: Real) -> Real:
        """Return the factor on the limits: above 1 where the weight of one spring is capped."""
        if isinstance(square, float):
            return max(self._factor_of_one(square) / self.heaviest, 1.0)
        return np.maximum(self._factor(square) / self.heaviest, 1.0)

    def _factor(self, square: Array) -> Array:
        touching = self.squares.searchsorted(square)
        full = touching * square - self.sums[touching]
        return np.where(touching > 0, square**1.5 / (full + (touching == 0)), 0.0)

    def _factor_of_one(self, square: float) -> float:
        touching = bisect_left(self.squares_listed, square)
        full = touching * square - self.sums_listed[touching]
        return square**1.5 / full if touching else 0.0


bundle = lru_cache(maxsize=32)(Bundle)


class Geometry(NamedTuple):
    """One step of the springs that touch at its end in some impact.

    K is the number of impacts, or 1 where all have the same contact.

    Attributes
    ----------
    throughout : int
        Innermost springs that touch through the whole step in every impact.
    part : array, shape (touching - throughout, K)
        Part of the step for which the other springs touch.
    limit : array, shape (touching, K)
        l at the end of the step, zero out of contact.
    weights : array, shape (touching,) or (touching, K)
        Weights of the force.
    """

    throughout: int
    part: Array
    limit: Array
    weights: Array


def of_one(bundle: Bundle, before: float, after: float, pressure: Real) -> Geometry:
    """Return the geometry where one contact serves all impacts; ``before``, ``after`` are b²."""
    touching = bisect_left(bundle.squares_listed, after)
    compression = after - bundle.squares[:touching, None]
    throughout = bisect_left(bundle.squares_listed, before) if after > before else touching
    part = compression[throughout:]
    if throughout < touching:
        part = np.minimum(part / (after - before), 1.0)
    limit = (pressure * bundle.limit_factor(after)) * compression
    return Geometry(throughout, part, limit, bundle.weights_of_one(after, touching))


def of_each(bundle: Bundle, before: Real, after: Array, pressure: Real) -> Geometry:
    """Return the geometry of contacts that differ; ``before``, ``after`` are b², shape (K,)."""
    # While b grows, a spring that the contact meets in the step moves with the surfaces only from
    # then on; without this the error would be of first order. b² is taken as linear in the step.
    touching = int(bundle.squares.searchsorted(after.max()))  # n for NaN
    throughout = min(touching, int(bundle.squares.searchsorted(np.min(before))))
    compression = after - bundle.squares[:touching, None]
    growth = after - before
    grows = growth > 0.0
    part = np.clip(compression[throughout:] / np.where(grows, growth, 1.0), 0.0, 1.0)
    outside = bundle.full_weights[:touching, None]
    weights = np.where(compression > 0.0, bundle.weights(after)[:touching], outside)
    limit = (pressure * bundle.limit_factor(after)) * np.maximum(compression, 0.0)
    return Geometry(throughout, np.where(grows, part, 1.0), limit, weights)


def spring_fields(
    radius: Array, deflection: NDArray[np.number], limit: Array, *, metres: Real = 1.0
) -> dict[str, Any]:
    """Return the fields of springs, w and l in units of ``metres``, all of one shape.

    A complex w is a vector: its parts are on a last axis, and ``slipping`` is 1 whatever its sign.
    """
    slips = (limit > 0.0) & (np.abs(deflection) >= limit)
    along = slips * np.sign(deflection.real)
    if np.iscomplexobj(deflection):
        along = slips
        deflection = np.stack((deflection.real, deflection.imag), axis=-1)
        metres = np.asarray(metres)[..., None]
    return {
        "radius": radius,
        "displacement": metres * deflection,
        "limit": metres * limit,
        "stuck": (limit > 0.0) & ~slips,
        "slipping": along.astype(np.int8),
    }
