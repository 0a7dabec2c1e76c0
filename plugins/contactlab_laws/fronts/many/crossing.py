"""Where margins known at the nodes of many panels first fall below zero."""

from __future__ import annotations

import numpy as np

from contactlab.numeric.lobatto import Array, Nodes, dips, rows

#: Stands for "not in this panel" where a panel coordinate in [0, 1] is asked for.
NEVER = 2.0
#: Margins start at zero where a phase begins at an event; less than this is rounding.
ROUNDING = 1e-10
#: A minimum between the points looked at is deeper than this, or without effect.
SHALLOWEST = 1e-8
#: Steps of the Illinois method, after which what is left of a margin is rounding.
NARROWINGS = 7


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
    end = np.where(below.any(axis=0), below.argmax(axis=0), len(fine))
    right = np.append(nodes.fine, NEVER)[end]
    index, column, tau = dips(nodes, margin, fine, -SHALLOWEST)
    earlier = np.flatnonzero(index < end[column])[::-1]  # the first of each column is kept
    end[column[earlier]], right[column[earlier]] = index[earlier], tau[earlier]
    where = np.full(margin.shape[1], NEVER)
    found = np.flatnonzero(right < NEVER)
    if not found.size:
        return where
    end, right = end[found], right[found]
    chosen = margin[:, found]
    left = nodes.fine[end - 1]
    before, after = np.maximum(fine[end - 1, found], 0.0), value(rows(nodes, right), chosen)
    middle, last = left, np.full(found.size, NEVER)
    for _ in range(NARROWINGS):
        middle = left + (right - left) * (before / (before - after))
        now = value(rows(nodes, middle), chosen)
        ahead = now >= 0.0
        # an end that stays twice running loses half its value, so that both ends move in
        less = np.where(ahead == last, 0.5, 1.0)
        left, right = np.where(ahead, middle, left), np.where(ahead, right, middle)
        before, after = np.where(ahead, now, less * before), np.where(ahead, less * after, now)
        last = ahead
    where[found] = middle
    return where
