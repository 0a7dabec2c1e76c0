"""``rebound``: psi2 of impacts whose restitution is given."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from contactlab_damped_table.coordinates import (
    BORDERS,
    CHI,
    RESTITUTION,
    SLIPS,
    STICKS,
    TURNS,
    depth,
    inner,
    place,
    rough,
)
from contactlab_damped_table.table import SHIPPED, Table, read

Array = NDArray[np.float64]

#: Impacts computed together, which fit into a processor's cache.
CHUNK = 2048


@cache
def shipped() -> Table:
    """Return the table that came with the package."""
    return read(SHIPPED)


def tabulated(chi: Any, restitution: Any) -> Any:
    """Return which impacts the table holds."""
    inside = (chi >= CHI[0]) & (chi <= CHI[1])
    return inside & (restitution >= RESTITUTION[0]) & (restitution <= RESTITUTION[1])


def rebound(psi1: Array, chi: Array, restitution: float) -> Array:
    """Return psi2 of spheres under Tsuji's law, to 2e-4; odd in psi1 to the last bit.

    Parameters
    ----------
    psi1 : array, shape (impacts,)
    chi : array, shape (impacts,)
        From 0.8 to 1.8.
    restitution : float
        e, from 0.5 to 1.
    """
    cuts, terms = _at(restitution)
    psi2 = np.empty(psi1.shape)
    for first in range(0, len(psi1), CHUNK):
        part = slice(first, first + CHUNK)
        psi2[part] = _chunk(np.abs(psi1[part]), chi[part], restitution, cuts, terms)
    return np.copysign(psi2, psi2 * np.where(psi1 < 0.0, -1.0, 1.0))


@lru_cache(maxsize=64)
def _at(restitution: float) -> tuple[Array, Array]:
    """Return the coefficients of cuts (chi, 2) and of values (3, chi, psi1) at a restitution."""
    table, t = shipped(), float(depth(restitution))
    piece = int(t > BORDERS[1])
    low, high = BORDERS[piece : piece + 2]
    basis = chebyshev.chebvander(inner(t, low, high), table.terms.shape[-1] - 1)[0]
    cuts, terms = table.cuts[piece] @ basis, table.terms[piece] @ basis
    return np.ascontiguousarray(cuts.T), np.ascontiguousarray(terms.swapaxes(1, 2))


def _chunk(psi1: Array, chi: Array, e: float, cuts: Array, terms: Array) -> Array:
    along = chebyshev.chebvander(inner(chi, *CHI), cuts.shape[0] - 1)
    low, high = (along @ cuts).T
    piece = (psi1 > low).astype(np.int8) + (psi1 > high)
    psi2 = np.empty(psi1.shape)
    for part in (STICKS, TURNS, SLIPS):
        rows = np.flatnonzero(piece == part)
        if rows.size:
            ours = psi1[rows], chi[rows]
            at = place(part, ours[0], (low[rows], high[rows]))
            columns = along[rows] @ terms[part]
            value = _summed(at, columns)
            psi2[rows] = rough(part, ours[0], value, ours[1], e)
    return psi2


def _summed(at: Array, columns: Array) -> Array:
    """Return the sum of Chebyshev polynomials with coefficients of their own, by Clenshaw."""
    columns = np.ascontiguousarray(columns.T)
    twice, one, two = 2.0 * at, columns[-1], 0.0
    for row in columns[-2:0:-1]:
        one, two = row + twice * one - two, one
    return np.asarray(columns[0] + at * one - two)
