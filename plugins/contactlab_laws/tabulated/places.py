"""The places of impacts: their regions, and their coordinates there."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab_laws.tabulated.coordinates import (
    CUT_END,
    CUT_TOP,
    LARGEST_CHI,
    REGIONS,
    SLIP_BACK,
    SLIP_LATE,
    SLIP_LONG,
    SLIP_ON,
    SMALL_FAR,
    SMALL_NEAR,
    STUCK_BACK,
    STUCK_ON,
    Cuts,
    polynomial,
    slip_cut,
)

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

#: Kinds of impact: one or two regions each, but for EARLY, which three of the slip regions share,
#: and FULL, which slips throughout and needs no table.
NEAR, FAR, STUCK, EARLY, LATE, FULL = range(6)


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

    def taken(self, part: slice | Rows) -> Places:
        """Return some of them, in views if ``part`` is a slice."""
        columns: Any = (column[part] for column in self)
        return Places(*columns)

    def parts(self) -> list[tuple[int, Rows]]:
        """Return regions, and which of the places are in each."""
        found = [(region, (self.region == region).nonzero()[0]) for region in range(REGIONS)]
        return [(region, part) for region, part in found if part.size]


def places(speed: Array, chi: Array, cuts: Cuts) -> Places:
    """Return the places of impacts with chi <= LARGEST_CHI, but for those slipping throughout.

    Parameters
    ----------
    speed, chi : array, shape (impacts,)
        abs(psi1) and chi; no units.
    cuts : Cuts
        Polynomials of the boundaries between regions.
    """
    kind = _kinds(speed, chi)
    stops = [int(np.count_nonzero(kind <= last)) for last in range(FULL)]
    who = np.argsort(kind, kind="stable")[: stops[-1]]
    p, x = speed[who], chi[who]
    measure = np.abs(2.0 * x - 1.0)
    region = np.empty(who.size, dtype=np.int32)
    here = Places(who, region, np.empty_like(p), np.empty_like(p), p, x, measure)
    start = 0
    for stop, place in zip(stops, (_near, _far, _stuck, _early, _late), strict=True):
        if stop > start:
            place(here.taken(slice(start, stop)), cuts)
        start = stop
    return here


def _kinds(speed: Array, chi: Array) -> NDArray[np.int8]:
    """Return the kinds of impacts.

    abs(psi1) > 2 chi tells near from far where chi < 1/2, and early from late where slip comes
    first.
    """
    beyond = (speed > 2.0 * chi).view(np.int8)
    fast = (speed >= 4.0 * chi - 1.0).view(np.int8)
    fast += beyond
    fast += EARLY
    fast *= speed > 1.0
    slow = (chi >= 0.5).view(np.int8)
    slow *= STUCK
    beyond ^= 1
    return np.maximum(fast, np.maximum(slow, beyond, out=slow), out=fast)


def _near(here: Places, _: Cuts) -> None:
    """Fill in the places of impacts with chi < 1/2, the edge of which soon slips."""
    here.region[:] = SMALL_NEAR
    np.divide(1.0 - here.speed, here.measure, out=here.a)
    np.power(here.a, 0.2, out=here.a)
    here.b[:] = here.measure


def _far(here: Places, _: Cuts) -> None:
    """Fill in the places of impacts with chi < 1/2 that stick for long."""
    here.region[:] = SMALL_FAR
    np.subtract(1.0, here.speed, out=here.b)
    np.divide(here.measure, here.b, out=here.a)
    here.measure[:] = here.b


def _stuck(here: Places, cuts: Cuts) -> None:
    """Fill in the places of impacts with psi1 <= 1, chi >= 1/2."""
    here.region[:] = STUCK_BACK
    here.a[:] = here.speed
    here.b[:], above = _across(here.chi, polynomial(cuts.stuck, here.speed), LARGEST_CHI)
    here.region[above] = STUCK_ON


def _early(here: Places, cuts: Cuts) -> None:
    """Fill in the places of impacts that slip first, up to maximum compression at most."""
    here.region[:] = SLIP_LONG
    t = ((here.speed - 1.0) / here.measure) ** 0.2
    np.multiply(t - CUT_END, 1.0 / (1.0 - CUT_END), out=here.a)
    _over_all(here)
    short = (t <= CUT_END).nonzero()[0]
    t = t[short]
    cut = slip_cut(cuts.slip, t)
    here.region[short] = SLIP_BACK
    here.a[short] = t * (1.0 / CUT_END)
    here.b[short], above = _across(here.chi[short], cut, CUT_TOP)
    here.region[short[above]] = SLIP_ON


def _late(here: Places, _: Cuts) -> None:
    """Fill in the places of impacts that slip first, beyond maximum compression."""
    here.region[:] = SLIP_LATE
    np.divide(here.speed - 1.0, here.measure, out=here.a)
    here.a[:] -= 1.0
    _over_all(here)


def _over_all(here: Places) -> None:
    """Fill in the second coordinate of regions that reach from chi = 1/2 to LARGEST_CHI."""
    np.multiply(here.measure, 0.5 / (LARGEST_CHI - 0.5), out=here.b)


def _across(chi: Array, cut: Array, top: float) -> tuple[Array, Rows]:
    """Return the second coordinates on both sides of a cut, and which impacts are above it.

    Parameters
    ----------
    chi, cut : array, shape (impacts,)
        chi of the impacts, and of the cut.
    top : float
        chi at the upper end.
    """
    b = (chi - 0.5) / (cut - 0.5)
    above = (chi >= cut).nonzero()[0]
    edge = cut[above]
    b[above] = np.sqrt((chi[above] - edge) / (top - edge))
    return b, above
