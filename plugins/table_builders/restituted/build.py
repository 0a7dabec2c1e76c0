"""Building the tables: cells are split along the longest tail until they hold a quantity.

One table is of psi2, the other of the loss in shear over that of slip at psi = 1, the energy
m_t (mu v1/kappa)²/2.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from contactlab import Scene, Simulation, create
from contactlab.numeric.types import Array
from contactlab_laws.tables.file import Stored, write
from contactlab_laws.tables.patches import chebyshev_of_values, nodes
from contactlab_laws.tables.restituted_regions import NODES, REGIONS, border
from contactlab_laws.viscoelastic.batch import extrapolate_steps
from contactlab_laws.viscoelastic.relaxation import number_of

#: Largest error of psi2 between the nodes of a cell, by region; it is looked for where the sum of
#: the last terms along each coordinate is less than ``CLOSE`` times as much.
TOLERANCES = (4e-5, 4e-5, 3e-5, 3e-5, 1.35e-4)
CLOSE = 6.0
#: Largest error of the loss in shear, in its unit.
SHEAR_TOLERANCE = 2e-3
#: Places where the error is measured, as shares of a cell along each coordinate: far from nodes.
BETWEEN = (
    np.array([0.045, 0.31, 0.69, 1.0]),
    np.array([0.0, 0.26, 0.74, 1.0]),
    np.array([0.07, 0.5, 0.93]),
)
#: Places along chi and e at which a cell is held to the border of slip throughout.
ALONG = 33
#: Springs, and steps from an e on, extrapolated from half as many of both: psi2 to 2e-5 up to
#: chi = 3, 1e-5 up to 2. Below chi = 1/2 the least steps suffice.
SPRINGS, STEPS = 100, ((0.0, 600), (0.2, 1000), (0.5, 1600))
#: Springs and steps for the loss in shear, the least e of a course, and what keeps impacts from
#: slip throughout, which has another loss by its own rule.
SHEAR_SPRINGS, LEAST, INSIDE = 100, 0.01, 1.0 - 1e-6

#: Shares of a cell along its three coordinates.
Places = tuple[Array, ...]


class Cell(NamedTuple):
    """A dyadic cell of a region: levels and indices along its three coordinates."""

    region: int
    levels: tuple[int, int, int]
    places: tuple[int, int, int]

    def shares(self, axis: int, inner: Array) -> Array:
        """Return places along a coordinate, as shares of the region, of shares of the cell."""
        return (self.places[axis] + inner) * 0.5 ** self.levels[axis]

    def impacts(self, inner: Places, e: float) -> tuple[Array, Array]:
        """Return psi1 and chi at places of one e, shape (shares of u, shares of chi)."""
        slips, low, high = REGIONS[self.region]
        chi = low + (high - low) * self.shares(1, inner[1])
        u, chi = np.meshgrid(self.shares(0, inner[0]), chi, indexing="ij")
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
    low, psi2 = chi < REGIONS[0].high, np.empty_like(psi1)
    most = max(steps for least, steps in STEPS if e >= least)
    for where, steps in ((low, STEPS[0][1]), (~low, most)):
        if where.any():
            psi2[where] = extrapolate_steps(
                psi1[where], chi[where], number_of(e), springs=SPRINGS, steps=steps
            )
    return psi2


def solve_shear(psi1: Array, chi: Array, e: float) -> Array:
    """Return the loss in shear of impacts of one restitution, shape (impacts,)."""
    laws = Simulation(
        normal=create("normal.viscoelastic", restitution=max(e, LEAST)),
        tangential=create("tangential.springs", springs=SHEAR_SPRINGS, table=False),
        integrator=create("integrator.symplectic", steps=4 * SHEAR_SPRINGS),
    )
    scene = Scene.nondimensional(psi1=psi1 * INSIDE, chi=chi)
    unit = scene.friction_coefficient * scene.normal_speed / scene.pair.stiffness_ratio
    lost = laws.sweep(scene).check().energy.shear_loss
    return np.asarray(lost / (0.5 * scene.pair.tangential_mass * unit**2))


class Quantity(NamedTuple):
    """A tabulated quantity: a function of psi1, chi and e, and its tolerance by region.

    In regions that stick it is over a power of psi1. ``ends`` where psi2 = -e at the border.
    """

    solve: Callable[[Array, Array, float], Array]
    tolerances: tuple[float, ...]
    power: int
    ends: bool


def values_at(quantity: Quantity, cells: list[Cell], inner: Places) -> list[Array]:
    """Return the tabulated quantity of cells at shares of each; one e after another."""
    shape = (*map(len, inner),)
    values, layers = [np.empty(shape) for _ in cells], defaultdict(list)
    for number, cell in enumerate(cells):
        for layer, e in enumerate(cell.shares(2, inner[2]).tolist()):
            layers[e].append((number, layer))
    for e, members in layers.items():
        impacts = np.stack([cells[number].impacts(inner, e) for number, _ in members])
        psi1, chi = impacts.swapaxes(0, 1).reshape(2, -1)
        answers = quantity.solve(psi1, chi, e).reshape(len(members), *shape[:2])
        for (number, layer), (own, _), found in zip(members, impacts, answers, strict=True):
            slips = REGIONS[cells[number].region].slips
            values[number][:, :, layer] = found if slips else found / own**quantity.power
    return values


def terms_of(quantity: Quantity, cells: list[Cell]) -> list[Array]:
    """Return the Chebyshev terms of cells, of ``NODES`` each."""
    forth = [chebyshev_of_values(count) for count in NODES]
    at_nodes = values_at(quantity, cells, (*map(nodes, NODES),))
    return [np.einsum("ai,bj,ck,ijk->abc", *forth, each, optimize=True) for each in at_nodes]


def errors(quantity: Quantity, cells: list[Cell], terms: list[Array]) -> list[float]:
    """Return the largest errors of a quantity between the nodes of cells."""
    basis = [chebvander(2.0 * x - 1.0, n - 1) for x, n in zip(BETWEEN, NODES, strict=True)]
    found = []
    for cell, own, exact in zip(cells, terms, values_at(quantity, cells, BETWEEN), strict=True):
        off = np.abs(np.einsum("ia,jb,kc,abc->ijk", *basis, own, optimize=True) - exact)
        if not REGIONS[cell.region].slips:
            off *= cell.shares(0, BETWEEN[0])[:, None, None]
        found.append(float(off.max()))
    return found


def tails(cell: Cell, terms: Array) -> Array:
    """Return the sums of the last terms along each coordinate, in psi2."""
    size, unit = np.abs(terms), 1.0
    if not REGIONS[cell.region].slips:
        unit = (cell.places[0] + 1) * 0.5 ** cell.levels[0]
    return unit * np.array([size[-1].sum(), size[:, -1].sum(), size[:, :, -1].sum()])


def off_border(cell: Cell, terms: Array) -> float:
    """Return the largest error where slip throughout begins, psi2 = -e; 0 away from there."""
    if not REGIONS[cell.region].slips or cell.places[0] + 1 < 2 ** cell.levels[0]:
        return 0.0
    share = np.linspace(0.0, 1.0, ALONG)
    across = [chebvander(2.0 * share - 1.0, count - 1) for count in NODES[1:]]
    found = np.einsum("jb,kc,abc->jk", *across, terms, optimize=True)
    return float(np.abs(found + cell.shares(2, share)).max())


def holding(quantity: Quantity, cells: list[Cell], terms: list[Array]) -> list[bool]:
    """Return whether cells hold a quantity to its tolerance."""
    aims = [quantity.tolerances[cell.region] for cell in cells]
    holds = [
        bool(
            tails(cell, own).max() <= CLOSE * aim
            and not (quantity.ends and off_border(cell, own) > aim)
        )
        for cell, own, aim in zip(cells, terms, aims, strict=True)
    ]
    near = [k for k, each in enumerate(holds) if each]
    off = errors(quantity, [cells[k] for k in near], [terms[k] for k in near])
    for k, error in zip(near, off, strict=True):
        holds[k] = error <= aims[k]
    return holds


def build(path: Path, quantity: Quantity) -> None:
    """Build the table of a quantity and write it; progress goes to stderr."""
    todo = [Cell(region, (0, 0, 0), (0, 0, 0)) for region in range(len(REGIONS))]
    done: list[tuple[Cell, Array]] = []
    while todo:
        terms = terms_of(quantity, todo)
        cells, todo = todo, []
        for cell, own, holds in zip(cells, terms, holding(quantity, cells, terms), strict=True):
            if holds:
                done.append((cell, own))
            else:
                todo += cell.split(int(tails(cell, own).argmax()))
        print(f"{len(done)} patches, {len(todo)} cells left", file=sys.stderr, flush=True)
    done.sort(key=lambda each: each[0])
    places = [(cell.region, *cell.levels, *cell.places) for cell, _ in done]
    table = np.array([own for _, own in done], dtype=np.float32)
    write(path, Stored.today(cells=np.array(places, dtype=np.int16), terms=table))


PSI2 = Quantity(solve, TOLERANCES, 1, ends=True)
SHEAR = Quantity(solve_shear, (SHEAR_TOLERANCE,) * len(REGIONS), 2, ends=False)
