"""Steps of planar impacts, of one in plain numbers or of many side by side in arrays.

An impact asks for a step by its phase and by numbers. The answer is how far the series
hold or the first event within, which event, u, V, k, J, T and what the phase has beside there, and
the greatest u on the way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from contactlab_laws.fronts.series import (
    ORDER,
    Laws,
    Number,
    Series,
    along_drawn,
    along_gross,
    along_locked,
    along_stick,
    difference,
    negative,
    value,
)

#: A series is followed as far as its last two terms stay below the tolerance, times this.
CAREFUL = 0.9
#: Longest step: beyond it forces turn more than events are looked for.
LONGEST = 1.0
#: Error of a step over its velocity that is rounding: a jam may multiply velocities by 1e8.
ROUNDING = 1e-14
#: Places in a step at which events are looked for, and where a root has been found.
LOOKS, ROOT_VALUE, ROOT_WIDTH, ROOT_CAP = 8, 1e-17, 1e-16, 80
#: Places in a step at which the greatest u is looked for.
PEAKS = 16


class Course(NamedTuple):
    """The series of a step, those that bound the step, and those whose fall below zero ends it.

    A series marked True begins at zero: the fall of the series over x is looked for.
    """

    rows: list[Series]
    bounds: list[Series]
    events: list[tuple[Series, Any]]


def stick(numbers: tuple[Number, ...]) -> Course:
    """All sticks until k, or its like of the other sign, is zero."""
    rows = along_stick(Laws(*numbers[:4]), *numbers[4:8])
    rate, margin = rows[1:3]
    other = difference(rate, difference(margin, rate))
    return Course(rows, rows[:4], [(margin, numbers[8]), (other, False)])


def drawn(numbers: tuple[Number, ...], fresh: bool) -> Course:
    """Slip eats drawn memory until slip stops, the memory is spent, or the edge meets the front."""
    rows = along_drawn(Laws(*numbers[:4]), numbers[4:7], numbers[7:11], numbers[11], fresh=fresh)
    u, rate, margin, lack, _, front, *then, left, _ = rows
    gap = (difference(u, front), numbers[13])
    bounds = [u, rate, margin, lack, front, *then, left]
    return Course(rows, bounds, [(negative(margin), numbers[12]), (left, False), gap])


def locked(numbers: tuple[Number, ...]) -> Course:
    """Slip eats a locked zone until slip stops, the zone is spent, or the edge meets the front."""
    inner = numbers[9]
    rows = along_locked(Laws(*numbers[:4]), numbers[4:7], numbers[7], numbers[8])
    u, rate, margin, _, _, front, _ = rows
    rest = front.copy()
    rest[0] = front[0] - inner
    gap = (difference(u, front), numbers[11])
    return Course(
        rows, [u, rate, margin, front], [(negative(margin), numbers[10]), (rest, False), gap]
    )


def gross(numbers: tuple[Number, ...], stops: bool, falls: bool) -> Course:
    """All slips until V is ``last`` if slip stops, else until u is zero."""
    rows = along_gross(Laws(*numbers[:4]), *numbers[4:7])
    u, rate = rows[:2]
    ahead = rate.copy() if falls else negative(rate)
    ahead[0] = ahead[0] - numbers[7] if falls else ahead[0] + numbers[7]
    return Course(rows, rows[:2], [(ahead, False)] if stops else [(u, numbers[8])])


#: A phase with its kind, and the numbers of one impact in it.
Request: TypeAlias = tuple[tuple[Any, ...], tuple[float, ...]]
#: How far, which event, the series' values there, and the greatest u.
Answer: TypeAlias = tuple[float, int, list[float], float]


def one(
    request: Request, tolerance: float, watch: Callable[[list[Series], float], object]
) -> Answer | None:
    """Return the answer for one impact, whose steps are shown; None if it is lost."""
    (phase, *kind), numbers = request
    rows, bounds, events = phase(numbers, *kind)
    length = LONGEST
    for row in bounds:
        allowed = max(tolerance, ROUNDING * abs(row[0]))
        for order in (ORDER, ORDER - 1):
            size = abs(row[order])
            if not size < math.inf:
                return None
            if size > 0.0:
                length = min(length, (allowed / size) ** (1.0 / order))
    t, event = first_fall(events, CAREFUL * length)
    watch(rows, t)
    values = [value(row, t) for row in rows]
    peak = max(rows[0][0], values[0])
    if rows[1][0] > 0.0 >= values[1]:
        peak = max(peak, *(value(rows[0], t * j / PEAKS) for j in range(1, PEAKS)))
    return t, event, values, peak


def many(requests: Sequence[Request], tolerance: float) -> list[Answer | None]:
    """Return the answers for impacts in one phase; None for one that is lost."""
    phase, *kind = requests[0][0]
    numbers = tuple(np.array([request[1] for request in requests]).T.copy())
    with np.errstate(all="ignore"):
        rows, bounds, events = phase(numbers, *kind)
        ends = np.array([[row[ORDER], row[ORDER - 1]] for row in bounds])
        allowed = np.maximum(tolerance, ROUNDING * np.abs([row[0] for row in bounds]))
        powers = np.array([[1.0 / ORDER], [1.0 / (ORDER - 1)]])
        lengths = (allowed[:, None] / np.abs(ends)) ** powers
        length = CAREFUL * np.minimum(LONGEST, lengths.min(axis=(0, 1)))
        found = np.isfinite(ends).all(axis=(0, 1))
        t, which = length.copy(), np.full(length.shape, -1)
        for event, (series, flag) in enumerate(events):
            fresh = np.broadcast_to(np.asarray(flag, dtype=bool), t.shape)
            for place in np.flatnonzero(_may_fall(series, fresh, length) & found).tolist():
                own = series[int(fresh[place]) :, place].tolist()
                fall = _fall(own, t[place].item())
                if fall is not None:
                    t[place], which[place] = fall, event
        values = value(np.stack(rows, axis=1), t)
        peak = np.maximum(rows[0][0], values[0])
        for place in np.flatnonzero((rows[1][0] > 0.0) & (values[1] <= 0.0)).tolist():
            u, end = rows[0][:, place].tolist(), t[place].item()
            inside = max(value(u, end * j / PEAKS) for j in range(1, PEAKS))
            peak[place] = max(peak[place], inside)
    answers = zip(t.tolist(), which.tolist(), values.T.tolist(), peak.tolist(), strict=True)
    return [answer if here else None for answer, here in zip(answers, found.tolist(), strict=True)]


def _may_fall(series: Series, fresh: Number, end: Number) -> Number:
    """Return which series are negative, or dip, at one of the places that ``_fall`` looks at."""
    if fresh.any():
        series = np.where(fresh, np.append(series[1:], 0.0 * series[:1], axis=0), series)
    seen = value(series, end / LOOKS * np.arange(LOOKS + 1.0)[:, None])
    dips = (seen[1:-1] < seen[:-2]) & (seen[1:-1] < seen[2:])
    return (seen[1:] < 0.0).any(axis=0) | dips.any(axis=0)


def first_fall(events: list[tuple[Series, bool]], end: float) -> tuple[float, int]:
    """Return where the first of some series falls below zero in (0, end], and which; (end, -1)."""
    where, which = end, -1
    for index, (series, fresh) in enumerate(events):
        found = _fall(series[1:] if fresh else series, where)
        if found is not None:
            where, which = found, index
    return where, which


def _fall(series: list[float], end: float) -> float | None:
    """Return the first place at which a series is negative, seen at ``LOOKS`` places."""
    step = end / LOOKS
    seen = [series[0]]
    for look in range(1, LOOKS + 1):
        t = step * look
        here = value(series, t)
        seen.append(here)
        before = seen[look - 1]
        if here < 0.0:
            return _root(series, t - step, t, before, here)
        if look > 1 and before < seen[look - 2] and before < here:  # a dip, perhaps below zero
            slope, bend = 0.5 * (here - seen[look - 2]), here + seen[look - 2] - 2.0 * before
            t = step * (look - 1 - slope / bend)
            lowest = value(series, t)
            if lowest < 0.0:
                return _root(series, step * (look - 2), t, seen[look - 2], lowest)
    return None


def _root(series: list[float], a: float, b: float, at_a: float, at_b: float) -> float:
    """Return the root between a and b by the Illinois method."""
    if at_a <= 0.0:
        return a
    side, t = 0, a
    for _ in range(ROOT_CAP):
        t = (at_a * b - at_b * a) / (at_a - at_b)
        here = value(series, t)
        if abs(here) < ROOT_VALUE or b - a < ROOT_WIDTH:
            break
        if here > 0.0:
            a, at_a, at_b = t, here, 0.5 * at_b if side > 0 else at_b
            side = 1
        else:
            b, at_b, at_a = t, here, 0.5 * at_a if side < 0 else at_a
            side = -1
    return t
