"""Coordinates in which psi2(psi1, chi, e) under Tsuji's law is smooth: theory §11, "As a table"."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: The range of the table: chi from solid spheres to shells, and e.
CHI = (0.8, 1.8)
RESTITUTION = (0.5, 1.0)
#: Pieces of t = (1 - e)^(1/3), in which psi2 is smooth down to e = 1; the border is e = 0.9.
BORDERS = (0.0, 0.1 ** (1.0 / 3.0), 0.5 ** (1.0 / 3.0))
#: Pieces in psi1: the centre sticks until the end; it slips while a ring around it sticks; all of
#: the contact slips and sticks again; the centre slips for good.
STICKS, RINGS, TURNS, SLIPS = range(4)
#: Nodes in psi1, chi and t.
NODES = (16, 8, 8)


def depth(restitution: Any) -> Any:
    """Return t = (1 - e)^(1/3)."""
    return np.cbrt(1.0 - restitution)


def restitution(depth: Any) -> Any:
    """Return e = 1 - t³."""
    return 1.0 - depth**3


def inner(value: Any, low: float, high: float) -> Any:
    """Return ``value`` between ``low`` and ``high`` as a number in [-1, 1]."""
    return (2.0 * value - (low + high)) / (high - low)


def nodes(count: int, low: float, high: float) -> Array:
    """Return Chebyshev's nodes between ``low`` and ``high``, ends excluded."""
    return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * chebyshev.chebpts1(count))


def coefficients(values: Array) -> Array:
    """Return Chebyshev coefficients of values at the nodes along every axis."""
    for axis, count in enumerate(values.shape):
        inverse = np.linalg.inv(chebyshev.chebvander(chebyshev.chebpts1(count), count - 1))
        values = np.moveaxis(np.tensordot(inverse, values, (1, axis)), 0, axis)
    return values


def place(piece: int, psi1: Any, cuts: Any) -> Any:
    """Return the coordinate of ``psi1`` in a piece, in [-1, 1]."""
    if piece == STICKS:
        return 2.0 * psi1 / cuts[0] - 1.0
    if piece == SLIPS:
        return 2.0 * (cuts[-1] - 1.0) / (psi1 - 1.0) - 1.0
    low, high = cuts[piece - 1], cuts[piece]  # psi2 is smooth in the root of psi1 - low
    return 2.0 * np.sqrt((psi1 - low) / (high - low)) - 1.0


def incidence(piece: int, at: Any, cuts: Any) -> Any:
    """Return psi1 at a coordinate in [-1, 1] of a piece: the inverse of ``place``."""
    share = 0.5 * (at + 1.0)
    if piece == STICKS:
        return cuts[0] * share
    if piece == SLIPS:
        return 1.0 + (cuts[-1] - 1.0) / share
    low, high = cuts[piece - 1], cuts[piece]
    return low + (high - low) * share**2


def smooth(piece: int, psi1: Any, psi2: Any, chi: Any, e: Any) -> Any:
    """Return the tabulated quantity: psi2/psi1, psi2, or psi2 less that of gross slip."""
    if piece == STICKS:
        return psi2 / psi1
    return psi2 if piece != SLIPS else psi2 - (psi1 - 2.0 * chi * (1.0 + e))


def rough(piece: int, psi1: Any, value: Any, chi: Any, e: Any) -> Any:
    """Return psi2 from the tabulated ``value``: the inverse of ``smooth``."""
    if piece == STICKS:
        return value * psi1
    return value if piece != SLIPS else value + (psi1 - 2.0 * chi * (1.0 + e))
