"""Building the table: cells are split along the coordinate of the longest tail of their series."""

from __future__ import annotations

import sys
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

import numpy as np

from contactlab_laws.tables.file import Stored, write
from contactlab_laws.tables.patches import Array, chebyshev_of_values, nodes
from contactlab_laws.tables.restituted import NODES, REGIONS, border
from contactlab_laws.viscoelastic.batch import extrapolated
from contactlab_laws.viscoelastic.relaxation import number_of

#: Largest sum of the last terms along a coordinate, in psi2, by region.
TOLERANCES = (8e-5, 5e-5, 4e-5, 5e-5, 2e-4)
#: Springs, extrapolated from half as many, with five steps each; fewer suffice below ``DAMPED``,
#: and below chi = 1/2 (theory §15: psi2 to 2e-5 up to chi = 3).
SPRINGS, FEWER, FEWEST = 300, 200, 100
DAMPED = 0.3


class Cell(NamedTuple):
    """A dyadic cell of a region: levels and indices along its three coordinates."""

    region: int
    levels: tuple[int, int, int]
    places: tuple[int, int, int]

    def nodes(self, axis: int) -> Array:
        """Return Chebyshev's nodes along a coordinate, as a share of the region."""
        return (self.places[axis] + nodes(NODES[axis])) * 0.5 ** self.levels[axis]

    def impacts(self, e: float) -> tuple[Array, Array]:
        """Return psi1 and chi at the nodes of one e, shape (8, 6)."""
        slips, low, high = REGIONS[self.region]
        u, chi = np.meshgrid(self.nodes(0), low + (high - low) * self.nodes(1), indexing="ij")
        if slips:
            end = border(chi, e)
            return end - (end - 1.0) * (1.0 - u) ** 2, chi
        return u, chi

    def split(self, axis: int) -> list[Cell]:
        """Return both halves along a coordinate."""
        levels, halves = list(self.levels), []
        levels[axis] += 1
        for side in range(2):
            places = list(self.places)
            places[axis] = 2 * places[axis] + side
            halves.append(Cell(self.region, (*levels,), (*places,)))  # type: ignore[arg-type]
        return halves


def solve(psi1: Array, chi: Array, e: float) -> Array:
    """Return psi2 of impacts of one restitution, shape (impacts,)."""
    low = chi < REGIONS[0].high
    psi2 = np.empty_like(psi1)
    for where, springs in ((low, FEWEST), (~low, FEWER if e < DAMPED else SPRINGS)):
        if where.any():
            psi2[where] = extrapolated(
                psi1[where], chi[where], number_of(e), springs=springs, steps=5 * springs
            )
    return psi2


def terms_of(cells: list[Cell]) -> list[Array]:
    """Return the Chebyshev terms of cells; all nodes of one e are solved together."""
    values = [np.empty(NODES) for _ in cells]
    layers = defaultdict(list)
    for number, cell in enumerate(cells):
        for layer, e in enumerate(cell.nodes(2).tolist()):
            layers[e].append((number, layer))
    for e, members in layers.items():
        impacts = np.stack([cells[number].impacts(e) for number, _ in members])
        psi1, chi = impacts.swapaxes(0, 1).reshape(2, -1)
        psi2 = solve(psi1, chi, e).reshape(len(members), *NODES[:2])
        for (number, layer), (own, _), found in zip(members, impacts, psi2, strict=True):
            slips = REGIONS[cells[number].region].slips
            values[number][:, :, layer] = found if slips else found / own
    forth = [chebyshev_of_values(count) for count in NODES]
    return [np.einsum("ai,bj,ck,ijk->abc", *forth, each, optimize=True) for each in values]


def tails(cell: Cell, terms: Array) -> Array:
    """Return the sums of the last terms along each coordinate, in psi2."""
    size, unit = np.abs(terms), 1.0
    if not REGIONS[cell.region].slips:
        unit = (cell.places[0] + 1) * 0.5 ** cell.levels[0]
    return unit * np.array([size[-1].sum(), size[:, -1].sum(), size[:, :, -1].sum()])


def build(path: Path) -> None:
    """Build the table and write it; progress goes to stderr."""
    todo = [Cell(region, (0, 0, 0), (0, 0, 0)) for region in range(len(REGIONS))]
    done: list[tuple[Cell, Array]] = []
    while todo:
        pairs = list(zip(todo, terms_of(todo), strict=True))
        todo = []
        for cell, terms in pairs:
            tail = tails(cell, terms)
            if tail.max() <= TOLERANCES[cell.region]:
                done.append((cell, terms))
            else:
                todo += cell.split(int(tail.argmax()))
        print(f"{len(done)} patches, {len(todo)} cells left", file=sys.stderr, flush=True)
    done.sort(key=lambda each: each[0])
    cells = [(cell.region, *cell.levels, *cell.places) for cell, _ in done]
    terms = np.array([each for _, each in done], dtype=np.float32)
    write(path, Stored.today(cells=np.array(cells, dtype=np.int16), terms=terms))
