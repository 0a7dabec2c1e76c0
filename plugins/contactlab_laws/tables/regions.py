"""Coordinates in which the elastic rebound is smooth: regions, each mapped to a unit square.

With delta = abs(abs(psi1) - 1) and epsilon = abs(2 chi - 1), psi2 = psi1 (-1 + measure g), and g
is tabulated (theory §10); measure is epsilon, but far from psi1 = 1 at chi < 1/2 delta.

Where gross slip comes first, or nearly so, it ends at V = 1 - delta/epsilon (theory §2), and the
radius that sticks then is about t = (delta/epsilon)^(1/5): there g is smooth in t and chi. Two
regions are divided by a cut, on which the sign of the last slip changes: below it g is analytic,
above it g is smooth in the square root of the distance. Within SLIP_ON the fourth derivative of
psi2 jumps at a seam, where the slip back just reaches the disk that stuck first: the first
coordinate is 1/2 there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array
from contactlab_laws.tables.patches import polynomial

Rows = NDArray[np.intp]

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
LARGEST_CHI = 2.5
#: Largest t at which the slip regions are cut: beyond it the cut runs above LARGEST_CHI.
CUT_END = 0.8
#: t from which the powers in the slip cut are counted: about the middle of its range, for rounding.
SLIP_MIDDLE = 0.5
#: Upper end of SLIP_ON, above the cut's largest chi: it keeps the square from degenerating.
CUT_TOP = 2.7
#: 1 over the heights and lengths of coordinates.
PER_HEIGHT, PER_SHORT, PER_LONG = 1.0 / (LARGEST_CHI - 0.5), 1.0 / CUT_END, 1.0 / (1.0 - CUT_END)
#: Second coordinate from which the first follows the seam. Below it the seam runs on to psi1 = 1,
#: so near to it that its jump does no harm.
SEAM_FROM = 0.5
#: First power of t in g after the constant: psi2 is C¹ at psi1 = 1 (theory §10).
FIRST_POWER = 5


#: Kinds of impact: one or two regions each, but for EARLY, which three of the slip regions share,
#: and FULL, which slips throughout and needs no table.
NEAR, FAR, STUCK, EARLY, LATE, FULL = range(6)


class Cuts(NamedTuple):
    """Curves by increasing powers.

    Attributes
    ----------
    stuck : array
        chi of the cut by powers of abs(psi1).
    slip : array
        chi of the cut at t = 0, and what t^5 is multiplied with by powers of t - SLIP_MIDDLE.
    seam : array
        t/CUT_END of the seam, by powers of SLIP_ON's second coordinate.
    """

    stuck: Array
    slip: Array
    seam: Array


class SingleCuts(NamedTuple):
    """The same as functions of plain floats; ``slip`` is a number and the function beside t^5."""

    stuck: Callable[[float], float]
    slip: tuple[float, Callable[[float], float]]
    seam: Callable[[float], float]


class Places(NamedTuple):
    """Impacts that do not slip throughout, those of a kind together.

    Attributes
    ----------
    who : array of int, shape (places,)
        Which impacts these are.
    region : array of int, shape (places,)
    a, b : array, shape (places,)
        Coordinates in the unit square of the region.
    speed, chi, measure : array, shape (places,)
        abs(psi1), chi, and what g is multiplied with.
    """

    who: Rows
    region: NDArray[np.int32]
    a: Array
    b: Array
    speed: Array
    chi: Array
    measure: Array


def slip_cut(terms: Array, t: Array) -> Array:
    """Return chi of the cut of the slip regions."""
    cut = polynomial(terms[1:], t - SLIP_MIDDLE)
    power = t * t
    power *= power
    power *= t
    cut *= power
    cut += terms[0]
    return cut


def place(speed: float, chi: float, cuts: SingleCuts) -> tuple[int, float, float, float] | None:
    """Return region, a, b and measure of one impact; None if it slips throughout, eq. (46)."""
    if speed > 1.0:
        if speed >= 4.0 * chi - 1.0:
            return None
        measure = 2.0 * chi - 1.0
        ratio, height = (speed - 1.0) / measure, (chi - 0.5) * PER_HEIGHT
        if ratio > 1.0:
            return SLIP_LATE, ratio - 1.0, height, measure
        t = ratio**0.2
        if t > CUT_END:
            return SLIP_LONG, (t - CUT_END) * PER_LONG, height, measure
        start, rest = cuts.slip
        cut = start + ratio * rest(t - SLIP_MIDDLE)
        t *= PER_SHORT
        if chi >= cut:
            b = math.sqrt((chi - cut) / (CUT_TOP - cut))
            seam = cuts.seam(b if b > SEAM_FROM else SEAM_FROM)
            a = 0.5 * t / seam if t < seam else 0.5 + 0.5 * (t - seam) / (1.0 - seam)
            return SLIP_ON, a, b, measure
        return SLIP_BACK, t, (chi - 0.5) / (cut - 0.5), measure
    if chi >= 0.5:
        measure, cut = 2.0 * chi - 1.0, cuts.stuck(speed)
        if chi >= cut:
            return STUCK_ON, speed, math.sqrt((chi - cut) / (LARGEST_CHI - cut)), measure
        return STUCK_BACK, speed, (chi - 0.5) / (cut - 0.5), measure
    delta, epsilon = 1.0 - speed, 1.0 - 2.0 * chi
    if delta < epsilon:
        return SMALL_NEAR, (delta / epsilon) ** 0.2, epsilon, epsilon
    return SMALL_FAR, epsilon / delta, delta, delta


def places(speed: Array, chi: Array, cuts: Cuts) -> Places:
    """Return the places of impacts with chi <= LARGEST_CHI, but for those slipping throughout.

    Parameters
    ----------
    speed, chi : array, shape (impacts,)
        abs(psi1) and chi; no units. Complex for derivatives: then real parts are told apart first.
    cuts : Cuts
        Polynomials of the boundaries between regions.
    """
    kind = _kinds(speed, chi)
    who = np.argsort(kind, kind="stable")
    stops = kind[who].searchsorted(range(1, FULL + 1)).tolist()
    near, far, stuck, early, late = map(slice, [0, *stops], stops)
    who = who[: stops[-1]]
    p, x = speed[who], chi[who]
    region, (a, b) = np.empty(who.size, dtype=np.int32), np.empty((2, who.size), x.dtype)
    measure = 2.0 * x - 1.0
    measure[measure.real < 0.0] *= -1.0
    if far.stop:  # an empty part takes as long as a small one
        region[near], b[near] = SMALL_NEAR, measure[near]
        a[near] = ((1.0 - p[near]) / b[near]) ** 0.2
        region[far], b[far] = SMALL_FAR, 1.0 - p[far]
        np.divide(measure[far], b[far], out=a[far])
        measure[far] = b[far]
    a[stuck] = p[stuck]
    b[stuck], above = _across(x[stuck], polynomial(cuts.stuck, a[stuck]), LARGEST_CHI)
    region[stuck] = STUCK_BACK
    region[stuck][above] = STUCK_ON
    ends = slice(early.start, late.stop)
    np.multiply(measure[ends], 0.5 * PER_HEIGHT, out=b[ends])
    np.divide(p[ends] - 1.0, measure[ends], out=a[ends])
    region[early], region[late] = SLIP_LONG, SLIP_LATE
    a[late] -= 1.0
    t = a[early] ** 0.2
    np.multiply(t - CUT_END, PER_LONG, out=a[early])
    rows = (t <= CUT_END).nonzero()[0]
    t, rows = t[rows], rows + early.start
    a[rows] = t * PER_SHORT
    b[rows], above = _across(x[rows], slip_cut(cuts.slip, t), CUT_TOP)
    region[rows] = SLIP_BACK
    on = rows[above]
    if on.size:
        region[on] = SLIP_ON
        a[on] = _beside_seam(a[on], b[on], cuts.seam)
    return Places(who, region, a, b, p, x, measure)


def _kinds(speed: Array, chi: Array) -> NDArray[np.int8]:
    """Return the kinds of impacts."""
    # abs(psi1) > 2 chi tells near from far where chi < 1/2, and early from late where slip comes
    # first.
    beyond = (speed > 2.0 * chi).view(np.int8)
    fast = (speed >= 4.0 * chi - 1.0).view(np.int8)
    fast += beyond
    fast += EARLY
    fast *= speed > 1.0
    slow = (chi >= 0.5).view(np.int8)
    slow *= STUCK
    beyond ^= 1
    return np.maximum(fast, np.maximum(slow, beyond, out=slow), out=fast)


def _beside_seam(t: Array, b: Array, seam: Array) -> Array:
    """Return the first coordinate in SLIP_ON, of t/CUT_END."""
    at = polynomial(seam, np.where(b.real > SEAM_FROM, b, SEAM_FROM))
    a = t / at
    a *= 0.5
    late = (a.real > 0.5).nonzero()[0]
    at = at[late]
    a[late] = 0.5 + 0.5 * (t[late] - at) / (1.0 - at)
    return a


def _across(chi: Array, cut: Array, top: float) -> tuple[Array, Rows]:
    """Return the second coordinates on both sides of a cut, and which impacts are above it."""
    b = (chi - 0.5) / (cut - 0.5)
    above = (chi >= cut).nonzero()[0]
    edge = cut[above]
    b[above] = np.sqrt((chi[above] - edge) / (top - edge))
    return b, above
