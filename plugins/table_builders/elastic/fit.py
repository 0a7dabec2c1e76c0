"""One patch: g at Chebyshev nodes of a cell, the polynomial through them, and its error."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev

from contactlab.numeric.types import Array
from contactlab_laws.tables.elastic import NODES
from contactlab_laws.tables.patches import chebyshev_of_values, nodes
from contactlab_laws.tables.regions import (
    CUT_END,
    CUT_TOP,
    FIRST_POWER,
    SLIP_BACK,
    SLIP_LONG,
    SLIP_ON,
    SMALL_NEAR,
    STUCK_ON,
    Cuts,
)
from table_builders.elastic.coordinates import impact, measure

#: A polynomial through exact impacts at POINTS psi1 from FROM to 1 gives the slope at 1 to 1e-9. So
#: near to 1 the cut, which some of them cross, does no harm.
FROM, POINTS = 0.995, 7
#: Error of d psi2/d psi1 over that of psi2 that a cell may show: 2e-7 beside ``build.TOLERANCE``. A
#: cell hides a few times more, and ``rebound`` promises 1e-6.
SLOPE_PER_VALUE = 2000.0
#: Slope of the last terms over their size, in a cell of width 1: T_11 of [0, 1] has 33 in root mean
#: square, 242 at its ends.
SLOPE = 40.0


class Cell(NamedTuple):
    """A dyadic cell of a region: a in [i, i + 1]/2^level_a, b likewise."""

    region: int
    level_a: int
    level_b: int
    i: int
    j: int

    @property
    def area(self) -> float:
        """The part of the unit square that the cell covers."""
        return 2.0 ** -(self.level_a + self.level_b)

    def split(self, along_a: bool, along_b: bool) -> list[Cell]:
        """Return the two or four parts."""
        return [
            Cell(
                self.region,
                self.level_a + along_a,
                self.level_b + along_b,
                self.i * (1 + along_a) + i,
                self.j * (1 + along_b) + j,
            )
            for i in range(1 + along_a)
            for j in range(1 + along_b)
        ]

    def nodes(self, cuts: Cuts) -> tuple[Array, Array]:
        """Return (psi1, chi) at the nodes, each of shape (NODES, NODES), a along rows."""
        x = nodes(NODES)
        a = (self.i + x) * 0.5**self.level_a
        b = (self.j + x) * 0.5**self.level_b
        return impact(self.region, *np.meshgrid(a, b, indexing="ij"), cuts)


class Fit(NamedTuple):
    """Terms of g by powers of both local coordinates in [0, 1], and errors along each."""

    terms: Array
    error_a: float
    error_b: float


def missing_powers(cell: Cell) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the powers of a and of b that g lacks; only cells at a = 0 or b = 0 can tell."""
    root_cells = cell.region in (STUCK_ON, SLIP_ON)
    of_a = tuple(range(1, FIRST_POWER)) if begins_at_one(cell) else ()
    return of_a, (1,) if root_cells and cell.j == 0 else ()


def begins_at_one(cell: Cell) -> bool:
    """Return whether the cell begins at psi1 = 1, so that its first coordinate is t from 0."""
    return cell.region in (SMALL_NEAR, SLIP_BACK, SLIP_ON) and cell.i == 0


def fit(cell: Cell, psi1: Array, chi: Array, psi2: Array, slope: Array | None = None) -> Fit:
    """Return the patch of a cell; its errors are those of psi2/psi1.

    An error is the sum of the last two Chebyshev coefficients, or what is left at the nodes
    where powers are missing. Near chi = 1/2 rounding spoils g, but not what g is needed for.

    Parameters
    ----------
    cell : Cell
    psi1, chi, psi2 : ndarray, shape (NODES, NODES)
        Exact impacts at the cell's nodes.
    slope : ndarray, shape (NODES,)
        For cells that begin at psi1 = 1: the coefficient of t^5 in g at each node of b, which
        is too small a part of g to be found from the nodes.
    """
    bounce = psi2 / psi1 + 1.0
    scale = measure(cell.region, psi1, chi)
    g = bounce / scale
    coefficients = chebyshev_of_values(NODES) @ bounce @ chebyshev_of_values(NODES).T
    error_a = np.abs(coefficients[-2:]).sum()
    error_b = np.abs(coefficients[:, -2:]).sum()
    missing_a, missing_b = missing_powers(cell)
    along_a = _solve(g, missing_a, _local(cell, slope))
    if missing_a:
        error_a = max(error_a, (np.abs(_basis() @ along_a - g) * scale).max())
    if missing_b:
        misfit = _basis() @ _solve(g.T, missing_b) - g.T
        error_b = max(error_b, (np.abs(misfit.T) * scale).max())
    terms = _solve(along_a.T, missing_b).T
    error_a *= max(1.0, _steepness(cell) / SLOPE_PER_VALUE)
    return Fit(np.ascontiguousarray(terms), float(error_a), float(error_b))


def _local(cell: Cell, slope: Array | None) -> Array | None:
    """Return the coefficient of x^5 for that of t^5."""
    if slope is None:
        return None
    width = (1.0 if cell.region == SMALL_NEAR else CUT_END) * 0.5**cell.level_a
    return np.asarray(slope * width**FIRST_POWER)


@cache
def _basis() -> Array:
    return np.asarray(nodes(NODES)[:, None] ** np.arange(NODES))


def _solve(values: Array, missing: tuple[int, ...], first: Array | None = None) -> Array:
    """Return terms by powers along the first axis; ``first`` are those of FIRST_POWER."""
    terms = np.zeros_like(values)
    if first is not None:
        terms[FIRST_POWER] = first
        missing = (*missing, FIRST_POWER)
    powers = [power for power in range(NODES) if power not in missing]
    left = values - _basis() @ terms
    terms[powers] = np.linalg.lstsq(_basis()[:, powers], left, rcond=None)[0]
    return terms


def _steepness(cell: Cell) -> float:
    """Return the error of d psi2/d psi1 for each error of g, SLOPE/(5 t^4 width).

    d psi2/d psi1 is g_t/(5 t^4), by the t^5 in which g is smooth beside psi1 = 1.
    """
    if cell.region == SMALL_NEAR:
        start, scale = 0.0, 1.0
    elif cell.region in (SLIP_BACK, SLIP_ON):
        start, scale = 0.0, CUT_END
    elif cell.region == SLIP_LONG:
        start, scale = CUT_END, 1.0 - CUT_END
    else:
        return 0.0
    width = scale * 0.5**cell.level_a
    t = start + cell.i * width
    return SLOPE / (5.0 * t**4 * width) if t > 0.0 else 0.0


def slope_at_one(cell: Cell, cuts: Cuts, solve: Callable[[Array, Array], Array]) -> Array:
    """Return the coefficient of t^5 in g at psi1 = 1, shape (NODES,) over the nodes of b.

    With g = g0 + g5 t^5 at constant chi, d psi2/d psi1 = -1 + epsilon g0 + g5 there, with -g5
    for chi < 1/2, where psi2 = 1 - 4 chi and its slope is 1.

    Parameters
    ----------
    cell : Cell
        A cell of the table that begins at psi1 = 1.
    cuts : Cuts
    solve : callable
        Exact psi2 of (psi1, chi).
    """
    b = (cell.j + nodes(NODES)) * 0.5**cell.level_b
    _, chi = impact(cell.region, np.zeros_like(b), b, cuts)
    if cell.region == SMALL_NEAR:
        return np.asarray(-4.0 * chi)
    z = np.cos(np.linspace(np.pi, 0.0, POINTS))
    psi1 = FROM + (1.0 - FROM) * 0.5 * (1.0 + z)
    grid = np.meshgrid(psi1, chi, indexing="ij")
    psi2 = solve(grid[0].ravel(), grid[1].ravel()).reshape(grid[0].shape)
    slopes = [
        Chebyshev.fit(psi1, column, POINTS - 1, domain=[FROM, 1.0]).deriv()(1.0)
        for column in psi2.T
    ]
    return np.asarray(np.array(slopes) - psi2[-1] + _along_cut(cell, cuts, b, chi, psi2[-1]))


def _along_cut(cell: Cell, cuts: Cuts, b: Array, chi: Array, psi2: Array) -> Array:
    """Return what g gains with t^5 at psi1 = 1 because chi follows the cut while b is kept."""
    g = (psi2 + 1.0) / (2.0 * chi - 1.0)
    domain = [cell.j * 0.5**cell.level_b, (cell.j + 1) * 0.5**cell.level_b]
    by_b = Chebyshev.fit(b, g, NODES - 1, domain=domain).deriv()(b)
    cut, climb = cuts.slip[0], cuts.slip[FIRST_POWER]
    if cell.region == SLIP_ON:
        return np.asarray(by_b / (2.0 * b * (CUT_TOP - cut)) * climb * (1.0 - b * b))
    return np.asarray(by_b / (cut - 0.5) * climb * b)
