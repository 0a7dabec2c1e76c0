"""Stiff and extreme cases over every law and integrator: errors, refusals, silent wrongs."""

from __future__ import annotations

import contextlib
import math
import time
from collections import Counter
from collections.abc import Callable, Sequence

import attrs
import numpy as np

from contactlab.compose.composition import DEFAULT_NORMAL
from contactlab.contracts.error_model import COARSE
from contactlab.study.bench_methods import Method
from contactlab.study.model_error import ModelError, model_error
from contactlab.study.stability_cases import Case, cases
from contactlab.study.stability_map import INCIDENCES, Region, map_chis, region, region_cells
from contactlab.study.stability_outcome import (
    ANSWERED,
    RAISED,
    SKIPPED,
    WRONG,
    Outcome,
    judge,
)

#: A case of more work than this, in steps of one part, is skipped. Work is not time: which cases
#: are tried does not depend on the machine.
LARGEST, QUICK_LARGEST = 300_000.0, 12_000.0
#: Steps and tolerance assumed in ``work`` where the case sets none.
DEFAULT_STEPS, DEFAULT_TOLERANCE = 200, 1e-4


@attrs.frozen(kw_only=True)
class Stability:
    """Every outcome, the usable region of each method, and the model error of each law.

    Outcomes and regions hold numerical errors, against the law's own exact answer. ``models``
    holds the model errors of laws whose exact answer is not that of the elastic continuum.
    """

    outcomes: tuple[Outcome, ...]
    regions: tuple[Region, ...]
    complete: bool
    models: tuple[ModelError, ...] = ()

    def failures(self) -> list[Outcome]:
        """Return the cases that are silently wrong or raised, the cells of the map included."""
        listed = [item for item in self.outcomes if item.outcome in (WRONG, RAISED)]
        return listed + [item for region in self.regions for item in region.failures]

    def silently_wrong(self) -> int:
        """Return the number of silently wrong answers, the cells of the map included."""
        return sum(item.outcome == WRONG for item in self.failures())

    def tried(self) -> int:
        """Return the number of runs judged, the cells of the map included."""
        done = sum(1 for item in self.outcomes if item.outcome != SKIPPED)
        return done + sum(item.tried for item in self.regions)

    def skipped(self) -> int:
        """Return the number of cases skipped because they are too much work."""
        return sum(item.outcome == SKIPPED for item in self.outcomes)

    def counts(self, method: str) -> Counter[str]:
        """Return the number of cases with each outcome; ``coarse`` is a part of ``ANSWERED``."""
        mine = [item for item in self.outcomes if item.method == method]
        counts = Counter(item.outcome for item in mine)
        counts["coarse"] = sum(item.outcome == ANSWERED and item.bound > COARSE for item in mine)
        return counts

    def worst(self, method: str, family: str) -> float:
        """Return the largest error over the range, of answers that are not coarse; NaN if none."""
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
    """Run every case of every method, and return outcomes, regions and model errors.

    Parameters
    ----------
    methods : sequence of Method
    quick : bool
        Fewer scenes and resolutions, without the long ones.
    budget : float
        Seconds after which no further case is begun; ``complete`` then is False.
    progress : callable, optional
        Called as ``progress(done, total)``.
    judged : callable
        Runs one case and returns its outcome, for the map too.
    """
    started = time.perf_counter()
    listed = [list(cases(method, quick=quick)) for method in methods]
    cells = [region_cells(method, quick=quick) for method in methods]
    elastic = [method for method in methods if method.normal == DEFAULT_NORMAL]
    laws = list(dict.fromkeys(method.tangential for method in elastic))
    total = sum(map(len, listed)) + sum(map(len, cells)) + len(laws)
    outcomes: list[Outcome] = []
    regions: list[Region] = []
    models: list[ModelError] = []
    largest = QUICK_LARGEST if quick else LARGEST
    done = 0
    # A budget cuts all methods alike: family by family, and within a family by work.
    ordered = sorted((case for mine in listed for case in mine), key=lambda c: (c.family, work(c)))
    for case in ordered:
        if time.perf_counter() - started > budget:
            break
        outcomes.append(judged(case) if work(case) <= largest else _skipped(case))
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
    for law in laws:  # after the map, which has cached the costly exact answers
        if time.perf_counter() - started > budget:
            break
        model = model_error(law, map_chis(quick=quick), INCIDENCES)
        models += [] if model is None else [model]
        done += 1
        if progress is not None:
            progress(done, total)
    return Stability(
        outcomes=tuple(outcomes),
        regions=tuple(regions),
        models=tuple(models),
        complete=done == total,
    )


def work(case: Case) -> float:
    """Return an estimate of the work of a case, in steps of one part.

    Under a tolerance the number of steps grows with the root of chi, and falls with the root of
    the tolerance.
    """
    options = case.options["integrator"]
    steps = float(options.get("steps", DEFAULT_STEPS))
    if "steps" not in options:
        tolerance = float(options.get("tolerance", DEFAULT_TOLERANCE))
        with contextlib.suppress(ValueError):  # a refused scene is an outcome
            steps *= math.sqrt(1.0 + min(float(np.max(case.scene.make().chi)), 1e12))
        steps *= math.sqrt(DEFAULT_TOLERANCE / tolerance)
    parts = [
        float(value) for name, value in case.options["tangential"].items() if name != "tolerance"
    ]
    return steps * (1.0 + max([0.0, *parts]) ** 2 / 1e4)


def _skipped(case: Case) -> Outcome:
    return Outcome(
        method=case.method.name,
        family=case.family,
        case=case.label,
        outcome=SKIPPED,
        note="too much work",
    )
