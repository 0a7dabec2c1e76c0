"""Coordinates in which the elastic rebound is smooth: regions, each mapped to a unit square.

With delta = abs(abs(psi1) - 1) and epsilon = abs(2 chi - 1), psi2 = psi1 (-1 + epsilon g), and g
is tabulated (theory §10); far from psi1 = 1 at chi < 1/2 delta stands in place of epsilon.

Where gross slip comes first, or nearly so, it ends at V = 1 - delta/epsilon (theory §2), and the
radius that sticks then is about t = (delta/epsilon)^(1/5): there g is smooth in t and chi. Two
regions are divided by a cut, on which the sign of the last slip changes: below it g is analytic,
above it g is smooth in the square root of the distance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Largest chi of the table: beyond 2.7 there are curves that these regions do not know.
LARGEST_CHI = 2.5
(
    SMALL_NEAR,  # chi < 1/2, delta < epsilon: the edge soon slips
    SMALL_FAR,  # chi < 1/2, delta > epsilon
    STUCK_BACK,  # chi > 1/2, sticks from the start; the last slip is backward
    STUCK_ON,  # the same; the last slip is forward
    SLIP_BACK,  # slips first; below the cut
    SLIP_ON,  # slips first; above the cut
    SLIP_LONG,  # slips first, up to maximum compression at most; no cut
    SLIP_LATE,  # slips first, beyond maximum compression
) = range(8)
REGIONS = 8
NAMES = (
    "chi < 1/2, near psi1 = 1",
    "chi < 1/2, far from it",
    "stuck first, below the cut",
    "stuck first, above the cut",
    "slip first, below the cut",
    "slip first, above the cut",
    "slip first, longer",
    "slip first, past compression",
)
#: Largest t at which the slip regions are cut: beyond it the cut runs above LARGEST_CHI.
CUT_END = 0.8
#: Upper end of SLIP_ON, above the cut's largest chi: it keeps the square from degenerating.
CUT_TOP = 2.56
#: Powers of t in the cut of the slip regions; t^5 is the distance from psi1 = 1.
SLIP_POWERS = (0, 5, 6, 7, 8, 9, 10, 11, 12)
STUCK_POWERS = tuple(range(9))
#: First power of t in g after the constant: psi2 is C¹ at psi1 = 1 (theory §10).
FIRST_POWER = 5


class Cuts(NamedTuple):
    """chi of both cuts by increasing powers: of abs(psi1) and of t, zeros included."""

    stuck: Array
    slip: Array


def polynomial(terms: Array, argument: Array) -> Array:
    """Return the polynomial with ``terms``, lowest first, by Horner's rule."""
    total = np.full_like(argument, terms[-1])
    for term in terms[-2::-1].tolist():
        total *= argument
        total += term
    return total


def slip_cut(terms: Array, t: Array) -> Array:
    """Return chi of the cut of the slip regions, of which some powers are missing."""
    cut = polynomial(terms[FIRST_POWER:], t)
    square = t * t
    square *= square
    square *= t
    cut *= square
    cut += terms[0]
    return cut


def slope(terms: Array) -> Array:
    """Return the terms of a polynomial's derivative."""
    return np.asarray(terms[1:] * np.arange(1, terms.size))


def impact(region: int, a: Array, b: Array, cuts: Cuts) -> tuple[Array, Array]:
    """Return (psi1, chi) >= 0 of the place (a, b) in the unit square of ``region``.

    Parameters
    ----------
    region : int
        One of the constants above.
    a, b : array, shape (places,)
        Coordinates in [0, 1].
    cuts : Cuts
        Polynomials of the boundaries between regions.

    Returns
    -------
    psi1, chi : array, shape (places,)
    """
    if region == SMALL_NEAR:
        return 1.0 - a**5 * b, 0.5 - 0.5 * b
    if region == SMALL_FAR:
        return 1.0 - b, 0.5 - 0.5 * a * b
    if region in (STUCK_BACK, STUCK_ON):
        cut = polynomial(cuts.stuck, a)
        above = region == STUCK_ON
        return a, cut + b * b * (LARGEST_CHI - cut) if above else 0.5 + b * (cut - 0.5)
    chi = 0.5 + b * (LARGEST_CHI - 0.5)
    if region == SLIP_LATE:
        return 1.0 + (1.0 + a) * (2.0 * chi - 1.0), chi
    if region == SLIP_LONG:
        t = CUT_END + a * (1.0 - CUT_END)
    else:
        t = a * CUT_END
        cut = slip_cut(cuts.slip, t)
        chi = cut + b * b * (CUT_TOP - cut) if region == SLIP_ON else 0.5 + b * (cut - 0.5)
    return 1.0 + t**5 * (2.0 * chi - 1.0), chi


def measure(region: int, speed: Array, chi: Array) -> Array:
    """Return what g is multiplied with: psi2 = psi1 (-1 + measure g)."""
    return 1.0 - speed if region == SMALL_FAR else np.abs(2.0 * chi - 1.0)
