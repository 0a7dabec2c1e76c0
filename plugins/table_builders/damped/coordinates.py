"""Impacts of the places in the table of Tsuji's law, for its builder."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from contactlab_laws.tables.damped import SLIPS, STICKS, Array

#: Nodes in psi1, chi and t.
NODES = (16, 8, 8)


def restitution(depth: Any) -> Any:
    """Return e = 1 - t³."""
    return 1.0 - depth**3


def nodes(count: int, low: float, high: float) -> Array:
    """Return Chebyshev's nodes between ``low`` and ``high``, ends excluded."""
    return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * chebyshev.chebpts1(count))


def coefficients(values: Array) -> Array:
    """Return Chebyshev coefficients of values at the nodes along every axis."""
    for axis, count in enumerate(values.shape):
        inverse = np.linalg.inv(chebyshev.chebvander(chebyshev.chebpts1(count), count - 1))
        values = np.moveaxis(np.tensordot(inverse, values, (1, axis)), 0, axis)
    return values


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
