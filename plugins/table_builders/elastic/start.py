"""The slope of psi2 at psi1 = 1: it is the same on both sides, and easy to find on one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray

from contactlab_laws.tables.elastic import NODES
from contactlab_laws.tables.patches import nodes
from contactlab_laws.tables.regions import CUT_TOP, FIRST_POWER, SLIP_ON, SMALL_NEAR, Cuts
from table_builders.elastic.coordinates import impact
from table_builders.elastic.fit import Cell

Array = NDArray[np.float64]

#: Exact impacts with psi1 from FROM to 1 give the slope at 1 to 1e-9; so near to 1 the cut, which
#: some of them cross, does no harm.
FROM, POINTS = 0.995, 7


def slope(cell: Cell, cuts: Cuts, solve: Callable[[Array, Array], Array]) -> Array:
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
    """Return what g gains with t^5 at psi1 = 1 because chi follows the cut while b is kept.

    Parameters
    ----------
    cell : Cell
    cuts : Cuts
        Polynomials of both cuts in t.
    b, chi, psi2 : array, shape (nodes,)
        At psi1 = 1: coordinate in the cell's region, inertia ratio, exact answer; no units.
    """
    g = (psi2 + 1.0) / (2.0 * chi - 1.0)
    domain = [cell.j * 0.5**cell.level_b, (cell.j + 1) * 0.5**cell.level_b]
    by_b = Chebyshev.fit(b, g, NODES - 1, domain=domain).deriv()(b)
    cut, climb = cuts.slip[0], cuts.slip[FIRST_POWER]
    if cell.region == SLIP_ON:
        return np.asarray(by_b / (2.0 * b * (CUT_TOP - cut)) * climb * (1.0 - b * b))
    return np.asarray(by_b / (cut - 0.5) * climb * b)
