"""Springs whose displacement is a vector of the tangent plane, held as a complex number.

A spring that slips is dragged: the angle phi between it and the displacement falls as
d phi/dL = -sin(phi)/l along the displacement L, so tan(phi/2) falls as exp(-L/l) (theory §14).
Cutting the spring to the length of its limit instead is of first order in the step.
"""

from __future__ import annotations

from typing import Any

import numpy as np

#: Added to lengths that divide, so that none is zero.
TINY = 1e-300


def turned(held: Any, move: Any, least: Any, most: Any) -> tuple[Any, Any]:
    """Return w after a step, and twice the friction work over the stiffness of one spring.

    Parameters
    ----------
    held, move : array, shape (springs, items)
        w before the step, and the displacement in it, complex, in m.
    least, most : array, shape (springs, items)
        Limit before and after, in m.
    """
    # The limit grows evenly from ``least`` to ``most``. A spring sticks until it is at its limit,
    # and is then dragged along the rest of the step at the mean of the limit.
    trial = held + move
    slips = np.abs(trial) > most
    deflection = np.where(np.abs(trial) <= most, trial, 0.0)
    lost = np.zeros(held.shape)
    if not slips.any():
        return deflection, lost.sum(axis=0)
    move = np.broadcast_to(move, held.shape)
    w, d, l0, l1 = held[slips], move[slips], least[slips], most[slips]
    # the share of the step at which abs(w + t d) = l0 + t (l1 - l0)
    growth = l1 - l0
    a = np.abs(d) ** 2 - growth * growth
    half = (w.conj() * d).real - l0 * growth
    c = np.minimum(np.abs(w) ** 2 - l0 * l0, 0.0)
    root = np.sqrt(np.maximum(half * half - a * c, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(half > 0.0, -c / (half + root), (root - half) / a)
    share = np.clip(np.nan_to_num(share, nan=0.0, posinf=0.0, neginf=0.0), 0.0, 1.0)
    first = w + share * d
    limit = l0 + share * growth
    ahead = d / (np.abs(d) + TINY)
    angle = first * ahead.conj()
    angle = angle / (np.abs(angle) + TINY)
    rest = (1.0 - share) * np.abs(d)
    fall = np.exp(-rest / (0.5 * (limit + l1) + TINY))
    aside = angle.imag  # beside a spring that is pushed back 1 + cos is lost in rounding
    half = np.where(
        angle.real < 0.0, aside * aside / np.maximum(1.0 - angle.real, 1.0), 1.0 + angle.real
    )
    turn = half + 1j * (aside * fall)
    turn = turn * turn
    size = np.abs(turn)
    turn = np.where(size > 0.0, turn / (size + TINY), np.where(np.abs(w) > 0.0, -1.0, 1.0))
    standing = np.abs(d) == 0.0  # only the limit shrinks: the spring keeps its direction
    new = l1 * np.where(standing, first / (np.abs(first) + TINY), ahead * turn)
    slip = w + d - new
    lost[slips] = (slip.conj() * (w + new)).real
    deflection[slips] = new
    return deflection, lost.sum(axis=0)
