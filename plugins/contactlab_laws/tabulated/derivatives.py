"""Derivatives of the table: d psi2/d psi1 and d psi2/d chi, from the same patches.

Distances from psi1 = 1 and from a cut enter as roots, whose slopes are infinite; there g has no
low powers (``fit.missing_powers``), exactly none, so that the products keep their digits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab_laws.tabulated.coordinates import (
    CUT_END,
    CUT_TOP,
    LARGEST_CHI,
    SLIP_BACK,
    SLIP_LATE,
    SLIP_LONG,
    SMALL_FAR,
    SMALL_NEAR,
    STUCK_BACK,
    STUCK_ON,
    Cuts,
    polynomial,
    slope,
)
from contactlab_laws.tabulated.evaluate import BLOCK, patches, powers, stretches
from contactlab_laws.tabulated.places import Places, places
from contactlab_laws.tabulated.table import NODES, Table

Array = NDArray[np.float64]

#: A place nearer to a cut than this, in its region's root, is taken to be this far: the limit.
NEAREST = 1e-9
#: Least t beside psi1 = 1, where the derivative by psi1 is a limit: delta is 1e-15 epsilon there.
LEAST_T = 1e-3


class Slopes(NamedTuple):
    """g and its derivatives by a and b."""

    g: Array
    by_a: Array
    by_b: Array


def gradient(table: Table, speed: Array, chi: Array) -> tuple[Array, Array]:
    """Return (d psi2/d psi1, d psi2/d chi) for psi1 = speed >= 0 and 0 < chi <= LARGEST_CHI."""
    by_psi1, by_chi = np.ones_like(speed), np.full_like(speed, -4.0)  # eq. (45)
    for first in range(0, speed.size, BLOCK):
        block = slice(first, first + BLOCK)
        here = places(speed[block], chi[block], table.cuts)
        if not here.who.size:
            continue
        np.maximum(here.b, NEAREST, out=here.b)
        for region, part in here.parts():
            if region == SMALL_NEAR:
                here.a[part] = np.maximum(here.a[part], LEAST_T)
        slopes = _slopes(table, here)
        for region, part in here.parts():
            who = first + here.who[part]
            local = Slopes(*(column[part] for column in slopes))
            by_psi1[who], by_chi[who] = _of_psi2(region, here.taken(part), local, table.cuts)
    return by_psi1, by_chi


def _slopes(table: Table, here: Places) -> Slopes:
    patch = patches(table.grid.ravel(), here)
    order = np.argsort(patch, kind="stable")
    result = Slopes(np.empty_like(here.a), np.empty_like(here.a), np.empty_like(here.a))
    factor = np.arange(1, NODES)[:, None]
    for number, part in stretches(patch):
        who = order[part]
        wide, high = table.scales[0][number], table.scales[1][number]
        x = powers(wide * here.a[who] - table.corners[0][number])
        y = powers(high * here.b[who] - table.corners[1][number])
        terms = table.terms[number]
        rows = terms @ y
        result.g[who] = np.einsum("kn,kn->n", rows, x)
        result.by_a[who] = wide * np.einsum("kn,kn->n", rows[1:], x[:-1] * factor)
        rows = terms[:, 1:] @ (y[:-1] * factor)
        result.by_b[who] = high * np.einsum("kn,kn->n", rows, x)
    return result


def _of_psi2(region: int, place: Places, slopes: Slopes, cuts: Cuts) -> tuple[Array, Array]:
    """Return both derivatives of psi2 = psi1 (-1 + measure g) in one region.

    Parameters
    ----------
    region : int
    place : Places
        In that region, all of them.
    slopes : Slopes
    cuts : Cuts
    """
    a, b, speed, measure = place.a, place.b, place.speed, place.measure
    g, by_a, by_b = slopes
    value = measure * g - 1.0
    if region == SMALL_FAR:  # measure delta; a = epsilon/delta, b = delta
        return value - speed * (g + measure * by_b - a * by_a), -2.0 * speed * by_a
    side = -1.0 if region == SMALL_NEAR else 1.0  # of epsilon in chi, and of delta in psi1
    by_main, by_chi = _main(region, a, b, by_a, by_b, cuts)
    if region in (STUCK_BACK, STUCK_ON):
        return value + speed * measure * by_main, speed * (2.0 * g + measure * by_chi)
    # the main coordinate depends on delta/epsilon = t^5: epsilon times its derivatives
    if region == SLIP_LATE:
        by_delta, by_epsilon = by_main, -(1.0 + a) * by_main
    else:
        t = _t(region, a)
        by_delta, by_epsilon = 0.2 * by_main / t**4, -0.2 * t * by_main
    by_chi = 2.0 * side * (g + by_epsilon) + measure * by_chi
    return value + side * speed * by_delta, speed * by_chi


def _t(region: int, a: Array) -> Array:
    """Return t = (delta/epsilon)^(1/5)."""
    if region == SMALL_NEAR:
        return a
    return CUT_END + a * (1.0 - CUT_END) if region == SLIP_LONG else a * CUT_END


def _main(
    region: int, a: Array, b: Array, by_a: Array, by_b: Array, cuts: Cuts
) -> tuple[Array, Array]:
    """Return the derivatives of g by the main coordinate (psi1, t or delta/epsilon) and by chi.

    Parameters
    ----------
    region : int
    a, b, by_a, by_b : ndarray
        Place, and the derivatives of g there.
    cuts : Cuts
    """
    if region == SMALL_NEAR:
        return by_a, -2.0 * by_b
    if region in (SLIP_LONG, SLIP_LATE):
        stretch = 1.0 / (1.0 - CUT_END) if region == SLIP_LONG else 1.0
        return stretch * by_a, by_b / (LARGEST_CHI - 0.5)
    stuck = region in (STUCK_BACK, STUCK_ON)
    terms = cuts.stuck if stuck else cuts.slip
    main = a if stuck else a * CUT_END
    cut, moves = polynomial(terms, main), polynomial(slope(terms), main)
    along = by_a if stuck else by_a / CUT_END
    if region in (STUCK_BACK, SLIP_BACK):
        by_chi = by_b / (cut - 0.5)
        return along - b * moves * by_chi, by_chi
    top = LARGEST_CHI if stuck else CUT_TOP
    by_chi = by_b / (2.0 * b) / (top - cut)
    return along - (1.0 - b * b) * moves * by_chi, by_chi
