"""psi2 of spheres with a restitution: one loss for pressure and shear, tabulated (theory §15).

Coordinates in which psi2(psi1, chi, e) is smooth: theory §15, "The table". Impacts that slip
throughout, and those of e = 0, are known in closed form.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose.rebound import RESTITUTED_CHI, TABULATED_CHI
from contactlab.numeric.checks import Real
from contactlab_laws.tables import elastic
from contactlab_laws.tables.file import Stored, read
from contactlab_laws.tables.patches import Array, Patches, Single, powers_of_chebyshev

SHIPPED = Path(__file__).with_name("restituted.npz")
#: Powers of each coordinate in a patch: of that of psi1, of chi and of e.
NODES = (8, 6, 6)
#: Fewer impacts than this are computed one by one; so many are taken together at most.
FEW, BLOCK = 12, 1 << 15
#: e above which psi2 goes over to the elastic table, so that no jump is seen at 1.
JOINED = 0.99
#: Imaginary step for derivatives: its square vanishes.
STEP = 1e-30


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


def border(chi: Any, e: Any) -> Any:
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
        Of the fine grids.
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
            grids.append(grid[:, :, _index(e, size[2])])
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
        place = self.starts.take(region)
        index = _along(u, self.sizes[0].take(region))
        share = (chi.real - LOW.take(region)) * PER_WIDTH.take(region)
        index = index * self.sizes[1].take(region) + _along(share, self.sizes[1].take(region))
        for each, size in zip(others[1:], self.sizes[2:], strict=True):
            index = index * size.take(region) + _along(each, size.take(region))
        return self.patches.values(self.grid.take(place + index), u, *others)


LOW = np.array([each.low for each in REGIONS])
PER_WIDTH = np.array([1.0 / (each.high - each.low) for each in REGIONS])


def _whole(terms: Array) -> list[list[int]]:
    """Return the powers that are left in each patch: all."""
    return [[terms.shape[1]] * len(terms), [math.prod(terms.shape[2:])] * len(terms)]


def _index(share: float, size: int) -> int:
    """Return the place of a coordinate in [0, 1] in a grid."""
    return min(int(share * size), size - 1)


def _along(share: Array, size: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the places of coordinates in [0, 1] in grids."""
    return np.minimum((share.real * size).astype(np.int32), size - 1)


@cache
def shipped() -> Table:
    """Return the table that came with the package."""
    return Table.of(read(SHIPPED))


@lru_cache(maxsize=16)
def section(e: float) -> Table:
    """Return the table at one restitution."""
    return shipped().at(e)


def rebound(psi1: Any, chi: Any, restitution: Any, *, derivatives: bool = False) -> Any:
    """Return psi2, odd in psi1 to the last bit, abs(psi2) <= abs(psi1).

    Parameters
    ----------
    psi1 : float or array, shape (impacts,)
        Finite.
    chi : float or array, shape (impacts,)
        From 0.3 to 3.
    restitution : float or array, shape (impacts,)
        e, from 0 to 1, 1 excluded.
    derivatives : bool
        Whether to return (psi2, d psi2/d psi1, d psi2/d chi, d psi2/d e); arrays only.
    """
    if isinstance(psi1, float):
        return single(psi1, chi, restitution)
    alike = isinstance(restitution, float)
    if psi1.size < FEW:
        e = (restitution,) * psi1.size if alike else restitution.tolist()
        psi2 = np.array(list(map(single, psi1.tolist(), chi.tolist(), e)))
    else:
        psi2 = _by_blocks(np.abs(psi1), chi, restitution)
        np.negative(psi2, out=psi2, where=psi1 < 0.0)
    if not derivatives:
        return psi2
    by_psi1, by_chi, by_e = gradient(
        np.abs(psi1), chi, np.full(psi1.shape, restitution) if alike else restitution
    )
    sign = np.copysign(1.0, psi1)
    return psi2, by_psi1, by_chi * sign, by_e * sign


@np.errstate(under="ignore")  # small numbers may vanish, whatever a user has asked for
def _by_blocks(speed: Array, chi: Array, restitution: Real) -> Array:
    """Return psi2 of psi1 = speed >= 0, shape (impacts,)."""
    psi2 = np.empty_like(speed)
    for first in range(0, speed.size, BLOCK):
        part = slice(first, first + BLOCK)
        e = restitution if isinstance(restitution, float) else restitution[part]
        psi2[part] = _together(speed[part], chi[part], e)
    return psi2


def _together(speed: Array, chi: Array, e: Real) -> Array:
    """Return psi2 of a block of impacts."""
    psi2 = full_slip(speed, chi, e)
    who = np.flatnonzero(sticks(speed, chi, e))
    if not who.size:
        return psi2
    p, x, own = speed[who], chi[who], e if isinstance(e, float) else e[who]
    found = _partial(p, x, own)
    near = np.asarray(own > JOINED)
    if near.any():
        rows = np.flatnonzero(np.broadcast_to(near, p.shape) & (x <= TABULATED_CHI))
        here = own if isinstance(own, float) else own[rows]
        found[rows] += _share(here) * _step(p[rows], x[rows])
    if np.any(own == 0.0):
        found = np.where(own == 0.0, without_rebound(p, x), found)
    # no impact gains energy, nor more impulse than full slip gives: not even by an error
    found = np.maximum(found, psi2[who])
    psi2[who] = np.clip(found, -p, p)
    return np.asarray(psi2)


def full_slip(speed: Array, chi: Array, e: Real) -> Array:
    """Return psi2 of slip throughout."""
    return np.asarray(speed - 2.0 * chi * (1.0 + e))


def sticks(speed: Any, chi: Any, e: Any) -> Any:
    """Return whether impacts do not slip throughout."""
    return speed < np.maximum(border(chi, e), 1.0)


def _partial(speed: Array, chi: Array, e: Any) -> Array:
    """Return psi2 from the table; of complex numbers too."""
    slips = speed.real > 1.0
    u, rows = speed.copy(), np.flatnonzero(slips)
    own = e if np.ndim(e) == 0 else e[rows]
    end = border(chi[rows], own)
    u[rows] = 1.0 - np.sqrt((end - speed[rows]) / (end - 1.0))
    if isinstance(e, float):
        psi2 = section(e).values(slips, u, chi)
    else:
        psi2 = shipped().values(slips, u, chi, e)
    return np.multiply(psi2, speed, out=psi2, where=~slips)


def _share(e: Any) -> Any:
    """Return the share of ``_step`` at e above ``JOINED``."""
    return ((e - JOINED) / (1.0 - JOINED)) ** 2


def _step(speed: Array, chi: Array) -> Array:
    """Return the elastic psi2 less that of the table at e = 1, which is its error."""
    return np.asarray(elastic.values(elastic.shipped(), speed, chi) - _partial(speed, chi, 1.0))


def without_rebound(speed: Array, chi: Array) -> Array:
    """Return psi2 of e = 0 where an impact does not slip throughout."""
    rest = np.maximum(1.0 - 2.0 * chi, np.finfo(float).tiny)
    return np.asarray(rest * np.minimum(speed, 1.0) ** (1.0 / rest))


@np.errstate(under="ignore")
def gradient(speed: Array, chi: Array, e: Array) -> tuple[Array, Array, Array]:
    """Return d psi2/d psi1, d psi2/d chi and d psi2/d e for psi1 = speed >= 0.

    By a complex step: the imaginary part of psi2 at psi1 + ih over h, and so on.
    """
    by_psi1, by_chi, by_e = np.ones_like(speed), -2.0 * (1.0 + e), -2.0 * chi
    who = np.flatnonzero(sticks(speed, chi, e))
    p, x, own = (np.concatenate((each[who],) * 3).astype(complex) for each in (speed, chi, e))
    for k, each in enumerate((p, x, own)):
        each[k * who.size : (k + 1) * who.size] += 1j * STEP
    slopes = (_partial(p, x, own).imag / STEP).reshape(3, -1)
    near = np.flatnonzero((e[who] > JOINED) & (chi[who] <= TABULATED_CHI))
    if near.size:
        q, y, own = speed[who][near], chi[who][near], e[who][near]
        slopes[2, near] += 2.0 * np.sqrt(_share(own)) / (1.0 - JOINED) * _step(q, y)
        p, x = np.concatenate((q, q)).astype(complex), np.concatenate((y, y)).astype(complex)
        p[: q.size] += 1j * STEP
        x[q.size :] += 1j * STEP
        ours = (_partial(p, x, 1.0).imag / STEP).reshape(2, -1)
        exact = elastic.gradient(elastic.shipped(), q, y)
        slopes[:2, near] += _share(own) * (np.array(exact) - ours)
    by_psi1[who], by_chi[who], by_e[who] = slopes
    return by_psi1, by_chi, by_e


@lru_cache(maxsize=64)
def _kept(_: float) -> dict[int, Callable[[float, float], float]]:
    """Return the patches at one restitution in plain numbers, those that were asked for."""
    return {}


@cache
def _plain() -> tuple[list[int], list[list[int]], list[int]]:
    """Return grid, sizes and starts of the shipped table in plain numbers."""
    table = shipped()
    return table.grid.tolist(), table.sizes.T.tolist(), table.starts.tolist()


def single(psi1: float, chi: float, e: float) -> float:
    """Return psi2 of one impact, in plain floats."""
    speed = abs(psi1)
    least = speed - 2.0 * chi * (1.0 + e)
    end = border(chi, e)
    if speed >= 1.0 and speed >= end:
        return least if psi1 >= 0.0 else -least
    if e == 0.0:
        psi2 = (1.0 - 2.0 * chi) * speed ** (1.0 / (1.0 - 2.0 * chi)) if chi < 0.5 else 0.0
    else:
        psi2 = _single(speed, chi, e, end)
        if e > JOINED and chi <= TABULATED_CHI:
            exact = elastic.rebound(speed, chi)
            psi2 += _share(e) * (exact - _single(speed, chi, 1.0, border(chi, 1.0)))
        psi2 = max(psi2, least, -speed)
        psi2 = min(psi2, speed)
    return psi2 if psi1 >= 0.0 else -psi2


def _single(speed: float, chi: float, e: float, end: float) -> float:
    """Return psi2 of one impact from the table."""
    if speed > 1.0:
        region = 2 + (chi >= SLIPPING[0]) + (chi >= SLIPPING[1])
        u, unit = 1.0 - math.sqrt((end - speed) / (end - 1.0)), 1.0
    else:
        region, u, unit = int(chi >= 0.5), speed, speed
    grid, sizes, starts = _plain()
    (rows, columns, layers), (_, low, high) = sizes[region], REGIONS[region]
    i, j = _index(u, rows), _index((chi - low) / (high - low), columns)
    patch = grid[starts[region] + (i * columns + j) * layers + _index(e, layers)]
    kept = _kept(e)
    value = kept.get(patch)
    if value is None:
        patches = shipped().patches
        *origin, start = patches.origins[:, patch].tolist()
        by_e = (e - start) ** np.arange(NODES[2])
        value = kept[patch] = Single(np.array(origin), patches.terms[patch] @ by_e, kept, patch)
    return unit * value(u, chi)
