"""The table's patches at many places at once, in NumPy."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from contactlab_tabulated.coordinates import SLIP_LATE, SMALL_FAR, SMALL_NEAR, Places, places
from contactlab_tabulated.table import DEEPEST, NODES, Table

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

#: Fewer impacts than this are computed from gathered terms, a kilobyte for each; more are
#: sorted by patch, which costs some 2 us a patch.
FEW = 1500
#: Impacts sorted together, and sorted places taken together, which fit into the cache.
BLOCK, STRETCH = 1 << 17, 4096
#: Regions where psi2 may come as near to that of full slip as rounding; there it is bounded.
NEAR_FULL = (SMALL_NEAR, SMALL_FAR, SLIP_LATE)


def rebound(table: Table, speed: Array, chi: Array) -> Array:
    """Return psi2 for psi1 = speed >= 0 and 0 < chi <= LARGEST_CHI, shape (impacts,)."""
    psi2 = speed - 4.0 * chi  # slips throughout, eq. (45)
    for first in range(0, speed.size, BLOCK):
        part = slice(first, first + BLOCK)
        here = places(speed[part], chi[part], table.cuts)
        if here.who.size:
            _fill(table, here, psi2[part])
    return psi2


def _fill(table: Table, here: Places, psi2: Array) -> None:
    """Write psi2 of these places."""
    parts = here.parts()
    patch = patches(table, here, parts)
    g = (_sorted if here.who.size >= FEW else _gathered)(table, patch, here)
    g *= here.measure
    g -= 1.0
    # no impact gains energy, nor more impulse than full slip gives: not even by an error
    np.maximum(g, -1.0, out=g)
    np.minimum(g, 1.0, out=g)
    g *= here.speed
    for region, part in parts:
        if region in NEAR_FULL:
            np.maximum(g[part], psi2[here.who[part]], out=g[part])
    psi2[here.who] = g


def patches(table: Table, here: Places, parts: list[tuple[int, slice]]) -> NDArray[np.int16]:
    """Return the patches of places; ``parts`` are those of the regions."""
    size = 1 << DEEPEST
    i, j = (here.a * size).astype(np.int32), (here.b * size).astype(np.int32)
    np.minimum(i, size - 1, out=i)
    np.minimum(j, size - 1, out=j)
    i *= size
    i += j
    for region, part in parts:
        i[part] += region * size * size
    return table.grid.ravel().take(i)


def stretches(patch: NDArray[np.int16]) -> Iterator[tuple[int, slice]]:
    """Yield patches and the stretches of a sorted array that belong to them."""
    stop = 0
    for number, count in enumerate(np.bincount(patch).tolist()):
        start, stop = stop, stop + count
        for first in range(start, stop, STRETCH):
            yield number, slice(first, min(first + STRETCH, stop))


def powers(argument: Array, out: Array | None = None) -> Array:
    """Return powers from 0 to NODES - 1, shape (NODES, places)."""
    table = np.empty((NODES, argument.size)) if out is None else out
    table[0] = 1.0
    table[1] = argument
    for power in range(2, NODES):
        np.multiply(table[power - 1], argument, out=table[power])
    return table


def _sorted(table: Table, patch: NDArray[np.int16], here: Places) -> Array:
    """Return g, patch by patch: a product for each, the rest for whole stretches of places."""
    order = np.argsort(patch, kind="stable")
    patch = patch[order]
    stops = np.cumsum(np.bincount(patch, minlength=len(table.cells)))
    (wide, high), (left, low) = table.scales, table.corners
    g = np.empty_like(here.a)
    # room for all stretches: new memory for each would take longer than the rest
    room = np.empty((2, NODES, min(STRETCH, g.size)))
    for first in range(0, g.size, STRETCH):
        who, of = order[first : first + STRETCH], patch[first : first + STRETCH]
        x, y = here.a[who], here.b[who]
        x *= wide[of]
        x -= left[of]
        y *= high[of]
        y -= low[of]
        y_powers, rows = room[..., : x.size]
        powers(y, y_powers)
        start = 0
        ends = np.minimum(stops[of[0] : of[-1] + 1] - first, x.size)
        for number, stop in enumerate(ends.tolist(), of[0]):
            if stop > start:
                part = slice(start, stop)
                np.matmul(table.terms[number], y_powers[:, part], out=rows[:, part])
                start = stop
        total = rows[-1]
        for row in rows[-2::-1]:
            total *= x
            total += row
        g[who] = total
    return g


def _gathered(table: Table, patch: NDArray[np.int16], here: Places) -> Array:
    """Return g at places in any order."""
    x = here.a * table.scales[0][patch] - table.corners[0][patch]
    y = here.b * table.scales[1][patch] - table.corners[1][patch]
    x_powers = np.ascontiguousarray(powers(x).T)
    rows = np.matmul(x_powers[:, None, :], table.terms[patch])[:, 0]
    return np.asarray(np.einsum("nk,kn->n", rows, powers(y)))
