"""The patches as they are evaluated: without the terms that are too small to matter."""

from __future__ import annotations

from functools import cache

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab_laws.tabulated.fit import chebyshev_of_powers
from contactlab_laws.tabulated.table import NODES, Table

Array = NDArray[np.float64]

#: What is left out along each coordinate changes g by less; half of 12 terms by 12 are left.
SMALL = 1e-11


@attrs.frozen(eq=False)
class Polynomials:
    """g by powers of a and b, each less its value at the corner of the cell.

    Patches are numbered by how many powers they need, so that those that are sorted need as many
    as their neighbours.

    Attributes
    ----------
    grid : array of int16, shape (regions * 64 * 64,)
        The patch at each place of the fine grid of each region.
    corners : array, shape (2, patches)
        Of the cells, least a and b.
    terms : array, shape (patches, 12, 12)
        Zero where they are left out.
    needed : list of list of int
        Powers of a and of b that are left in each patch.
    """

    grid: NDArray[np.int16]
    corners: Array
    terms: Array
    needed: list[list[int]]

    @classmethod
    def of(cls, table: Table) -> Polynomials:
        """Return the polynomials of a table."""
        forth, back = chebyshev_of_powers(), _powers_of_chebyshev()
        found = forth @ table.terms @ forth.T
        sizes = np.abs(found)
        needed = np.array([_needed(sizes.sum(axis=2)), _needed(sizes.sum(axis=1))])
        kept = np.arange(NODES) < needed[..., None]
        found *= kept[0, :, :, None] & kept[1, :, None, :]
        terms = back @ found @ back.T
        scales, places = np.array(table.scales), np.array(table.corners)
        power_a, power_b = scales[..., None] ** np.arange(NODES)  # of two: nothing is rounded
        terms *= power_a[:, :, None] * power_b[:, None, :]
        order = np.lexsort(needed[::-1])
        rank = np.empty(order.size, dtype=np.int16)
        rank[order] = np.arange(order.size)
        corners = places / scales
        return cls(
            rank[table.grid.ravel()], corners[:, order], terms[order], needed[:, order].tolist()
        )


@cache
def polynomials_of(table: Table) -> Polynomials:
    """Return the patches of a table as they are evaluated, made once."""
    return Polynomials.of(table)


def _needed(sizes: Array) -> NDArray[np.intp]:
    """Return how many terms are needed along a coordinate, at least one, shape (patches,)."""
    left = np.cumsum(sizes[:, ::-1], axis=1)[:, ::-1]
    return np.asarray(np.maximum(np.count_nonzero(left > SMALL, axis=1), 1))


def _powers_of_chebyshev() -> Array:
    """Return the matrix from Chebyshev coefficients to powers: whole numbers, nothing rounded."""
    matrix = np.zeros((NODES, NODES))
    matrix[0, 0] = 1.0
    matrix[:2, 1] = -1.0, 2.0
    for k in range(2, NODES):
        matrix[1:, k] = 4.0 * matrix[:-1, k - 1]
        matrix[:, k] -= 2.0 * matrix[:, k - 1] + matrix[:, k - 2]
    return matrix
