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
    share = _sticking(w, d, l0, l1)
    first = w + share * d
    limit = l0 + share * (l1 - l0)
    rest = (1.0 - share) * np.abs(d)
    standing = np.abs(d) == 0.0  # only the limit shrinks: the spring keeps its direction
    turn = _turned(_direction(first, d), np.exp(-rest / (0.5 * (limit + l1) + TINY)))
    turn = np.where(np.abs(w) > 0.0, turn, 1.0)
    ahead = d / (np.abs(d) + TINY)
    new = l1 * np.where(standing, first / (np.abs(first) + TINY), ahead * turn)
    slip = w + d - new
    lost[slips] = (slip.conj() * (w + new)).real
    deflection[slips] = new
    return deflection, lost.sum(axis=0)


def dragged(held: Any, move: Any, pull: Any, first: Any, most: Any, decay: Any) -> Any:
    """Return w of viscous springs after a step (theory §15): the force is along w + A v.

    Parameters
    ----------
    held, move : array, shape (springs, items)
        w before the step, and the displacement in it, complex.
    pull : array, shape (items,)
        A v, complex.
    first, most : array, shape (springs, items) or (springs, 1)
        Limit before and after.
    decay : array, shape (springs, items) or (springs, 1)
        Time of the step over A.
    """
    # r, the length of w + A v, tends to l + A abs(v) cos(phi), and tan(phi/2) falls as exp(-L/r).
    trial = held + move
    deflection = np.array(trial)
    every = np.broadcast_arrays(held, move, pull, first, most, decay)
    apart = (every[3] <= 0.0) & (every[4] <= 0.0)
    deflection[apart] = held[apart] * np.exp(-every[5][apart])
    slips = (np.abs(trial + pull) > most) & ~apart
    if not slips.any():
        return deflection
    w, d, along, l0, l1, time = (each[slips] for each in every)
    share = _sticking(w + along, d, l0, l1)
    rest, time = (1.0 - share) * np.abs(d), (1.0 - share) * time
    limit = l0 + share * (l1 - l0)
    traction = w + share * d + along
    angle, size, ahead = _direction(traction, d), np.abs(traction), d / (np.abs(d) + TINY)
    turned = _turned(angle, np.exp(-0.5 * rest / (size + TINY)))
    drag = np.abs(along) * turned.real
    gone = -np.expm1(-time)
    pulled = (limit + drag) * gone + (l1 - limit) * (1.0 - gone / np.maximum(time, TINY))
    size = np.maximum(size * (1.0 - gone) + pulled, 0.0)
    turned = _turned(turned, np.exp(-0.5 * rest / (size + TINY)))
    standing = np.abs(d) == 0.0
    turned = np.where(standing, traction / (np.abs(traction) + TINY), ahead * turned)
    deflection[slips] = size * turned - along
    return deflection


def _sticking(w: Any, d: Any, l0: Any, l1: Any) -> Any:
    """Return the share of the step at which abs(w + t d) = l0 + t (l1 - l0); 0 if it is beyond."""
    growth = l1 - l0
    a = np.abs(d) ** 2 - growth * growth
    half = (w.conj() * d).real - l0 * growth
    c = np.minimum(np.abs(w) ** 2 - l0 * l0, 0.0)
    root = np.sqrt(np.maximum(half * half - a * c, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(half > 0.0, -c / (half + root), (root - half) / a)
    return np.clip(np.nan_to_num(share, nan=0.0, posinf=0.0, neginf=0.0), 0.0, 1.0)


def _direction(w: Any, d: Any) -> Any:
    """Return the unit vectors of w from the direction of d."""
    angle = w * (d / (np.abs(d) + TINY)).conj()
    return angle / (np.abs(angle) + TINY)


def _turned(angle: Any, fall: Any) -> Any:
    """Return unit vectors whose tan(phi/2) is ``fall`` times that of ``angle``."""
    aside = angle.imag  # beside a spring that is pushed back 1 + cos is lost in rounding
    half = np.where(
        angle.real < 0.0, aside * aside / np.maximum(1.0 - angle.real, 1.0), 1.0 + angle.real
    )
    turn = half + 1j * (aside * fall)
    turn = turn * turn
    size = np.abs(turn)
    return np.where(size > 0.0, turn / (size + TINY), -1.0)
