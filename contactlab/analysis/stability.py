"""Stiff and extreme cases over every law and integrator: errors, refusals, silent wrongs."""

from __future__ import annotations

import math
import statistics
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence

import attrs
import numpy as np

from contactlab.analysis.bench_methods import Method
from contactlab.analysis.stability_cases import Case, cases
from contactlab.analysis.stability_map import Region, region, region_cells
from contactlab.analysis.stability_outcome import (
    ANSWERED,
    RAISED,
    SKIPPED,
    WRONG,
    Outcome,
    judge,
)
from contactlab.declared import COARSE

#: A case expected to take longer than this is skipped, in s; much less in the quick set.
LONGEST, QUICK_LONGEST = 20.0, 0.5
#: Seconds that a method may take over a family of scenes; what is left of it then is skipped.
ALLOWANCE, QUICK_ALLOWANCE = 40.0, 0.3
#: Seconds that a step takes before a method has shown its own pace.
FIRST_PACE = 2e-5
#: Seconds a step of the runs so far, by method.
Paces = dict[str, list[float]]


@attrs.frozen(kw_only=True)
class Stability:
    """Every outcome, and the usable region of each method."""

    outcomes: tuple[Outcome, ...]
    regions: tuple[Region, ...]
    complete: bool

    def failures(self) -> list[Outcome]:
        """Return the cases that are silently wrong, or raised, those of the map included."""
        listed = [item for item in self.outcomes if item.outcome in (WRONG, RAISED)]
        return listed + [item for region in self.regions for item in region.failures]

    def silently_wrong(self) -> int:
        """Return how many answers are wrong without a word, those of the map included."""
        return sum(item.outcome == WRONG for item in self.failures())

    def tried(self) -> int:
        """Return the number of runs judged, those of the map included."""
        done = sum(1 for item in self.outcomes if item.outcome != SKIPPED)
        return done + sum(item.tried for item in self.regions)

    def skipped(self) -> int:
        """Return the number of cases left out because they would take too long."""
        return sum(item.outcome == SKIPPED for item in self.outcomes)

    def counts(self, method: str) -> Counter[str]:
        """Return how often each outcome came about; ``coarse`` answers are also answered."""
        mine = [item for item in self.outcomes if item.method == method]
        counts = Counter(item.outcome for item in mine)
        counts["coarse"] = sum(item.outcome == ANSWERED and item.bound > COARSE for item in mine)
        return counts

    def worst(self, method: str, family: str) -> float:
        """Return the largest error of the answers that claim better than ``COARSE``."""
        errors = [
            item.error
            for item in self.outcomes
            if (item.method, item.family) == (method, family)
            and item.outcome == ANSWERED
            and item.bound <= COARSE
        ]
        return float(np.nanmax(errors)) if not np.all(np.isnan(errors)) else np.nan


def stability(
    methods: Sequence[Method],
    *,
    quick: bool = False,
    budget: float = np.inf,
    progress: Callable[[int, int], object] | None = None,
    judged: Callable[[Case], Outcome] = judge,
) -> Stability:
    """Run the report.

    Parameters
    ----------
    methods : sequence of Method
    quick : bool
        Fewer scenes and resolutions, none of them long.
    budget : float
        Seconds after which nothing further is begun; ``complete`` then is False.
    progress : callable, optional
        Called as ``progress(done, total)``.
    judged : callable
        What runs a case, of the map too.
    """
    started = time.perf_counter()
    listed = [list(cases(method, quick=quick)) for method in methods]
    cells = [region_cells(method, quick=quick) for method in methods]
    total = sum(map(len, listed)) + sum(map(len, cells))
    outcomes: list[Outcome] = []
    regions: list[Region] = []
    pace: Paces = {}
    spent: defaultdict[tuple[str, str], float] = defaultdict(float)
    longest = QUICK_LONGEST if quick else LONGEST
    allowance = QUICK_ALLOWANCE if quick else ALLOWANCE
    done = 0
    # One family after another over all methods, so that a budget cuts all of them alike, and
    # what is quick before what is long, so that an allowance leaves out the long.
    ordered = sorted((case for mine in listed for case in mine), key=lambda c: (c.family, _size(c)))
    for case in ordered:
        if time.perf_counter() - started > budget:
            break
        part = case.method.name, case.family
        if spent[part] > allowance or _expected(case, pace) > longest:
            outcomes.append(_skipped(case))
        else:
            outcomes.append(judged(case))
            _learn(case, outcomes[-1], pace)
            spent[part] += outcomes[-1].run_time_s
        done += 1
        if progress is not None:
            progress(done, total)
    for method, mine in zip(methods, cells, strict=True):
        if not mine or time.perf_counter() - started > budget:
            continue
        regions.append(region(method, mine, until=started + budget, judged=judged))
        done += len(mine) if regions[-1].complete else 0
        if progress is not None:
            progress(done, total)
    return Stability(outcomes=tuple(outcomes), regions=tuple(regions), complete=done == total)


def _size(case: Case) -> float:
    """Return steps times what a part costs beside a step.

    Where steps are chosen on the way they grow with chi, and as the root of the tolerance.
    """
    options = case.options["integrator"]
    steps: float = float(options.get("steps", 200))
    if "steps" not in options and case.family == "chi":
        steps *= math.pow(1.0 + float(case.scene.make().chi), 0.7)
    steps *= math.sqrt(1e-4 / float(options.get("tolerance", 1e-4)))
    parts = [
        float(value) for name, value in case.options["tangential"].items() if name != "tolerance"
    ]
    return steps * (1.0 + max([0.0, *parts]) ** 2 / 1e4)


def _expected(case: Case, pace: Paces) -> float:
    seen = pace.get(case.method.name)
    pace_now: float = statistics.median(seen) if seen else FIRST_PACE
    return _size(case) * pace_now


def _learn(case: Case, outcome: Outcome, pace: Paces) -> None:
    if outcome.outcome == ANSWERED and outcome.run_time_s > 1e-3:
        pace.setdefault(case.method.name, []).append(outcome.run_time_s / _size(case))


def _skipped(case: Case) -> Outcome:
    return Outcome(
        method=case.method.name,
        family=case.family,
        case=case.label,
        outcome=SKIPPED,
        note="too long",
    )
