"""The elliptic Hertz contact: the circle as stiff, semi-axes and shear compliances (theory §16)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import ellipkm1, elliprd

from contactlab.numeric.types import Array, Real

#: Steps of Newton's method for ln(b/a): five reach rounding for ratios of curvatures to 1e100.
STEPS = 6
#: 1 - (b/a)² below which the difference of integrals in a slope would be lost in rounding.
NEARLY_ROUND = 1e-3


class Ellipse(NamedTuple):
    """A contact with the semi-axes a along x and b <= a along y.

    Attributes
    ----------
    axis_ratio : array
        b/a.
    radius : array
        R of the circular contact that is as stiff, times the sum of both curvatures, 1/(2 R') and
        1/(2 R''), of the gap.
    major, minor : array
        a and b over the radius of that circular contact.
    weight_major, weight_minor : array
        Share of nu in the shear compliance (1 - weight nu)/(2 G) along x and along y; 1/2 of a
        circle.
    """

    axis_ratio: Array
    radius: Array
    major: Array
    minor: Array
    weight_major: Array
    weight_minor: Array


def ellipse(ratio: Real) -> Ellipse:
    """Return the ellipse of a gap with principal curvatures of this ratio, above 0 and at most 1.

    The ratio A/B of the curvatures is k² D/N, k = b/a (Johnson, Contact Mechanics, 1985, §4.2, in
    Carlson's integrals), solved for ln k.
    """
    goal = np.log(np.asarray(ratio, dtype=float))
    log_k = goal / 1.5
    for _ in range(STEPS):
        square = np.exp(2.0 * log_k)
        first, second = _integrals(square)
        rest = -np.expm1(2.0 * log_k)
        far = rest > NEARLY_ROUND
        mixed = np.where(far, (second - square * first) / np.where(far, rest, 1.0), 0.1875 * np.pi)
        slope = np.clip(3.0 - mixed / first - mixed / second, 1.5, 2.0)
        step = 2.0 * log_k + np.log(first / second) - goal
        log_k = np.minimum(log_k - step / slope, 0.0)
    return of_axes(np.exp(log_k))


def of_axes(axis_ratio: Real) -> Ellipse:
    """Return the ellipse of semi-axes in this ratio b/a, above 0 and at most 1."""
    k = np.asarray(axis_ratio, dtype=float)
    square = k * k
    first, second = _integrals(square)
    whole = ellipkm1(square)
    energy = second + square * first
    radius = np.pi**2 * energy / (4.0 * square * whole**3)
    major = 2.0 * whole / np.pi
    return Ellipse(k, radius, major, k * major, second / whole, first / whole)


def _integrals(square: Array) -> tuple[Array, Array]:
    """Return D = (K - E)/m and N = K - D of the modulus m = 1 - k²; nothing is subtracted."""
    first = np.asarray(elliprd(0.0, square, 1.0) / 3.0, dtype=np.float64)
    second = np.asarray(square * elliprd(0.0, 1.0, square) / 3.0, dtype=np.float64)
    return first, second
