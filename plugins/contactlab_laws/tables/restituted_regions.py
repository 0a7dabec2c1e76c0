"""Coordinates in which psi2(psi1, chi, e) is smooth: regions of dyadic patches (theory §15).

A fine grid of each region tells the patch of an impact.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.array_api import Computed
from contactlab.numeric.arrays import choose
from contactlab.numeric.types import Array, Real
from contactlab.numeric.vectors import square_root
from contactlab_laws.tables.file import Stored
from contactlab_laws.tables.patches import Patches, powers_of_chebyshev

#: Range of chi in the table. Largest errors of psi2: in the table up to chi ``NEARER``, and up to
#: its end; and of springs beyond it over sqrt(chi/3): ``tests/laws/test_restituted_table.py``.
RESTITUTED_CHI, NEARER = (0.3, 3.0), 2.0
RESTITUTED_ERROR, WIDER_ERROR, BEYOND_ERROR = 5e-5, 1.5e-4, 3e-4


class Region(NamedTuple):
    """Impacts that stick from the start, psi1 < 1, or slip first; a range of chi."""

    slips: bool
    low: float
    high: float


#: In a region that sticks the coordinates are psi1, chi and e, and psi2/psi1 is tabulated; in one
#: that slips 1 - sqrt((K - psi1)/(K - 1)), chi and e, and psi2 is, where K is ``border``.
REGIONS = (
    Region(False, RESTITUTED_CHI[0], 0.5),
    Region(False, 0.5, RESTITUTED_CHI[1]),
    Region(True, 0.5, 1.5),
    Region(True, 1.5, 2.0),
    Region(True, 2.0, RESTITUTED_CHI[1]),
)
#: Borders of chi between the regions that slip.
SLIPPING = (1.5, 2.0)
LOW = np.array([each.low for each in REGIONS])
PER_WIDTH = np.array([1.0 / (each.high - each.low) for each in REGIONS])
#: Powers of each coordinate in a patch: of that of psi1, of chi and of e.
NODES = (8, 6, 6)


def bound_restitution_error(chi: Real, restitution: Real) -> Real:
    """Return the bound of the error of psi2 below a restitution of 1; 0 at e = 0."""
    far = BEYOND_ERROR * square_root(chi / RESTITUTED_CHI[1])
    wide = choose(chi <= RESTITUTED_CHI[1], WIDER_ERROR, far)
    near = choose(chi <= NEARER, RESTITUTED_ERROR, wide)
    return choose(restitution == 0.0, 0.0 * near, near)


def border(chi: Computed, e: Computed | float) -> Computed:
    """Return psi1 from which an impact that has slipped first slips throughout; for chi > 1/2."""
    return 2.0 * chi * (1.0 + e) - e


@attrs.frozen(eq=False)
class Table:
    """The table as it is evaluated, over three coordinates, or over two at one restitution.

    Attributes
    ----------
    grid : array of int16
        The patch at each place of the fine grids of the regions, one after the other.
    starts : array of int, shape (regions,)
        Where the grid of each region begins.
    sizes : array of int, shape (coordinates, regions)
        Numbers of cells of the fine grids.
    patches : Patches
    """

    grid: NDArray[np.int16]
    starts: NDArray[np.int32]
    sizes: NDArray[np.int32]
    patches: Patches

    @classmethod
    def of(cls, stored: Stored) -> Table:
        """Return the table of a file.

        ``cells`` are region, levels and indices of dyadic cells along the three coordinates;
        ``terms`` those by Chebyshev's polynomials of the local coordinates in [-1, 1].
        """
        cells, terms = stored.arrays["cells"].astype(np.int32), stored.arrays["terms"]
        region, level, place = cells[:, 0], cells[:, 1:4], cells[:, 4:]
        low = np.array([(0.0, each.low, 0.0) for each in REGIONS])[region]
        width = np.array([(1.0, each.high - each.low, 1.0) for each in REGIONS])[region]
        half = 0.5 * width * 0.5**level
        origins: Array = low + (2 * place + 1) * half
        by_powers = terms.astype(np.float64)
        for axis, count in enumerate(NODES):
            matrix = powers_of_chebyshev(count, stretch=1.0, shift=0.0)
            by_powers = np.moveaxis(np.tensordot(by_powers, matrix, (axis + 1, 1)), -1, axis + 1)
            shape = np.ones(4, dtype=int)
            shape[[0, axis + 1]] = len(cells), count
            by_powers *= (half[:, axis, None] ** -np.arange(count)).reshape(shape)
        sizes = np.array([2 ** level[region == r].max(axis=0) for r in range(len(REGIONS))])
        grids = [np.full(size, -1, dtype=np.int16) for size in sizes]
        for number, (r, *cell) in enumerate(cells.tolist()):
            parts = zip(sizes[r], cell[:3], cell[3:], strict=True)
            where = tuple(slice((i * n) >> m, ((i + 1) * n) >> m) for n, m, i in parts)
            grids[r][where] = number
        return cls._over(grids, Patches(origins.T.copy(), by_powers, _whole(by_powers)))

    @classmethod
    def _over(cls, grids: list[NDArray[np.int16]], patches: Patches) -> Table:
        """Return the table of the grids of all regions."""
        starts = np.cumsum([0, *(grid.size for grid in grids[:-1])]).astype(np.int32)
        sizes = np.array([grid.shape for grid in grids], dtype=np.int32).T
        return cls(np.concatenate([each.ravel() for each in grids]), starts, sizes, patches)

    def at(self, e: float) -> Table:
        """Return the table at one restitution."""
        grids = []
        for start, size in zip(self.starts, self.sizes.T, strict=True):
            grid = self.grid[start : start + size.prod()].reshape(size)
            grids.append(grid[:, :, index(e, size[2])])
        numbers = np.unique(np.concatenate([each.ravel() for each in grids]))
        renumbered = np.full(len(self.patches.terms), -1, dtype=np.int16)
        renumbered[numbers] = np.arange(numbers.size)
        origins = self.patches.origins[:, numbers]
        terms = self.patches.terms[numbers]
        by_e = (e - origins[2])[:, None] ** np.arange(terms.shape[3])
        terms = np.matmul(terms.reshape(len(terms), -1, terms.shape[3]), by_e[..., None])
        terms = terms.reshape(-1, *NODES[:2])
        patches = Patches(origins[:2].copy(), terms, _whole(terms))
        return self._over([renumbered[each] for each in grids], patches)

    def values(self, slips: NDArray[np.bool_], u: Array, *others: Array) -> Array:
        """Return the tabulated quantity at places."""
        chi = others[0]
        region = (chi.real >= REGIONS[0].high).view(np.int8) + slips
        for bound in SLIPPING:
            region += slips & (chi.real >= bound)
        where = _places(u, self.sizes[0].take(region))
        share = (chi.real - LOW.take(region)) * PER_WIDTH.take(region)
        where = where * self.sizes[1].take(region) + _places(share, self.sizes[1].take(region))
        for each, size in zip(others[1:], self.sizes[2:], strict=True):
            where = where * size.take(region) + _places(each, size.take(region))
        where += self.starts.take(region)
        return self.patches.values(self.grid.take(where), u, *others)


def _whole(terms: Array) -> list[list[int]]:
    """Return the powers of each patch: all of them."""
    return [[terms.shape[1]] * len(terms), [math.prod(terms.shape[2:])] * len(terms)]


def index(share: float, size: int) -> int:
    """Return the place of a coordinate in [0, 1] in a grid."""
    return min(int(share * size), size - 1)


def _places(share: Array, size: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the places of coordinates in [0, 1] in grids."""
    return np.minimum((share.real * size).astype(np.int32), size - 1)
