"""Intervals by the bootstrap: fits of data made of the best fit and its own residuals."""

from __future__ import annotations

import math
from collections.abc import Callable

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.problem import Problem, solved

Array = NDArray[np.float64]

#: An interruption keeps at least this many samples; fewer make no 95 % interval.
FEWEST = 100


def bootstrapped(
    problem: Problem,
    values: Array,
    samples: int,
    *,
    seed: int,
    tail: float,
    progress: Callable[[int, int], object] | None = None,
) -> tuple[list[tuple[float, float]], int]:
    """Return the interval of each parameter, in its unit, and the number of samples.

    The intervals lie between quantiles of the samples: ``tail`` is the share on either side. An
    interruption (Ctrl-C) keeps the finished samples if there are at least ``FEWEST``.

    Notes
    -----
    The wild bootstrap: residuals, widened by sqrt(n/(n - p)), are added to the prediction, with
    one random sign for all quantities of an impact. Each impact so keeps its own scatter, and
    the quantities of an impact stay correlated: Wu, Ann. Statist. 14
    (1986) 1261-1295, doi:10.1214/aos/1176350142.
    """
    generator = np.random.default_rng(seed)
    residuals = {name: rows[0] for name, rows in problem.residuals(values[None]).items()}
    scales = problem.scales(residuals)
    numbers = sum(problem.counts.values())
    wider = math.sqrt(numbers / max(numbers - len(values), 1))
    drawn: list[Array] = []
    try:
        while len(drawn) < samples:
            signs = wider * generator.choice([-1.0, 1.0], len(residuals[next(iter(residuals))]))
            measured = {
                name: numbers_measured + (signs - 1.0) * residuals[name]
                for name, numbers_measured in problem.measured.items()
            }
            drawn.append(solved(attrs.evolve(problem, measured=measured), values, scales))
            if progress is not None:
                progress(len(drawn), samples)
    except KeyboardInterrupt:
        if len(drawn) < FEWEST:
            raise
    ends = np.quantile(np.array(drawn), [tail, 1.0 - tail], axis=0)
    return [(float(low), float(high)) for low, high in ends.T], len(drawn)
