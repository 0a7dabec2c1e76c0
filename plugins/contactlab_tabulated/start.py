"""The slope of psi2 at psi1 = 1: it is the same on both sides, and easy to find on one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray

from contactlab_tabulated.coordinates import SMALL_NEAR, Cuts, impact
from contactlab_tabulated.fit import Cell, chebyshev_nodes

Array = NDArray[np.float64]

#: Exact impacts with psi1 from FROM to 1 give the slope at 1 to some 1e-11.
FROM, POINTS = 0.9, 9


def slope(cell: Cell, cuts: Cuts, solve: Callable[[Array, Array], Array]) -> Array:
    """Return the coefficient of t^5 in g at psi1 = 1, shape (NODES,) over the nodes of b.

    With g = g0 + g5 t^5, d psi2/d psi1 = -1 + epsilon g0 + g5 there, with -g5 for chi < 1/2,
    where psi2 = 1 - 4 chi and its slope is 1.

    Parameters
    ----------
    cell : Cell
        One that begins at psi1 = 1.
    cuts : Cuts
    solve : callable
        Exact psi2 of (psi1, chi).
    """
    b = (cell.j + chebyshev_nodes()) * 0.5**cell.level_b
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
    return np.asarray(np.array(slopes) - psi2[-1])
