"""Stiff and extreme cases over every law and integrator: errors, refusals, silent wrongs."""

from __future__ import annotations

import contextlib
import math
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import attrs
import numpy as np

from contactlab.impact.error_model import COARSE
from contactlab.numeric.checks import yes_or_no
from contactlab.registry.composition import DEFAULT_NORMAL
from contactlab.study.bench_methods import Method
from contactlab.study.model_error import ModelError, model_error
from contactlab.study.stability_cases import INCIDENCES, MAP, Cell, all_cases, map_chis
from contactlab.study.stability_judge import (
    ANSWERED,
    NO_REFERENCE,
    RAISED,
    REFUSED,
    SKIPPED,
    WRONG,
    Outcome,
    judge,
)
from contactlab.study.time_limit import TimeLimitError, end_of, in_time

#: A case of more work than this, in steps of one part, is skipped. Work is not time: which cases
#: are tried does not depend on the machine.
LARGEST, QUICK_LARGEST = 300_000.0, 12_000.0
#: Steps and tolerance assumed in ``work`` where the case sets none.
DEFAULT_STEPS, DEFAULT_TOLERANCE = 200, 1e-4
#: Steps under a tolerance where slip turns, over those where it keeps its line.
SPACE_STEPS = 5.0
#: Parts below which steps under a tolerance become many, as each part slips at once.
SMOOTH_PARTS = 100.0
#: Processor time of a case, and of a step of one part, of a quick report, in s.
SECONDS, SECONDS_A_STEP = 0.02, 7.5e-5


@attrs.frozen(kw_only=True)
class Stability:
    """Every outcome, and the model error of each law.

    Outcomes hold numerical errors, against the law's own exact answer. ``models`` holds the model
    errors of laws whose exact answer is not that of the elastic continuum. ``complete`` is False
    if the time limit or Ctrl-C left cases out; ``interrupted`` is True on Ctrl-C.
    """

    outcomes: tuple[Outcome, ...]
    complete: bool
    models: tuple[ModelError, ...] = ()
    interrupted: bool = False

    def failures(self) -> list[Outcome]:
        """Return the cases that are silently wrong or raised."""
        return [item for item in self.outcomes if item.outcome in (WRONG, RAISED)]

    def count(self, outcome: str) -> int:
        """Return the number of cases with an outcome."""
        return sum(item.outcome == outcome for item in self.outcomes)

    def tried(self) -> int:
        """Return the number of runs judged."""
        return len(self.outcomes) - self.count(SKIPPED)

    def totals(self) -> dict[str, int]:
        """Return the number of answers compared, of wrong answers, and of all other cases.

        Compared and without a reference, refused, raised and not run are all cases; wrong answers
        are among the first two.
        """
        compared = sum(item.compared for item in self.outcomes)
        return {
            "compared": compared,
            "silently_wrong": self.count(WRONG),
            "no_reference": self.count(ANSWERED) + self.count(WRONG) - compared,
            "refused": self.count(REFUSED),
            "raised": self.count(RAISED),
            "not_run": self.count(SKIPPED),
        }

    def counts(self, method: str) -> Counter[str]:
        """Return the number of cases with each outcome.

        ``coarse`` and ``NO_REFERENCE`` are parts of ``ANSWERED``.
        """
        mine = [item for item in self.outcomes if item.method == method]
        counts = Counter(item.outcome for item in mine)
        answered = [item for item in mine if item.outcome == ANSWERED]
        counts["coarse"] = sum(item.bound > COARSE for item in answered)
        counts[NO_REFERENCE] = sum(not item.compared for item in answered)
        return counts

    def worst(self, method: str, family: str) -> float:
        """Return the largest error over the range, of answers that are not coarse; NaN if none."""
        errors = [
            item.error
            for item in self.outcomes
            if (item.method, item.family, item.outcome) == (method, family, ANSWERED)
            and item.bound <= COARSE
        ]
        return float(np.fmax.reduce(errors, initial=np.nan))


def stability(
    methods: Sequence[Method],
    *,
    quick: bool = False,
    time_limit: float | None = None,
    progress: Callable[[int, int], object] | None = None,
    judge: Callable[[Cell], Outcome] = judge,
) -> Stability:
    """Run every case of every method, and return outcomes and model errors.

    Parameters
    ----------
    methods : sequence of Method
    quick : bool
        Fewer scenes and resolutions, without the long ones.
    time_limit : float, optional
        Seconds of clock after which the report ends; ``complete`` then is False.
    progress : callable, optional
        Called as ``progress(done, total)``.
    judge : callable
        Runs one case and returns its outcome.

    Returns
    -------
    Stability
        Ctrl-C keeps the outcomes that there are.
    """
    until = end_of(time_limit)
    quick = yes_or_no("quick", quick)
    listed = list_cases(methods, quick=quick)
    elastic = [method for method in methods if method.normal == DEFAULT_NORMAL]
    largest = QUICK_LARGEST if quick else LARGEST
    # A time limit cuts all methods alike: family by family, and within a family by work. Model
    # errors come after the map, which has cached the costly exact answers.
    jobs: list[Callable[[], Outcome | ModelError | None]] = [
        partial(judge if work(case) <= largest else _skip, case)
        for case in sorted(listed, key=lambda case: (case.family == MAP, case.family, work(case)))
    ]
    jobs += [
        partial(model_error, law, map_chis(quick=quick), INCIDENCES)
        for law in dict.fromkeys(method.tangential for method in elastic)
    ]
    items: list[Any] = []
    interrupted = False
    try:
        for done, job in enumerate(jobs, start=1):
            items.append(in_time(job, until))
            if progress is not None:
                progress(done, len(jobs))
    except TimeLimitError:
        pass
    except KeyboardInterrupt:
        interrupted = True
    return Stability(
        outcomes=tuple(item for item in items if isinstance(item, Outcome)),
        models=tuple(item for item in items if isinstance(item, ModelError)),
        complete=len(items) == len(jobs),
        interrupted=interrupted,
    )


def list_cases(methods: Sequence[Method], *, quick: bool = False) -> list[Cell]:
    """Return every case of every method."""
    return [case for method in methods for case in all_cases(method, quick=quick)]


def estimate_time(methods: Sequence[Method], *, quick: bool = False) -> tuple[int, float]:
    """Return the number of cases, and about the processor time that they take, in s."""
    listed = list_cases(methods, quick=quick)
    largest = QUICK_LARGEST if quick else LARGEST
    works = [each for each in map(work, listed) if each <= largest]
    return len(works), SECONDS * len(works) + SECONDS_A_STEP * sum(works)


def work(case: Cell) -> float:
    """Return an estimate of the work of a case, in steps of one part.

    Under a tolerance the number of steps grows with the root of chi, faster where slip turns and
    where parts are few, and falls with the root of the tolerance.
    """
    options, parts = case.options["integrator"], dict(case.options["tangential"])
    parts.pop("tolerance", None)
    steps = float(options.get("steps", DEFAULT_STEPS))
    if "steps" not in options:
        tolerance = float(options.get("tolerance", DEFAULT_TOLERANCE))
        with contextlib.suppress(ValueError):  # a refused scene is an outcome
            steps *= math.sqrt(1.0 + min(float(np.max(case.scene.make().chi)), 1e12))
        steps *= math.sqrt(DEFAULT_TOLERANCE / tolerance)
        steps *= SPACE_STEPS if case.family == "space" else 1.0
        fewest = float(min(parts.values(), default=SMOOTH_PARTS))
        steps *= max(SMOOTH_PARTS / fewest, 1.0)
    return steps * (1.0 + float(max(parts.values(), default=0.0)) ** 2 / 1e4)


def _skip(case: Cell) -> Outcome:
    """Return the outcome of a case that is too much work."""
    return Outcome.of(case, SKIPPED, "too much work")
