"""One patch: g at Chebyshev nodes of a cell, the polynomial nearest to them, and its error."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev

from contactlab.numeric.types import Array
from contactlab_laws.tables.elastic import NODES
from contactlab_laws.tables.patches import chebyshev_of_values, nodes, polynomial
from contactlab_laws.tables.regions import (
    CUT_TOP,
    FIRST_POWER,
    LARGEST_CHI,
    SLIP_BACK,
    SLIP_LONG,
    SLIP_MIDDLE,
    SLIP_ON,
    SMALL_NEAR,
    STUCK_ON,
    Cuts,
    places,
)
from table_builders.elastic.coordinates import impact, measure

#: Nodes along each coordinate: more than the polynomial has terms, so that rounding averages out
#: and what is left out is seen.
FINE = 2 * NODES
#: A polynomial through exact impacts at POINTS psi1 from FROM to 1 gives the slope at 1 to 1e-9. So
#: near to 1 the cut, which some of them cross, does no harm.
FROM, POINTS = 0.995, 7
#: Error of d psi2/d psi1 over that of psi2 that a cell may show: 2e-7 beside ``build.TOLERANCE``. A
#: cell hides a few times more, and ``rebound`` promises 1e-6.
SLOPE_PER_VALUE = 2000.0
#: Error of second derivatives over that of psi2 that a cell may show: 4e-7 beside
#: ``build.TOLERANCE``; ``rebound`` promises 1e-6, farther than AWAY from psi1 = 1, 4 chi - 1 and
#: chi = 1/2, and than BESIDE from the cuts.
BEND_PER_VALUE, AWAY, BESIDE = 6000.0, 0.02, 1e-3
#: Second derivative of the first term left out, T_12, at the ends of [0, 1]; terms less than LEAST
#: are rounding.
BEND, LEAST = 4.0 * 144 * 143 / 3.0, 3e-15
#: Error of chi in coordinates.
ROUNDING = 1e-9
#: Imaginary step for slopes of coordinates.
STEP = 1e-30
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

    def needs(self, cuts: Cuts) -> bool:
        """Return whether chi is not above LARGEST_CHI everywhere: it is least where a and b are."""
        low = np.array([self.i * 0.5**self.level_a]), np.array([self.j * 0.5**self.level_b])
        return bool(impact(self.region, *low, cuts)[1] <= LARGEST_CHI + ROUNDING)

    def nodes(self, cuts: Cuts) -> tuple[Array, Array]:
        """Return (psi1, chi) at the nodes, each of shape (FINE, FINE), a along rows."""
        x = nodes(FINE)
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


def fit(
    cell: Cell, cuts: Cuts, psi1: Array, chi: Array, psi2: Array, slope: Array | None = None
) -> Fit:
    """Return the patch of a cell; its errors are those of psi2/psi1.

    An error is the sum of the last two Chebyshev coefficients, what is left at the nodes where
    powers are missing, or more where derivatives are worse. Near chi = 1/2 rounding spoils g, but
    not what g is needed for: there nodes weigh less.

    Parameters
    ----------
    cell : Cell
    cuts : Cuts
    psi1, chi, psi2 : ndarray, shape (FINE, FINE)
        Exact impacts at the cell's nodes.
    slope : ndarray, shape (FINE,)
        For cells that begin at psi1 = 1: the coefficient of t^5 in g at each node of b, which
        is too small a part of g to be found from the nodes.
    """
    bounce = psi2 / psi1 + 1.0
    scale = measure(cell.region, psi1, chi)
    g = bounce / scale
    kept = _sizes(bounce)[:NODES, :NODES]
    error_a, error_b = kept[-2:].sum(), kept[:, -2:].sum()
    missing_a, missing_b = missing_powers(cell)
    weights_a, weights_b = psi1.mean(axis=1), scale.mean(axis=0)
    if cell.j and cell.region not in (STUCK_ON, SLIP_ON):
        weights_a, weights_b = weights_a * _ends(), weights_b * _ends()
    along_a = _solve(g, missing_a, weights_a, _local(psi1, chi, slope))
    terms = _solve(along_a.T, missing_b, weights_b).T
    misfit_a = (_basis() @ along_a - g) * scale
    misfit_b = _basis() @ (terms @ _basis().T - along_a) * scale
    if missing_a:
        error_a = max(error_a, np.abs(misfit_a).max())
    if missing_b:
        error_b = max(error_b, np.abs(misfit_b).max())
    error_a *= max(1.0, _steepness(cell, psi1, chi) / SLOPE_PER_VALUE)
    bend_a, bend_b = _bends(cell, psi1, chi, cuts)
    error_a = max(error_a, bend_a * _find_tail(misfit_a * psi1) / BEND_PER_VALUE)
    error_b = max(error_b, bend_b * _find_tail((misfit_b * psi1).T) / BEND_PER_VALUE)
    return Fit(np.ascontiguousarray(terms), float(error_a), float(error_b))


def _local(psi1: Array, chi: Array, slope: Array | None) -> Array | None:
    """Return the coefficient of x^5 for that of t^5, of a cell that begins at t = 0."""
    if slope is None:
        return None
    width = _t(psi1[-1], chi[-1]) / nodes(FINE)[-1]
    return np.asarray(slope * width**FIRST_POWER)


def _t(psi1: Array, chi: Array) -> Array:
    """Return t, the fifth root of the distance from psi1 = 1 over that from chi = 1/2."""
    return np.asarray(np.abs((psi1 - 1.0) / (2.0 * chi - 1.0)) ** 0.2)


@cache
def _basis() -> Array:
    """Return the powers of the nodes, shape (FINE, NODES)."""
    return np.asarray(nodes(FINE)[:, None] ** np.arange(NODES))


def _solve(
    values: Array, missing: tuple[int, ...], weights: Array, first: Array | None = None
) -> Array:
    """Return terms by powers along the first axis; ``first`` are those of FIRST_POWER."""
    terms = np.zeros((NODES, values.shape[1]))
    weight = weights[:, None]
    if first is not None:
        terms[FIRST_POWER] = first
        missing = (*missing, FIRST_POWER)
    powers = [power for power in range(NODES) if power not in missing]
    left = values - _basis() @ terms
    terms[powers] = np.linalg.lstsq(weight * _basis()[:, powers], weight * left, rcond=None)[0]
    return terms


@cache
def _ends() -> Array:
    """Return weights of the nodes, which grow towards the ends of a cell."""
    x = nodes(FINE)
    return 0.25 / (x * (1.0 - x))


def _sizes(values: Array) -> Array:
    """Return the sizes of the Chebyshev coefficients of values at the nodes."""
    matrix = chebyshev_of_values(FINE)
    return np.abs(matrix @ values @ matrix.T)


def _find_tail(misfit: Array) -> float:
    """Return the largest term left out along the first axis, 0 if it is rounding."""
    largest = float(_sizes(misfit)[NODES:].max())
    return largest if largest > LEAST else 0.0


def _bends(cell: Cell, psi1: Array, chi: Array, cuts: Cuts) -> tuple[float, float]:
    """Return the second derivative by psi1 or chi of the first term left out, along a and b."""
    p, x = psi1.ravel(), chi.ravel()
    far = np.minimum(np.abs(p - 1.0), np.abs(p - 4.0 * x + 1.0)) > AWAY
    far &= (np.abs(x - 0.5) > AWAY) & (x <= LARGEST_CHI)
    slopes = np.zeros((2, 2, p.size))
    for k, step in enumerate(((1j * STEP, 0j), (0j, 1j * STEP))):
        moved: list[Any] = [p + step[0], x + step[1]]  # complex, as of ``elastic.gradient``
        here = places(moved[0], moved[1], cuts)
        slopes[0, k, here.who], slopes[1, k, here.who] = here.a.imag / STEP, here.b.imag / STEP
    if cell.region in (STUCK_ON, SLIP_ON):  # chi less that of the cut is b over 2 d b/d chi
        b = (cell.j + nodes(FINE)) * 0.5**cell.level_b
        far &= np.tile(b, FINE) > 2.0 * BESIDE * slopes[1, 1]
    if not far.any():
        return 0.0, 0.0
    steepest = (slopes**2).max(axis=1)[:, far].max(axis=1)
    bend_a, bend_b = BEND * steepest * 4.0 ** np.array((cell.level_a, cell.level_b))
    return float(bend_a), float(bend_b)


def _steepness(cell: Cell, psi1: Array, chi: Array) -> float:
    """Return the error of d psi2/d psi1 for each error of g, SLOPE/(5 t^4 width).

    d psi2/d psi1 is g_t/(5 t^4), by the t^5 in which g is smooth beside psi1 = 1.
    """
    if begins_at_one(cell) or cell.region not in (SMALL_NEAR, SLIP_BACK, SLIP_ON, SLIP_LONG):
        return 0.0
    t, x = _t(psi1, chi), nodes(FINE)
    width = (t[-1] - t[0]) / (x[-1] - x[0])
    return float((SLOPE / (5.0 * (t[0] - x[0] * width) ** 4 * width)).max())


def slope_at_one(cell: Cell, cuts: Cuts, solve: Callable[[Array, Array], Array]) -> Array:
    """Return the coefficient of t^5 in g at psi1 = 1, shape (FINE,) over the nodes of b.

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
    b = (cell.j + nodes(FINE)) * 0.5**cell.level_b
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
    cut, climb = cuts.slip[0], polynomial(cuts.slip[1:], np.array(-SLIP_MIDDLE))
    if cell.region == SLIP_ON:
        return np.asarray(by_b / (2.0 * b * (CUT_TOP - cut)) * climb * (1.0 - b * b))
    return np.asarray(by_b / (cut - 0.5) * climb * b)
