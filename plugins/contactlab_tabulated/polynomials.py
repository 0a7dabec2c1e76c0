"""The patches as they are evaluated: without the terms that are too small to matter."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab_tabulated.fit import to_chebyshev
from contactlab_tabulated.table import NODES, Table

Array = NDArray[np.float64]

#: What is left out along each coordinate changes g by less: an eighth is left of 12 terms by 12.
SMALL = 1e-11


@attrs.frozen(eq=False)
class Polynomials:
    """g by powers of a and b, each less its value at the corner of the cell.

    Patches are numbered by how many powers of a they need, so that those that are sorted need as
    many as their neighbours.

    Attributes
    ----------
    grid : array of int16, shape (regions * 64 * 64,)
        The patch at each place of the fine grid of each region.
    corners : array, shape (2, patches)
        Of the cells, least a and b.
    terms : array, shape (patches, 12, 12)
        Zero where they are left out.
    needed : array of int, shape (2, patches)
        Powers of a and of b that are left.
    """

    grid: NDArray[np.int16]
    corners: Array
    terms: Array
    needed: NDArray[np.intp]

    @classmethod
    def of(cls, table: Table) -> Polynomials:
        """Return the polynomials of a table."""
        found = to_chebyshev() @ table.terms @ to_chebyshev().T
        sizes = np.abs(found)
        needed = np.array([_needed(sizes.sum(axis=2)), _needed(sizes.sum(axis=1))])
        kept = np.arange(NODES) < needed[..., None]
        inside = kept[0, :, :, None] & kept[1, :, None, :]
        back = np.linalg.inv(to_chebyshev())
        terms = (table.terms - back @ np.where(inside, 0.0, found) @ back.T) * inside
        scales, places = np.array(table.scales), np.array(table.corners)
        power_a, power_b = scales[..., None] ** np.arange(NODES)  # of two: nothing is rounded
        terms *= power_a[:, :, None] * power_b[:, None, :]
        order = np.argsort(needed[0], kind="stable")
        rank = np.empty(order.size, dtype=np.int16)
        rank[order] = np.arange(order.size)
        corners = places / scales
        return cls(rank[table.grid.ravel()], corners[:, order], terms[order], needed[:, order])


def _needed(sizes: Array) -> NDArray[np.intp]:
    """Return how many terms are needed along a coordinate, at least one, shape (patches,)."""
    left = np.cumsum(sizes[:, ::-1], axis=1)[:, ::-1]
    return np.maximum(np.count_nonzero(left > SMALL, axis=1), 1)
