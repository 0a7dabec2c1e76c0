"""The table's patches at many places at once, in NumPy."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from contactlab_laws.tabulated.places import Places, places
from contactlab_laws.tabulated.polynomials import Polynomials, polynomials_of
from contactlab_laws.tabulated.table import DEEPEST, NODES, Table

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

#: Fewer impacts than this are computed from gathered terms, a kilobyte for each, so many at once
#: as fit into the cache; more are sorted by patch, which costs some 3 us a patch.
FEW, GATHERED = 2000, 200
#: Impacts sorted together, and sorted places taken together, which fit into the cache.
BLOCK, STRETCH = 1 << 16, 8192


def rebound(table: Table, speed: Array, chi: Array) -> Array:
    """Return psi2 for psi1 = speed >= 0 and 0 < chi <= LARGEST_CHI, shape (impacts,)."""
    psi2 = np.empty_like(speed)
    for first in range(0, speed.size, BLOCK):
        part = slice(first, first + BLOCK)
        p, x = speed[part], chi[part]
        psi2[part] = _full_slip(p, x)
        here = places(p, x, table.cuts)
        if here.who.size:
            psi2[part][here.who] = _partial_slip(polynomials_of(table), here)
    return psi2


def _full_slip(speed: Array, chi: Array) -> Array:
    """Return psi2 of slip throughout, eq. (45)."""
    psi2 = -4.0 * chi
    psi2 += speed
    return psi2


def _partial_slip(polynomials: Polynomials, here: Places) -> Array:
    """Return psi2 of these places."""
    patch = patches(polynomials.grid, here)
    g = (_sorted if here.who.size >= FEW else _gathered)(polynomials, patch, here)
    g *= here.measure
    g -= 1.0
    # no impact gains energy, nor more impulse than full slip gives: not even by an error
    np.maximum(g, -1.0, out=g)
    np.minimum(g, 1.0, out=g)
    g *= here.speed
    return np.maximum(g, _full_slip(here.speed, here.chi), out=g)


def patches(grid: NDArray[np.int16], here: Places) -> NDArray[np.int16]:
    """Return the patches of places; ``grid`` holds them by region, a and b."""
    size = 1 << DEEPEST
    i, j = (here.a * size).astype(np.int32), (here.b * size).astype(np.int32)
    np.minimum(i, size - 1, out=i)
    np.minimum(j, size - 1, out=j)
    i += here.region * size
    i *= size
    i += j
    return grid.take(i)


def stretches(patch: NDArray[np.int16]) -> Iterator[tuple[int, slice]]:
    """Yield patches and the stretches of a sorted array that belong to them."""
    stop = 0
    for number, count in enumerate(np.bincount(patch).tolist()):
        start, stop = stop, stop + count
        for first in range(start, stop, STRETCH):
            yield number, slice(first, min(first + STRETCH, stop))


def powers(argument: Array, out: Array | None = None) -> Array:
    """Return powers from 0, shape (NODES, places) or that of ``out``, two rows at least."""
    table = np.empty((NODES, argument.size)) if out is None else out
    table[0] = 1.0
    table[1] = argument
    for power in range(2, len(table)):
        np.multiply(table[power - 1], argument, out=table[power])
    return table


def _sorted(polynomials: Polynomials, patch: NDArray[np.int16], here: Places) -> Array:
    """Return g, patch by patch: a product for each, the rest for whole stretches of places."""
    order = np.argsort(patch, kind="stable")
    counts = np.bincount(patch, minlength=len(polynomials.terms))
    stops = counts.cumsum()
    corner_a, corner_b = (np.repeat(corner, counts) for corner in polynomials.corners)
    g = np.empty_like(here.a)
    # room for all stretches: new memory for each would take longer than the rest
    room = np.empty((2, NODES, min(STRETCH, g.size)))
    for first in range(0, g.size, STRETCH):
        stretch = slice(first, first + STRETCH)
        who = order[stretch]
        x, y = here.a[who], here.b[who]
        x -= corner_a[stretch]
        y -= corner_b[stretch]
        found = slice(patch[who[0]], patch[who[-1]] + 1)
        rows, columns = (max(needed[found]) for needed in polynomials.needed)
        y_powers, sums = powers(y, room[0, :columns, : x.size]), room[1, :rows, : x.size]
        start = 0
        for terms, stop in zip(
            polynomials.terms[found, :rows, :columns],
            np.minimum(stops[found] - first, x.size).tolist(),
            strict=True,
        ):
            if stop > start:
                np.matmul(terms, y_powers[:, start:stop], out=sums[:, start:stop])
                start = stop
        g[who] = _horner(sums, x)
    return g


def _gathered(polynomials: Polynomials, patch: NDArray[np.int16], here: Places) -> Array:
    """Return g at places in any order."""
    x, y = here.a - polynomials.corners[0, patch], here.b - polynomials.corners[1, patch]
    y_powers = np.ascontiguousarray(powers(y).T)[..., None]
    rows = np.empty((x.size, NODES, 1))
    for first in range(0, x.size, GATHERED):
        part = slice(first, first + GATHERED)
        terms = polynomials.terms[patch[part]]
        np.matmul(terms, y_powers[part], out=rows[part])
    return _horner(np.ascontiguousarray(rows[..., 0].T), x)


def _horner(terms: Array, argument: Array) -> Array:
    """Return polynomials with ``terms`` of their own, lowest first; ``terms`` are lost."""
    total: Array = terms[-1]
    for term in terms[-2::-1]:
        total *= argument
        total += term
    return total
