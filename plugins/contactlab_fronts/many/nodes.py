"""Lobatto nodes on [0, 1], and what is read off a polynomial known there, for many impacts.

Values have shape (nodes, impacts): a row is contiguous over the impacts.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Stands for "not in this panel" where a panel coordinate in [0, 1] is asked for.
NEVER = 2.0
#: Margins start at zero where a phase begins at an event; less than this is rounding.
ROUNDING = 1e-10
LOOK_EACH = 2  # points at which a margin is looked at, for each node
NARROWINGS = 4  # steps of the Illinois method; they narrow a crossing to 1e-9 of the panel


class Nodes(NamedTuple):
    """Everything that depends on the number of nodes only."""

    points: Array  # (n,), 0 and 1 included
    integral: Array  # (n, n): integral @ f = integral of f from 0 to each point
    tail: Array  # (2, n): tail @ f = the two highest Legendre coefficients
    powers: Array  # (n, n): coefficients of powers of 2 tau - 1, lowest first
    weights: Array  # (n,), barycentric
    fine: Array  # (m,): where margins are looked at
    to_fine: Array  # (m, n)


@lru_cache(maxsize=8)
def lobatto(count: int) -> Nodes:
    """Return Gauss-Lobatto-Legendre nodes on [0, 1] and their matrices."""
    top = np.zeros(count)
    top[-1] = 1.0
    inner = np.sort(legendre.legroots(legendre.legder(top)).real)
    z = np.concatenate(([-1.0], inner, [1.0]))
    to_coefficients = np.linalg.inv(legendre.legvander(z, count - 1))
    primitive = np.stack([legendre.legint(row, lbnd=-1.0) for row in np.eye(count)], axis=1)
    integral = 0.5 * legendre.legvander(z, count) @ primitive @ to_coefficients
    integral[0] = 0.0
    weights = 1.0 / np.prod(2.0 * (z[:, None] - z) + np.eye(count), axis=1)
    fine = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, LOOK_EACH * count + 1))
    return Nodes(
        0.5 + 0.5 * z,
        np.ascontiguousarray(integral),
        np.ascontiguousarray(to_coefficients[-2:]),
        np.linalg.inv(np.vander(z, count, increasing=True)),
        weights / np.abs(weights).max(),
        fine,
        np.ascontiguousarray(legendre.legvander(2.0 * fine - 1.0, count - 1) @ to_coefficients),
    )


def basis(nodes: Nodes, tau: Array) -> Array:
    """Return the (nodes, impacts) weights that take values at the nodes to ``tau`` (impacts,)."""
    gap = tau - nodes.points[:, None]
    gap += 1e-290  # a point on a node picks that node; any other gap is unchanged
    np.divide(nodes.weights[:, None], gap, out=gap)
    gap /= gap.sum(axis=0)
    return gap


def value(weights: Array, values: Array) -> Array:
    """Return the polynomials with ``values`` at the nodes where ``weights`` were made for."""
    return np.asarray(np.einsum("ij,ij->j", weights, values))


def first_crossing(nodes: Nodes, margin: Array) -> Array:
    """Return where each margin first falls below zero, or ``NEVER``.

    Before the first inner node a crossing counts only if the margin is negative at that node:
    a margin that starts at zero may dip there by the error of its polynomial.
    """
    fine = nodes.to_fine @ margin
    below = fine < -ROUNDING
    below[0] = False
    below[nodes.fine < nodes.points[1]] &= margin[1] < 0.0
    where = np.full(margin.shape[1], NEVER)
    found = np.flatnonzero(below.any(axis=0))
    if not found.size:
        return where
    index = below[:, found].argmax(axis=0)
    left, right = nodes.fine[index - 1], nodes.fine[index]
    before = np.maximum(fine[index - 1, found], 0.0)
    after = fine[index, found]
    chosen = margin[:, found]
    middle = left
    for _ in range(NARROWINGS):
        middle = left + (right - left) * (before / (before - after))
        now = value(basis(nodes, middle), chosen)
        ahead = now >= 0.0
        # the end that stays loses half its value, so that both ends move in
        left, right = np.where(ahead, middle, left), np.where(ahead, right, middle)
        before, after = np.where(ahead, now, 0.5 * before), np.where(ahead, 0.5 * after, now)
    where[found] = middle
    return where
