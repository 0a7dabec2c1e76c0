"""psi2 of elastic spheres, tabulated for chi up to 2.5 (theory §10)."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, Literal, overload

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Real
from contactlab_laws.tables.file import Stored, read
from contactlab_laws.tables.patches import (
    Patches,
    chebyshev_of_values,
    compile_polynomial,
    count_terms,
    nodes,
    powers_of_chebyshev,
)
from contactlab_laws.tables.regions import (
    REGIONS,
    Cuts,
    Places,
    SingleCuts,
    place,
    places,
)

SHIPPED = Path(__file__).with_name("elastic.npz")
#: Error of psi2 over max(1, |psi1|): what the builder's ``verify`` holds the table to.
ERROR = 1e-9
#: Powers of each coordinate in a patch; cells are found in a grid of 2^DEEPEST by 2^DEEPEST.
NODES, DEEPEST = 12, 6
SIZE = 1 << DEEPEST
#: Terms below this change of g are left out; about half of 12 by 12 terms stay.
SMALL = 1e-11
#: Fewer impacts than this are computed one by one; so many are taken together at most.
FEW, BLOCK = 40, 1 << 16
#: Imaginary step for derivatives: its square vanishes, its fifth root is 1e-6.
STEP = 1e-30


@attrs.frozen(eq=False)
class Table:
    """The table as it is evaluated.

    Attributes
    ----------
    cuts : Cuts
    grid : array of int16, shape (regions * 64 * 64,)
        The patch at each place of the fine grid of each region.
    patches : Patches
        Numbered by how many powers they need, so that those that are sorted need as many as their
        neighbours.
    exact : Patches
        The same with all powers, for derivatives.
    """

    cuts: Cuts
    grid: NDArray[np.int16]
    patches: Patches
    exact: Patches

    @classmethod
    def of(cls, stored: Stored) -> Table:
        """Return the table of a file.

        ``cells`` are region, levels and indices along a and b of dyadic cells; ``terms`` those of
        g by powers of the local coordinates in [0, 1].
        """
        cells, terms = stored.arrays["cells"], stored.arrays["terms"]
        cuts = Cuts(*(stored.arrays[name] for name in Cuts._fields))
        forth = chebyshev_of_values(NODES) @ nodes(NODES)[:, None] ** np.arange(NODES)
        back = powers_of_chebyshev(NODES, stretch=2.0, shift=1.0)
        chebyshev = forth @ terms @ forth.T
        sizes = np.abs(chebyshev)
        count = np.array([count_terms(sizes.sum(axis=axis), SMALL) for axis in (2, 1)])
        kept = np.arange(NODES) < count[..., None]
        chebyshev *= kept[0, :, :, None] & kept[1, :, None, :]
        scales = np.exp2(cells[:, 1:3].T.astype(np.float64))  # int16 would give float32
        origins = cells[:, 3:].T / scales
        power_a, power_b = scales[..., None] ** np.arange(NODES)  # of two: nothing is rounded
        scale = power_a[:, :, None] * power_b[:, None, :]
        order = np.lexsort(count[::-1])
        rank = np.empty(order.size, dtype=np.int16)
        rank[order] = np.arange(order.size)
        grid = rank[_grid(cells).ravel()]
        origins, count, all_needed = origins[:, order], count[:, order], np.full_like(count, NODES)
        return cls(
            cuts,
            grid,
            Patches(origins, (back @ chebyshev @ back.T * scale)[order], count.tolist()),
            Patches(origins, (terms * scale)[order], all_needed.tolist()),
        )

    def find(self, here: Places) -> NDArray[np.int16]:
        """Return the patches of places."""
        i, j = (SIZE * here.a.real).astype(np.int32), (SIZE * here.b.real).astype(np.int32)
        np.minimum(i, SIZE - 1, out=i)
        np.minimum(j, SIZE - 1, out=j)
        i += here.region * SIZE
        i *= SIZE
        i += j
        return self.grid.take(i)


def _grid(cells: NDArray[np.int16]) -> NDArray[np.int16]:
    """Return the cell at each place of the fine grid, shape (regions, 64, 64)."""
    grid = np.full((REGIONS, SIZE, SIZE), -1, dtype=np.int16)
    for number, (region, level_a, level_b, i, j) in enumerate(cells.tolist()):
        wide, high = SIZE >> level_a, SIZE >> level_b
        grid[region, i * wide : (i + 1) * wide, j * high : (j + 1) * high] = number
    return grid


@cache
def load_table() -> Table:
    """Return the table that came with the package."""
    return Table.of(read(SHIPPED))


@overload
def rebound(psi1: float, chi: float, *, derivatives: Literal[False] = ...) -> float: ...
@overload
def rebound(psi1: Array, chi: Array, *, derivatives: Literal[False] = ...) -> Array: ...
@overload
def rebound(psi1: Real, chi: Real, *, derivatives: Literal[False] = ...) -> Real: ...
@overload
def rebound(
    psi1: Array, chi: Array, *, derivatives: Literal[True]
) -> tuple[Array, Array, Array]: ...
def rebound(psi1: Any, chi: Any, *, derivatives: bool = False) -> object:
    """Return psi2, odd in psi1 to the last bit, |psi2| <= |psi1|.

    Parameters
    ----------
    psi1 : float or array
        Finite.
    chi : float or array of the shape of ``psi1``
        Positive, up to 2.5.
    derivatives : bool
        Whether to return (psi2, d psi2/d psi1, d psi2/d chi); arrays only.
    """
    if isinstance(psi1, float) and not derivatives:
        if type(psi1) is not float or type(chi) is not float:
            psi1, chi = float(psi1), float(chi)  # NumPy's floats are floats, and slow
        return _single()(psi1, chi)
    flat, ratios, shape = psi1.ravel(), chi.ravel(), psi1.shape
    if flat.size < FEW:
        psi2 = np.array(list(map(_single(), flat.tolist(), ratios.tolist())))
    else:
        psi2 = values(load_table(), np.abs(flat), ratios)
        np.negative(psi2, out=psi2, where=flat < 0.0)
    psi2 = psi2.reshape(shape)
    if not derivatives:
        return psi2
    slopes = gradient(load_table(), np.abs(flat), ratios)
    by_psi1, by_chi = (each.reshape(shape) for each in slopes)
    return psi2, by_psi1, by_chi * np.copysign(1.0, psi1)


@cache
def _single() -> Callable[[float, float], float]:
    """Return the function of psi1 and chi that gives psi2 of one impact in plain floats."""
    table = load_table()
    stuck, slip, seam = table.cuts
    cuts = SingleCuts(
        compile_polynomial(stuck),
        (float(slip[0]), compile_polynomial(slip[1:])),
        compile_polynomial(seam),
    )
    grid, patches, last = table.grid.tolist(), table.patches.single, SIZE - 1

    def single(psi1: float, chi: float) -> float:
        speed = abs(psi1)
        full = speed - 4.0 * chi
        here = place(speed, chi, cuts)
        if here is None:
            return full if psi1 >= 0.0 else -full
        region, a, b, measure = here
        i, j = int(a * SIZE), int(b * SIZE)
        i, j = i if i < SIZE else last, j if j < SIZE else last
        patch = grid[(region * SIZE + i) * SIZE + j]
        psi2 = speed * (measure * patches[patch](a, b) - 1.0)
        # no impact gains energy, nor more impulse than full slip gives: not even by an error
        psi2 = psi2 if psi2 > full else full
        psi2 = psi2 if psi2 < speed else speed
        psi2 = psi2 if psi2 >= -speed else -speed
        return psi2 if psi1 >= 0.0 else -psi2

    return single


@np.errstate(under="ignore")  # small numbers may vanish
def values(table: Table, speed: Array, chi: Array) -> Array:
    """Return psi2 for psi1 = speed >= 0 and 0 < chi <= LARGEST_CHI, shape (impacts,)."""
    psi2 = np.empty_like(speed)
    for first in range(0, speed.size, BLOCK):
        part = slice(first, first + BLOCK)
        p, x = speed[part], chi[part]
        psi2[part] = _full_slip(p, x)
        here = places(p, x, table.cuts)
        if here.who.size:
            psi2[part][here.who] = _partial_slip(table, here)
    return psi2


def _full_slip(speed: Array, chi: Array) -> Array:
    """Return psi2 of slip throughout, eq. (45)."""
    psi2 = -4.0 * chi
    psi2 += speed
    return psi2


def _partial_slip(table: Table, here: Places) -> Array:
    """Return psi2 of these places, within the bounds of ``single``."""
    g = table.patches.values(table.find(here), here.a, here.b)
    g *= here.measure
    g -= 1.0
    np.maximum(g, -1.0, out=g)
    np.minimum(g, 1.0, out=g)
    g *= here.speed
    return np.maximum(g, _full_slip(here.speed, here.chi), out=g)


@np.errstate(under="ignore")  # as of ``values``
def gradient(table: Table, speed: Array, chi: Array) -> tuple[Array, Array]:
    """Return (d psi2/d psi1, d psi2/d chi) for psi1 = speed >= 0 and 0 < chi <= LARGEST_CHI.

    By a complex step: the imaginary part of psi2 at psi1 + ih, and at chi + ih, over h. Distances
    from psi1 = 1 and from a cut enter as roots, whose slopes are infinite; there g has no low
    powers, exactly none, so that their products keep their digits.
    """
    count, step = speed.size, 1j * STEP
    p, x = np.concatenate((speed + step, speed)), np.concatenate((chi, chi + step))
    slopes = _full_slip(p, x).imag
    for first in range(0, 2 * count, BLOCK):
        block = slice(first, first + BLOCK)
        here = places(p[block], x[block], table.cuts)
        if here.who.size:
            g = table.exact.values(table.find(here), here.a, here.b)
            slopes[block][here.who] = (here.speed * (here.measure * g - 1.0)).imag
    slopes /= STEP
    return slopes[:count], slopes[count:]
