"""The phases of an impact: one step of each along its series, to the event that ends it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from contactlab_laws.fronts.series import (
    ORDER,
    Laws,
    Rows,
    Series,
    along_whole,
    follow_unlocking,
    retrace,
    value,
)

#: All sticks; the edge slips into memory that was drawn while all stuck, or into a zone that locked
#: out of slip; all slips.
STICK, DRAWN, LOCKED, GROSS = range(4)
#: A front whose square is below this part of its slope is followed to the centre.
INMOST = 0.1
#: Distance of the edge beyond the front that counts as rounding.
APART = 4e-15
#: A series is followed as far as its last two terms stay below the tolerance, times the first;
#: beyond the second forces turn more than events are looked for.
CAREFUL, LONGEST = 0.9, 1.0
#: Error of a step over its velocity that is rounding: a jam may multiply velocities by 1e8.
ROUNDING = 1e-14
#: Parts of a step at whose ends events are looked for, and how far off a root may be.
LOOKS, ROOT_WIDTH = 8, 1e-16
#: Moves of Newton's method to where a dip is lowest.
MOVES = 8

#: Places and weights of Gauss's rule on [0, 1], for the friction work of a step.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
PLACES, WEIGHTS = (0.5 + 0.5 * _NODES).tolist(), (0.5 * _WEIGHTS).tolist()


class Step(NamedTuple):
    """Series to ``length``, the event there, -1 if there is none, and the friction work."""

    rows: Rows
    length: float
    event: int
    work: float


def step(
    phase: int, laws: Laws, state: Sequence[float], end: float, tolerance: float
) -> Step | None:
    """Return the next step of a phase; None if its numbers grow without bound.

    ``end`` is the radius at which a locked zone is spent, or whether gross slip stops.
    """
    back = inmost = False
    if phase == STICK:
        rows = along_whole(laws, state, sticks=True)
        # k, or k of the other sign, falls below zero
        other = [rate - (margin - rate) for rate, margin in zip(rows[1], rows[2], strict=True)]
        events = [(rows[2], state[2] == 0.0), (other, False)]
    elif phase == GROSS:
        rows = along_whole(laws, state, sticks=False)
        events = [_slip_stops(rows) if end else (rows[0], state[0] == 0.0)]
    else:
        if phase == DRAWN:
            u, _, k, _, c, _, k1, *_ = state
            fresh, back = k == 0.0 and k1 == 0.0, abs(u * k) > abs(c * k1)
            rows = retrace(laws, state, fresh=fresh, back=back)
            spent = rows[7]
        else:
            inmost = state[4] * state[4] < INMOST * abs(state[0] * state[2])
            rows = follow_unlocking(laws, state, inmost=inmost)
            spent = [rows[4][0] - end, *rows[4][1:]]
        events = [_slip_stops(rows), (spent, False), _edge_meets(rows)]
    length = _usable(rows, tolerance)
    if length is None:
        return None
    length, event = first_fall(events, length)
    work = 0.0 if phase in (STICK, GROSS) else _work(rows, length, back=back, inmost=inmost)
    return Step(rows, length, event, work)


def _slip_stops(rows: Rows) -> tuple[Series, bool]:
    """Return -k."""
    return [-margin for margin in rows[2]], rows[2][0] == 0.0


def _edge_meets(rows: Rows) -> tuple[Series, bool]:
    """Return how far the edge is beyond the front."""
    gap, meets = [u - c for u, c in zip(rows[0], rows[4], strict=True)], rows[0][0] == rows[4][0]
    # at chi = 1/2 the two go together; beside zero it is the slope that is looked at
    gap[meets] += APART
    return gap, meets


def _work(rows: Rows, length: float, *, back: bool, inmost: bool) -> float:
    """Return the integral of -u k x' (u - c)² (2u + c): u k x' is c k_1 x_1' in drawn memory."""
    total = 0.0
    for place, weight in zip(PLACES, WEIGHTS, strict=True):
        u, k, c = (value(rows[index], length * place) for index in (0, 2, 4))
        pace = c * value(rows[6], length * place) if back else -u * k
        total += weight * pace * (2.0 * c if inmost else 1.0) * (u - c) ** 2 * (2.0 * u + c)
    return length * total


def _usable(rows: Rows, tolerance: float) -> float | None:
    """Return how far all series of a step hold but that of time; None if they are not finite."""
    last = before = total = 0.0
    for row in rows[:-1]:
        allowed = max(tolerance, ROUNDING * abs(row[0]))
        size, larger = abs(row[ORDER]) / allowed, abs(row[ORDER - 1]) / allowed
        last, before, total = max(last, size), max(before, larger), total + size + larger
    if not total < math.inf:
        return None
    length = LONGEST
    if last > 0.0:
        length = min(length, last ** (-1.0 / ORDER))
    if before > 0.0:
        length = min(length, before ** (-1.0 / (ORDER - 1)))
    return CAREFUL * length


def first_fall(events: Sequence[tuple[Series, bool]], end: float) -> tuple[float, int]:
    """Return where the first of some series falls below zero in (0, end], and which; (end, -1).

    A series marked True begins at zero, and is divided by its variable first.
    """
    where, which = end, -1
    for index, (series, begins) in enumerate(events):
        found = fall(series[begins:], where)
        if found is not None:
            where, which = found, index
    return where, which


def fall(series: Series, end: float) -> float | None:
    """Return the first place at which a series is negative, seen at ``LOOKS`` places."""
    most = 0.0
    for coefficient in reversed(series):
        most = most * end + abs(coefficient)
    if 2.0 * series[0] > most:  # the first term is more than all others together
        return None
    width, before, falls = end / LOOKS, series[0], series[1] < 0.0
    for look in range(1, LOOKS + 1):
        t = width * look
        here = value(series, t)
        if here < 0.0:
            return _root(series, t - width, t, before)
        fell, falls = falls, here < before if look < LOOKS else _slopes(series, t)[0] < 0.0
        if (fell and not falls) or (look == LOOKS and here < before and not falls):
            # a dip, perhaps below zero, in this part or the one before
            start = max(t - 2.0 * width, 0.0)
            lowest = _lowest(series, start, t)
            if value(series, lowest) < 0.0:
                return _root(series, start, lowest, value(series, start))
        before = here
    return None


def _slopes(series: Series, t: float) -> tuple[float, float]:
    """Return the first and the second derivative at t."""
    slope = bend = 0.0
    for n in range(len(series) - 1, 0, -1):
        bend = bend * t + slope
        slope = slope * t + n * series[n]
    return slope, bend


def _lowest(series: Series, low: float, high: float) -> float:
    """Return where a dip between two places is lowest, by Newton's method kept within them."""
    t = 0.5 * (low + high)
    for _ in range(MOVES):
        slope, bend = _slopes(series, t)
        low, high = (t, high) if slope < 0.0 else (low, t)
        new = t - slope / bend if bend > 0.0 else low
        t = new if low < new < high else 0.5 * (low + high)
    return t


def _root(series: Series, a: float, b: float, at_a: float) -> float:
    """Return the root between a and b, where the series is negative at b."""
    from scipy.optimize import brentq  # only without the compiled solver

    return a if at_a <= 0.0 else float(brentq(partial(value, series), a, b, xtol=ROOT_WIDTH))
