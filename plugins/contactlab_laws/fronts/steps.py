"""Steps of one impact along the series of a phase, in plain numbers."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from contactlab_laws.fronts.compiled import LEAST_ERROR, LOST
from contactlab_laws.fronts.path import Answer, Impact, Request
from contactlab_laws.fronts.phases import HEAD, LAWS, Events, Numbers, Phase
from contactlab_laws.fronts.series import ORDER, Laws, Rows, value

#: Error of a step over the accuracy asked for, and the most: forces within a coarse series err by
#: more than what it leads to.
STEP_PART, MOST_ERROR = 1e-3, 1e-8
#: A series is followed as far as its last two terms stay below the tolerance, times this.
CAREFUL = 0.9
#: Longest step: beyond it forces turn more than events are looked for.
LONGEST = 1.0
#: Error of a step over its velocity that is rounding: a jam may multiply velocities by 1e8.
ROUNDING = 1e-14
#: Parts of a step at whose ends events are looked for, and where a root has been found.
LOOKS, ROOT_VALUE, ROOT_WIDTH, ROOT_CAP = 8, 1e-17, 1e-16, 80
#: Moves of Newton's method to where a dip is lowest.
MOVES = 8

#: Places and weights of Gauss's rule on [0, 1], which adds up the friction work of a step.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
PLACES, SHARES = (0.5 + 0.5 * _NODES).tolist(), (0.5 * _WEIGHTS).tolist()

#: Called with the phase and the series of a step, how far they are followed, and the state there.
Watch = Callable[[Phase, Rows, float, tuple[float, ...]], object]


def error_of_step(accuracy: float) -> float:
    """Return the error that a step may have for an accuracy of the answer."""
    return min(max(LEAST_ERROR, STEP_PART * accuracy), MOST_ERROR)


def alone(impact: Impact, tolerance: float, most: int, watch: Watch | None = None) -> str:
    """Follow one impact to separation; return why it has no answer, "" if it has one."""
    path, answer = impact.path(), None
    try:
        while True:
            request: Request = path.send(answer)  # type: ignore[arg-type]
            answer = one(*request, tolerance, most, watch)
            if reason := failure(answer, most):
                return reason
    except StopIteration:
        return ""
    except ArithmeticError as error:
        return str(error)


def failure(answer: Answer | None, most: int) -> str:
    """Return why a phase has not come to its end, "" if it has."""
    if answer is None:
        return LOST[2]
    return "" if answer[0] >= 0 else LOST[1].format(most)


def one(
    phase: Phase,
    numbers: Numbers,
    tolerance: float,
    most: int,
    watch: Watch | None = None,
) -> tuple[int, Numbers] | None:
    """Return the event that ends a phase of one impact, and its numbers there.

    None if the numbers grow without bound; the event is -1 after ``most`` steps.
    """
    deepest, compressions, steps = numbers[:HEAD]
    laws, end = Laws(*numbers[HEAD:LAWS]), LAWS + phase.size
    state, constants = numbers[LAWS:end], numbers[end:]
    event = -1
    while event < 0 and steps < most:
        form = int(phase.form(state, constants))
        rows, events = phase.course(laws, state, constants, form)
        length = _length(rows, tolerance)
        if length is None:
            return None
        t, event = first_fall(events, length)
        work = state[-1]
        if phase.slips:
            seen = [rows[index] for index in phase.slips]
            for place, share in zip(PLACES, SHARES, strict=True):
                values = [value(row, t * place) for row in seen]
                work += t * share * phase.power(form, *values)
        last = (*[value(row, t) for row in rows], work)
        if watch is not None:
            watch(phase, rows, t, last)
        deepest = max(deepest, state[0], last[0])
        if state[1] > 0.0 >= last[1]:
            top, _ = first_fall([(rows[1], False)], t)
            deepest = max(deepest, value(rows[0], top))
        compressions += state[1] <= 0.0 < last[1]
        steps, state = steps + 1, last
    return event, (deepest, compressions, steps, *numbers[HEAD:LAWS], *state, *constants)


def _length(rows: Rows, tolerance: float) -> float | None:
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


def first_fall(events: Events, end: float) -> tuple[float, int]:
    """Return where the first of some series falls below zero in (0, end], and which; (end, -1)."""
    where, which = end, -1
    for index, (series, fresh) in enumerate(events):
        found = fall(series[1:] if fresh else series, where)
        if found is not None:
            where, which = found, index
    return where, which


def fall(series: list[float], end: float) -> float | None:
    """Return the first place at which a series is negative, seen at ``LOOKS`` places."""
    most = 0.0
    for coefficient in reversed(series):
        most = most * end + abs(coefficient)
    if 2.0 * series[0] > most:  # the first term is more than all others together
        return None
    step, before, falls = end / LOOKS, series[0], series[1] < 0.0
    for look in range(1, LOOKS + 1):
        t = step * look
        here = value(series, t)
        if here < 0.0:
            return _root(series, t - step, t, before, here)
        fell, falls = falls, here < before if look < LOOKS else slope_at(series, t)[0] < 0.0
        if (fell and not falls) or (look == LOOKS and here < before and not falls):
            # a dip, perhaps below zero, in this part or the one before
            start = max(t - 2.0 * step, 0.0)
            lowest = _lowest(series, start, t)
            least = value(series, lowest)
            if least < 0.0:
                return _root(series, start, lowest, value(series, start), least)
        before = here
    return None


def slope_at(series: list[float], t: float) -> tuple[float, float]:
    """Return the first and the second derivative at t."""
    slope = bend = 0.0
    for n in range(len(series) - 1, 0, -1):
        bend = bend * t + slope
        slope = slope * t + n * series[n]
    return slope, bend


def _lowest(series: list[float], low: float, high: float) -> float:
    """Return where a dip between two places is lowest, by Newton's method kept within them."""
    t = 0.5 * (low + high)
    for _ in range(MOVES):
        slope, bend = slope_at(series, t)
        low, high = (t, high) if slope < 0.0 else (low, t)
        new = t - slope / bend if bend > 0.0 else low
        t = new if low < new < high else 0.5 * (low + high)
    return t


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
