"""``rebound``: psi2 of impacts whose restitution is given."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from contactlab_laws.damped_table.coordinates import (
    BORDERS,
    CHI,
    RESTITUTION,
    SLIPS,
    depth,
    inner,
    place,
    rough,
)
from contactlab_laws.damped_table.table import SHIPPED, Table, read

Array = NDArray[np.float64]

#: Impacts computed together: fewer cost more calls, more leave the processor's cache.
CHUNK = 8192
#: The last terms along psi1 are left out that together are no more than this: less than the
#: rings are off that the table is made of.
SMALL = 1e-5
#: Rings beyond the table, and psi1 beyond which the change of psi is its limit to 1e-4.
COUNTS, LARGEST = (48, 64, 80), 1e4


@cache
def shipped() -> Table:
    """Return the table that came with the package."""
    return read(SHIPPED)


def tabulated(chi: Any, restitution: Any) -> Any:
    """Return which impacts the table holds."""
    inside = (chi >= CHI[0]) & (chi <= CHI[1])
    return inside & (restitution >= RESTITUTION[0]) & (restitution <= RESTITUTION[1])


@np.errstate(under="ignore")  # small numbers may vanish, whatever a user has asked for
def rebound(psi1: Array, chi: Array, restitution: float) -> Array:
    """Return psi2 of spheres under Tsuji's law, shape (impacts,); odd in psi1 to the last bit.

    With Coulomb's law at every point: by the table where it reaches, elsewhere by rings.

    Parameters
    ----------
    psi1 : array, shape (impacts,)
    chi : array, shape (impacts,)
        Up to 10, as far as the rings were tried.
    restitution : float
        e.
    """
    speed, known = np.abs(psi1), tabulated(chi, restitution)
    if known.all():
        psi2 = _by_table(speed, chi, restitution)
    else:
        psi2 = np.empty(psi1.shape)
        psi2[known] = _by_table(speed[known], chi[known], restitution) if known.any() else 0.0
        psi2[~known] = by_rings(speed[~known], chi[~known], restitution)
    return np.copysign(psi2, psi2 * np.where(psi1 < 0.0, -1.0, 1.0))


def by_rings(psi1: Array, chi: Array, e: float, *, counts: tuple[int, ...] = COUNTS) -> Array:
    """Return psi2 of psi1 >= 0 by rings, shape (impacts,).

    Parameters
    ----------
    psi1, chi : array, shape (impacts,)
    e : float
        Restitution.
    counts : tuple of int
        Numbers of rings.
    """
    from contactlab_laws.damped_table import courses  # a table needs no normal motion

    near = np.minimum(psi1, LARGEST)
    change = courses.solve(near, chi, courses.tsuji(e), counts=counts) - near
    # no impact gains energy: not even by an error
    return np.asarray(np.clip(psi1 + change, -psi1, psi1))


def _by_table(psi1: Array, chi: Array, restitution: float) -> Array:
    """Return psi2 of psi1 >= 0 from the table, shape (impacts,)."""
    cuts, terms = _at(restitution)
    psi2 = np.empty(psi1.shape)
    for first in range(0, len(psi1), CHUNK):
        part = slice(first, first + CHUNK)
        psi2[part] = _chunk(psi1[part], chi[part], restitution, cuts, terms)
    return psi2


@lru_cache(maxsize=64)
def _at(restitution: float) -> tuple[Array, list[Array]]:
    """Return coefficients at a restitution: of the cuts (3, chi), and of each piece (psi1, chi)."""
    table, t = shipped(), float(depth(restitution))
    piece = int(t > BORDERS[1])
    low, high = BORDERS[piece : piece + 2]
    basis = chebyshev.chebvander(inner(t, low, high), table.terms.shape[-1] - 1)[0]
    return table.cuts[piece] @ basis, [_kept(each @ basis) for each in table.terms[piece]]


def _kept(terms: Array) -> Array:
    """Return the terms up to the last that matters, two at least."""
    rest = np.cumsum(np.abs(terms).sum(axis=1)[::-1])[::-1]
    return np.ascontiguousarray(terms[: max(np.count_nonzero(rest > SMALL), 2)])


def _chunk(psi1: Array, chi: Array, e: float, cuts: Array, terms: list[Array]) -> Array:
    """Return psi2 of impacts of one restitution, shape (impacts,).

    Parameters
    ----------
    psi1, chi : array, shape (impacts,)
    e : float
        Restitution.
    cuts : array, shape (3, terms)
        Polynomials in chi of the cuts.
    terms : list of array
        Of each piece: polynomials in psi1 and chi.
    """
    along = _polynomials(inner(chi, *CHI), cuts.shape[-1])
    borders = cuts @ along
    piece = (psi1 > borders).sum(axis=0)
    psi2 = np.empty(psi1.shape)
    for part in range(SLIPS + 1):
        rows = np.flatnonzero(piece == part)
        if rows.size:
            ours = psi1[rows], chi[rows]
            at = place(part, ours[0], borders[:, rows])
            value = _summed(at, terms[part] @ along.take(rows, axis=1))
            psi2[rows] = rough(part, ours[0], value, ours[1], e)
    return psi2


def _polynomials(at: Array, count: int) -> Array:
    """Return so many of Chebyshev's polynomials at ``at``, one a row."""
    found = np.empty((count, len(at)))
    found[0], found[1], twice = 1.0, at, 2.0 * at
    for k in range(2, count):
        np.multiply(twice, found[k - 1], out=found[k])
        found[k] -= found[k - 2]
    return found


def _summed(at: Array, columns: Array) -> Array:
    """Return the sum of Chebyshev polynomials with coefficients of their own, by Clenshaw."""
    if at.size == 1:  # plain numbers: a collision alone takes most of its time otherwise
        return np.array([_sum(float(at[0]), columns[:, 0].tolist())])
    twice, one, two = 2.0 * at, columns[-1], np.zeros_like(at)
    for row in columns[-2:0:-1]:
        row -= two
        two = one
        row += twice * one
        one = row
    return np.asarray(columns[0] + at * one - two)


def _sum(at: float, column: list[float]) -> float:
    """Return the same of one impact, to the last bit."""
    twice, one, two = 2.0 * at, column[-1], 0.0
    for each in column[-2:0:-1]:
        one, two = (each - two) + twice * one, one
    return (column[0] + at * one) - two
