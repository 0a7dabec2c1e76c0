"""Impacts in step: all that wait in one phase are stepped side by side, in arrays."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab_laws.fronts.path import Answer, Impact
from contactlab_laws.fronts.phases import HEAD, LAWS, Events, Numbers, Phase
from contactlab_laws.fronts.series import ORDER, Laws, Rows
from contactlab_laws.fronts.steps import (
    CAREFUL,
    LONGEST,
    LOOKS,
    PLACES,
    ROUNDING,
    SHARES,
    alone,
    failure,
    fall,
    one,
)

#: Fewer impacts than these are stepped one at a time.
FEW = 12
#: Moves of Newton's method at most; after one as short as this, in parts of the step, the rest is
#: its square.
MOVES, NEAR = 50, 1e-8
#: Powers of the places at which events are looked for, and of which slopes are multiples.
LOOK_POWERS = (np.arange(LOOKS + 1)[:, None] / LOOKS) ** np.arange(ORDER + 1)
POWERS = np.arange(1.0, ORDER + 1)[:, None]
#: Powers of the places at which friction work is added up, and their weights.
PLACE_POWERS, WEIGHTS = np.array(PLACES)[:, None] ** np.arange(ORDER + 1), np.array(SHARES)


def follow(impacts: list[Impact], tolerance: float, most: int) -> list[str]:
    """Follow impacts to separation; return why each has no answer, "" if it has one.

    The largest group is stepped first: those behind wait, and join.
    """
    if len(impacts) < FEW:
        return [alone(impact, tolerance, most) for impact in impacts]
    lost = [""] * len(impacts)
    paths = [impact.path() for impact in impacts]
    groups: dict[tuple[Phase, int], list[Group]] = {}

    def join(group: Group) -> None:
        """Let impacts of one phase wait with others of their form."""
        phase, places, table = group
        end = LAWS + phase.size
        forms = np.asarray(phase.form(table[LAWS:end], table[end:]))
        for form in np.unique(forms).tolist():
            part = np.flatnonzero(forms == form)
            own = Group(phase, places[part], table[:, part])
            groups.setdefault((phase, int(form)), []).append(own)

    answers: list[tuple[int, Answer | None]] = [(place, None) for place in range(len(impacts))]
    begins = True
    while True:
        newcomers: dict[Phase, list[tuple[int, Numbers]]] = {}
        for place, answer in answers:
            reason = "" if begins else failure(answer, most)
            if not reason:
                try:
                    phase, numbers = paths[place].send(answer)  # type: ignore[arg-type]
                    newcomers.setdefault(phase, []).append((place, numbers))
                except StopIteration:
                    continue
                except ArithmeticError as error:
                    reason = str(error)
            lost[place] = reason
        begins = False
        for phase, them in newcomers.items():
            places, columns = zip(*them, strict=True)
            join(Group(phase, np.array(places), np.array(columns).T))
        if not groups:
            return lost
        kind = max(groups, key=lambda kind: sum(group.places.size for group in groups[kind]))
        group = _together(groups.pop(kind))
        if group.places.size < FEW:
            columns = group.table.T.tolist()
            ends = [one(group.phase, column, tolerance, most) for column in columns]
            answers = list(zip(group.places.tolist(), ends, strict=True))
            continue
        with np.errstate(all="ignore"):
            events, finite = _step(group, kind[1], tolerance)
        gone = (events >= 0) | ~finite | (group.table[2] >= most)
        answers = []
        for place, event, here, column in zip(
            group.places[gone].tolist(),
            events[gone].tolist(),
            finite[gone].tolist(),
            group.table[:, gone].T.tolist(),
            strict=True,
        ):
            answers.append((place, (event, column) if here else None))
        if not gone.all():
            join(Group(group.phase, group.places[~gone], group.table[:, ~gone]))


class Group(NamedTuple):
    """Impacts in one phase: their places, and a table of which a column is the numbers of one."""

    phase: Phase
    places: Any
    table: Any


def _together(groups: list[Group]) -> Group:
    """Return several groups of one phase as one."""
    places, tables = [group.places for group in groups], [group.table for group in groups]
    return Group(groups[0].phase, np.concatenate(places), np.hstack(tables))


def _step(group: Group, form: int, tolerance: float) -> tuple[Any, Any]:
    """Make a step of all; return the events, -1 where there is none, and where all is finite."""
    phase, _, table = group
    end = LAWS + phase.size
    state = table[LAWS:end].copy()
    rows, falls = phase.course(Laws(*table[HEAD:LAWS]), state, table[end:], form)
    length, finite = _lengths(rows, tolerance)
    t, events = _first_falls(falls, length)
    terms = rows * _powers(t)
    last = terms.sum(axis=1)
    if phase.slips:
        table[end - 1] += t * (WEIGHTS @ phase.power(form, *(PLACE_POWERS @ terms[[*phase.slips]])))
    table[0] = np.maximum(table[0], np.maximum(state[0], last[0]))
    tops = np.flatnonzero((state[1] > 0.0) & (last[1] <= 0.0))
    if tops.size:
        top, _ = _first_falls([(rows[1][:, tops], False)], t[tops])
        table[0, tops] = np.maximum(table[0, tops], _values(rows[:1, :, tops], top)[0])
    table[1] += (state[1] <= 0.0) & (last[1] > 0.0)
    table[2] += 1.0
    table[LAWS : end - 1] = last
    return events, finite


def _lengths(rows: Rows, tolerance: float) -> tuple[Any, Any]:
    """Return how far all series of a step hold but that of time, and which are finite."""
    allowed = np.maximum(tolerance, ROUNDING * np.abs(rows[:, :1]))
    ends = np.abs(rows[:, ORDER - 1 :]) / allowed
    ends[-1] = 0.0
    before, last = ends.max(axis=0)
    length = np.minimum(last ** (-1.0 / ORDER), before ** (-1.0 / (ORDER - 1)))
    return CAREFUL * np.minimum(LONGEST, length), np.isfinite(before + last)


def _powers(t: Any) -> Any:
    """Return the powers of some places that multiply the coefficients of a series."""
    powers = np.empty((ORDER + 1, t.size))
    powers[0] = 1.0
    powers[1:] = t
    return np.multiply.accumulate(powers, axis=0)


def _values(rows: Rows, t: Any) -> Any:
    return np.einsum("rij,ij->rj", rows, _powers(t))


def _first_falls(events: Events, lengths: Any) -> tuple[Any, Any]:
    """Return where the first of some series falls below zero, and which, of many impacts."""
    where, which = lengths.copy(), np.full(lengths.shape, -1)
    for index, (series, flag) in enumerate(events):
        fresh = np.broadcast_to(np.asarray(flag, dtype=bool), lengths.shape)
        if fresh.any():
            series = np.where(fresh, np.append(series[1:], 0.0 * series[:1], axis=0), series)
        terms = series * _powers(where)
        near = np.flatnonzero(2.0 * terms[0] <= np.abs(terms).sum(axis=0))
        if not near.size:
            continue
        seen = LOOK_POWERS @ terms[:, near]
        ends = terms[1, near], (POWERS * terms[1:, near]).sum(axis=0)
        rises = np.vstack([ends[0], np.diff(seen, axis=0), ends[1]]) >= 0.0
        dips = (~rises[:-1] & rises[1:]).any(axis=0)
        below = seen < 0.0
        below[0] = False
        falls = below.any(axis=0) & ~dips
        for place in near[dips].tolist():  # between the places it may be below zero
            found = fall(series[:, place].tolist(), where[place].item())
            if found is not None:
                where[place], which[place] = found, index
        if falls.any():
            place, look = near[falls], below[:, falls].argmax(axis=0)
            share = _roots(terms[:, place], (look - 1) / LOOKS, look / LOOKS)
            where[place], which[place] = share * where[place], index
    return where, which


def _roots(series: Any, low: Any, high: Any) -> Any:
    """Return the roots between two places each, by Newton's method kept within them."""
    slopes = series[1:] * POWERS
    t = 0.5 * (low + high)
    for _ in range(MOVES):
        powers = _powers(t)
        here = np.einsum("ij,ij->j", series, powers)
        slope = np.einsum("ij,ij->j", slopes, powers[:-1])
        low, high = np.where(here > 0.0, t, low), np.where(here > 0.0, high, t)
        new = t - here / slope
        new = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
        move, t = np.abs(new - t), new
        if not (move > NEAR).any():
            break
    return t
