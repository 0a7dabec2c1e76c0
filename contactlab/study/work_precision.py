"""Error against run time: every question by every door, against its true answer.

Errors and times come from separate calls. A time is of the processor, the least of repeated calls.
A failed call is a gap with its status, and is never dropped.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import attrs
import numpy as np

from contactlab.numeric.checks import yes_or_no
from contactlab.numeric.types import Array
from contactlab.study.benchmark import ALIKE, ROUNDING, Benchmark, Row
from contactlab.study.doors import Answer, Call, Door
from contactlab.study.peers import missing
from contactlab.study.questions import Posed, Question
from contactlab.study.time_limit import TimeLimitError, end_of, in_time

#: Repeats of a timed call, and the least time of one in s: a shorter call is made several times.
REPEATS, LEAST_TIME = 5, 5e-4
#: A door is not called again for a time after so many seconds. A batch is of as many impacts as it
#: answers in this time one by one; of fewer it is not timed.
LONG, LONG_QUICK, FEWEST = 2.0, 0.08, 3
#: Processor time of one impact, in s, from which on a door is not refined further.
SLOW, SLOW_QUICK = 0.1, 0.08
#: A method whose log error falls by less than this over its resolutions has no order.
LEAST_GAIN = 0.5


def bench(
    questions: Sequence[Question],
    *,
    quick: bool = False,
    time_limit: float | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Benchmark:
    """Return errors and times of every door of every question.

    Parameters
    ----------
    questions : sequence of Question
    quick : bool
        Fewer impacts and resolutions.
    time_limit : float, optional
        Seconds of clock after which the report ends; ``complete`` then is False.
    progress : callable, optional
        Called as ``progress(done, total)`` after each question.

    Returns
    -------
    Benchmark
        Ctrl-C keeps the doors that are done.
    """
    quick = yes_or_no("quick", quick)
    until = end_of(time_limit)
    rows: list[Row] = []
    interrupted = complete = False
    try:
        for done, question in enumerate(questions, start=1):
            posed = in_time(partial(question.pose, quick), until)
            _ask(question, posed, rows, until, quick=quick)
            if progress is not None:
                progress(done, len(questions))
        complete = True
    except TimeLimitError:
        pass
    except KeyboardInterrupt:
        interrupted = True
    return Benchmark(
        rows=tuple(_with_nearer(rows)),
        orders=_orders(rows),
        complete=complete,
        interrupted=interrupted,
        left_out=missing() if any(question.peers for question in questions) else (),
    )


def _ask(question: Question, posed: Posed, rows: list[Row], until: float, *, quick: bool) -> None:
    """Add the rows of a question, without resolutions that change no answer."""
    slow: set[str] = set()
    known: dict[str, list[Array]] = {}
    for door in posed.doors:
        row = Row(question=question.name, method=door.name, options=door.options)
        row = attrs.evolve(row, limit=door.limit, converges=door.converges, peer=door.peer)
        if door.name in slow:
            rows.append(attrs.evolve(row, failed=1, status="NOT_RUN"))
            continue
        answers, first = in_time(partial(_answers, door, posed), until)
        numbers = [each.numbers for each in answers]
        if door.read and _alike(known.get(door.name), numbers):
            continue
        known[door.name] = numbers
        failed = [each.status for each in answers if each.status != "SUCCESS"]
        if failed:
            rows.append(attrs.evolve(row, failed=len(failed), status=failed[0]))
            continue
        errors = _errors(answers, posed.truths)
        row = attrs.evolve(row, **errors)
        row = attrs.evolve(row, **in_time(partial(_times, door, posed, first, quick), until))
        rows.append(row)
        if row.time_s > (SLOW_QUICK if quick else SLOW):
            slow.add(door.name)


def _answers(door: Door, posed: Posed) -> tuple[list[Answer], float]:
    """Return the answers to all impacts, and the mean time of such first calls.

    A limit that answers nothing has no answers.
    """
    if door.read is None:
        return [], 0.0
    calls = [door.bind(impact) for impact in posed.impacts]
    before = time.process_time()
    answers = [call() for call in calls]
    taken = time.process_time() - before
    return [door.read(answer) for answer in answers], taken / len(calls)


def _alike(before: list[Array] | None, now: list[Array]) -> bool:
    """Return whether answers equal those of the last resolution to the last bit."""
    return before is not None and all(map(np.array_equal, before, now))


def _errors(answers: Sequence[Answer], truths: Sequence[Array]) -> dict[str, Any]:
    """Return rms and largest error over impacts and numbers, and the worst energy books."""
    if not answers:
        return {}
    off = [answer.numbers - truth for answer, truth in zip(answers, truths, strict=True)]
    errors = np.concatenate(off)
    return {
        "error_rms": float(np.sqrt(np.mean(errors**2))),
        "error_worst": float(np.max(np.abs(errors))),
        "books_worst": float(np.max([answer.books for answer in answers])),
    }


def _times(door: Door, posed: Posed, first: float, quick: bool) -> dict[str, Any]:
    """Return the mean time of one impact alone, and the time of each of many.

    First calls, which took ``first`` each, are repeated unless that would be long.
    """
    longest = LONG_QUICK if quick else LONG
    each, alone = longest / len(posed.impacts), first
    if first < each:
        times = [least_time(door.bind(impact), each) for impact in posed.impacts]
        alone = float(np.mean(times))
    found = {"time_s": alone / door.calls}
    size = min(posed.most, int(longest / found["time_s"]))
    if door.together and posed.batch is not None and size >= FEWEST:
        found["sweep_time_s"] = least_time(door.bind(posed.batch(size)), longest) / size
    return found


def least_time(call: Call, longest: float) -> float:
    """Return the least processor time of several calls, in s; long calls are made once."""
    least, number, spent, repeats = np.inf, 1, 0.0, 0
    while repeats < REPEATS and (spent < longest or not repeats):
        before = time.process_time()
        for _ in range(number):
            call()
        taken = time.process_time() - before
        spent += taken
        if taken < LEAST_TIME and spent < longest:  # such a call is short for the clock
            number *= 10
            continue
        least = min(least, taken / number)
        repeats += 1
    return float(least)


def _with_nearer(rows: list[Row]) -> list[Row]:
    """Return the rows, with marks on methods that come nearer to the continuum."""
    errors: dict[tuple[str, str], list[float]] = {}
    for row in rows:
        if row.ok:
            errors.setdefault((row.question, row.method), []).append(row.error_rms)
    nearer = {key for key, each in errors.items() if each[-1] * ALIKE < each[0]}
    return [
        attrs.evolve(row, converges=row.converges or (row.question, row.method) in nearer)
        for row in rows
    ]


def _orders(rows: list[Row]) -> dict[str, float]:
    """Return the order of each method of the first question that has one."""
    by_method: dict[str, dict[str, list[Row]]] = {}
    for row in rows:
        by_method.setdefault(row.method, {}).setdefault(row.question, []).append(row)
    found = {}
    for method, by_question in by_method.items():
        orders = [order for each in by_question.values() if (order := _order(each)) == order]
        if orders:
            found[method] = orders[0]
    return found


def _order(rows: list[Row]) -> float:
    """Return the order of the rms error in steps or parts; NaN under a tolerance or without one."""
    points = []
    for row in rows:
        sizes = [float(word.partition("=")[2]) for word in row.options.split(", ") if "=" in word]
        if row.ok and sizes and row.error_rms > ROUNDING and "tolerance" not in row.options:
            points.append((np.log(sizes[0]), np.log(row.error_rms)))
    if len(points) < 3 or points[0][1] - points[-1][1] < LEAST_GAIN:
        return float("nan")
    x, y = np.array(points).T
    return float(-np.polyfit(x, y, 1)[0])
