"""A bundle of springs: partial slip without a matrix."""

from __future__ import annotations

from bisect import bisect_left
from functools import lru_cache
from typing import ClassVar

import attrs
import numpy as np

from contactlab.numeric.checks import Real, count
from contactlab_laws.jaeger.bundle import Array, Bundle
from contactlab_laws.jaeger.law import ProfileLaw


class Midpoints(Bundle):
    """Springs in the middle of equal cells: F = mu P times the sum of w over the sum of l.

    With this rule, rather than 1.5/n times the sum, gross slip gives mu P to rounding and
    abs(F) never exceeds it. While the contact holds the first spring only, the factor would
    fall from infinity to 9/8 of 1.5/n, and a stretched spring that becomes softer or stiffer
    makes or loses energy: the factor stays at 9/8 then, and the limit grows instead.
    """

    def __init__(self, springs: int) -> None:
        super().__init__((np.arange(springs) + 0.5) / springs, np.full(springs, 1.5 / springs))
        self.sums = np.concatenate(([0.0], np.cumsum(self.squares)))  # of s² over the first m
        self.sums_listed = self.sums.tolist()
        self.ones = np.ones(springs)
        self.heaviest = 1.125 * 1.5 / springs

    def weights(self, square: Array) -> Array:
        """Return the weights, shape (n, K): b³ over the sum of b² - s², equal for all springs."""
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


@lru_cache(maxsize=32)
def midpoints(springs: int) -> Midpoints:
    """Return the bundle of ``springs`` springs, cached."""
    return Midpoints(springs)


@attrs.frozen(kw_only=True)
class Springs(ProfileLaw):
    """Mindlin's partial slip as a bundle of independent springs.

    The spring at distance r from the centre touches while r < b. Its displacement w grows with
    the slip displacement D, and is held at the limit l = 3 mu P/(4 G* b³) (b² - r²) where it
    would go beyond: w <- clip(w + f D, -l, l). A spring that the growing contact meets within a
    step moves for the part f of it only. The force is 2 G* times the integral of w over r.
    Nothing is solved and nothing is searched, and the error falls as the square of springs and
    steps.

    Parameters
    ----------
    springs : int
        Springs along the radius of the largest contact. With four steps to a spring the two
        errors are about equal at 100 steps; 12 springs and 80 steps leave 4e-4 in psi2
        at chi = 1.44, 3e-3 at chi = 3.

    References
    ----------
    Jaeger, Arch. Appl. Mech. 65 (1995) 478-487; Popov & Hess, Method of Dimensionality
    Reduction in Contact Mechanics and Friction (2015), ch. 5. The limit of Maw, Barber &
    Fawcett's annuli, Wear 38 (1976) 101-114, as their number grows.
    """

    api_version: ClassVar[int] = 2
    resolution: ClassVar[str | None] = "springs"

    springs: int = count(default=50, most=100_000)

    @property
    def books_bound(self) -> float:
        """Return 0.05 + 0.03/n: the fewest steps leave 0.03, one spring 0.02 whatever the steps.

        Both fall as the squares of steps and springs; with 50 and 200 it is 1e-4.
        """
        return 0.05 + 0.03 / self.springs

    def bundle(self) -> Bundle:
        """Return springs in the middle of equal cells."""
        return midpoints(self.springs)
