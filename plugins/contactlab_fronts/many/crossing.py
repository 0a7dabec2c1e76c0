"""Where margins known at the nodes of many panels first fall below zero."""

from __future__ import annotations

import numpy as np

from contactlab.collocation import Array, Nodes, rows

#: Stands for "not in this panel" where a panel coordinate in [0, 1] is asked for.
NEVER = 2.0
#: Margins start at zero where a phase begins at an event; less than this is rounding.
ROUNDING = 1e-10
#: Steps of the Illinois method; they narrow a crossing to 1e-9 of the panel.
NARROWINGS = 10


def value(weights: Array, values: Array) -> Array:
    """Return (impacts,) numbers from ``rows`` of shape (impacts, nodes) and values at nodes."""
    return np.asarray(np.einsum("ji,ij->j", weights, values))


def first_crossing(nodes: Nodes, margin: Array) -> Array:
    """Return where each margin, shape (nodes, impacts), first falls below zero, or ``NEVER``.

    Before the first inner node a crossing counts only if the margin is negative at that node:
    a margin that starts at zero may dip there by the error of its polynomial.
    """
    fine = nodes.to_fine.T @ margin
    below = fine < -ROUNDING
    below[0] = False
    below[: nodes.second] &= margin[1] < 0.0
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
        now = value(rows(nodes, middle), chosen)
        ahead = now >= 0.0
        # the end that stays loses half its value, so that both ends move in
        left, right = np.where(ahead, middle, left), np.where(ahead, right, middle)
        before, after = np.where(ahead, now, 0.5 * before), np.where(ahead, 0.5 * after, now)
    where[found] = middle
    return where
