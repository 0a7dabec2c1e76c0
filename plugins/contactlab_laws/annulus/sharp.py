"""A sharper annulus law: the same series of tractions with conditions that need no matrix."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, ClassVar

import attrs
import numpy as np

from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real, count
from contactlab_laws.jaeger.bundle import Array, Bundle
from contactlab_laws.jaeger.law import ProfileLaw


class Circles(Bundle):
    """Circles a_i = i/n, i = 0 .. n-1, with w linear in s² between them and 0 at s = b.

    The weights integrate this w exactly. Beyond the last circle inside the contact, at a,
    w = w(a) (b² - s²)/(b² - a²): the outermost distribution ends where the contact does.
    """

    def __init__(self, annuli: int) -> None:
        circles = np.arange(annuli + 1) / annuli
        widths = np.diff(circles)
        # Weights of the inner and the outer value in the annulus between two circles.
        inner = 1.5 * _rim(circles[1:], circles[:-1])
        outer = 1.5 * widths - inner
        super().__init__(circles[:-1], inner + np.concatenate(([0.0], outer[:-1])))
        self.circles, self.inner, self.count = circles[:-1], inner, annuli

    def weights(self, square: Array) -> Array:
        """Return the weights, shape (n, K); the last circle's weight ends at the contact radius."""
        last = np.maximum(self.squares.searchsorted(square) - 1, 0)
        last = np.minimum(last, self.count - 1)
        radius = np.sqrt(square)
        rim = 1.5 * _rim(np.where(radius > 0.0, radius, 1.0), self.circles[last])
        weights = np.repeat(self.full_weights[:, None], len(square), axis=1)
        weights[last, np.arange(len(square))] += rim - self.inner[last]
        return weights

    def weights_of_one(self, square: float, touching: int) -> Array:
        """Return the weights of the innermost circles of one contact, shape (touching,)."""
        weights = self.full_weights[:touching].copy()
        if touching:
            rim = 1.5 * _rim(square**0.5, self.circles[touching - 1])
            weights[-1] += rim - self.inner[touching - 1]
        return weights


def _rim(radius: Any, circle: Any) -> Any:
    """Return the integral of (b² - s²)/(b² - a²) from a to b, free of cancellation."""
    return (radius - circle) * (2.0 * radius + circle) / (3.0 * (radius + circle))


circles = lru_cache(maxsize=32)(Circles)


@attrs.frozen(kw_only=True)
class SharpAnnulus(ProfileLaw):
    """Mindlin's partial slip by the paper's series of tractions, in other unknowns.

    A traction (pi/2) sum phi_i sqrt(1 - r²/a_i²), eq. (1), is made by

        w(s) = (pi/2) sum (phi_i / a_i) (a_i² - s²)_+,

    so that the series is any w that is continuous, and linear in s² between the circles. The
    traction at r depends on w beyond r only, the displacement at r on w within r only. While the
    stuck part is a disc of radius c, the two conditions

        displacement prescribed for r < c  (33)   and   traction at its limit for r > c  (34)

    prescribe w for s < c, and w = +-(b² - s²) for s > c. With the values of w on the circles as
    unknowns, each circle has its own condition. The limit is in the series exactly, and the
    outermost distribution ends at the contact radius, so gross slip gives mu P at every radius.
    Annuli that the growing contact meets move from then on only. The error falls as the square
    of annuli and steps; with conditions at the middles of annuli it falls as 1/n at best. Where
    the stuck part is not a disc (seldom), the theorem of Ciavarella and Jaeger replaces the
    paper's conditions.

    Parameters
    ----------
    annuli : int
        n, the number of annuli across the largest contact radius.

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5,
    eqs (1), (33), (34); Jaeger, Arch. Appl. Mech. 65 (1995) 478-487.
    """

    api_version: ClassVar[int] = 2
    resolution: ClassVar[str | None] = "annuli"

    annuli: int = count(default=50, most=100_000)

    def books_bound(self, scene: Scene) -> Real:
        """Return 0.05 + 0.2/n: the fewest steps leave 0.03, and with one annulus 0.2.

        Both fall as the squares of steps and annuli; with 50 and 200 it is 3e-4.
        """
        return 0.05 + 0.2 / self.annuli

    def bundle(self) -> Bundle:
        """Return the circles between the annuli."""
        return circles(self.annuli)
