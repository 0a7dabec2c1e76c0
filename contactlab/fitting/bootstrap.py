"""Intervals by the bootstrap: the fit again, of data made of the fit and its own residuals."""

from __future__ import annotations

import math
from collections.abc import Callable

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.problem import Problem, solved

Array = NDArray[np.float64]

#: Samples from which an interruption keeps them: of fewer, a 95 % interval is two of them.
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
    """Return an interval for each parameter, between quantiles of the samples, and their number.

    Interrupting (Ctrl-C) keeps the samples that are done if they are enough.

    Parameters
    ----------
    problem : Problem
    values : array, shape (parameters,)
        The best values.
    samples : int
    seed : int
        Of the random numbers: the same intervals each time.
    tail : float
        Share of the samples on either side.
    progress : callable, optional
        Called as ``progress(done, samples)``.

    Notes
    -----
    The residuals of each impact, widened by sqrt(n/(n - p)), are added to what the fit predicts
    with a sign drawn at random (the wild bootstrap). Impacts stay as they are, a larger scatter
    of some stays theirs, and quantities of one impact stay correlated: Wu, Ann. Statist. 14
    (1986) 1261-1295, doi:10.1214/aos/1176350142.
    """
    generator = np.random.default_rng(seed)
    residuals = {name: rows[0] for name, rows in problem.residuals(values[None]).items()}
    scales = problem.scales(residuals)
    numbers = sum(problem.counts.values())
    wider = math.sqrt(numbers / max(numbers - len(values), 1))
    found: list[Array] = []
    try:
        while len(found) < samples:
            signs = wider * generator.choice([-1.0, 1.0], len(residuals[next(iter(residuals))]))
            measured = {
                name: numbers_measured + (signs - 1.0) * residuals[name]
                for name, numbers_measured in problem.measured.items()
            }
            found.append(solved(attrs.evolve(problem, measured=measured), values, scales))
            if progress is not None:
                progress(len(found), samples)
    except KeyboardInterrupt:
        if len(found) < FEWEST:
            raise
    ends = np.quantile(np.array(found), [tail, 1.0 - tail], axis=0)
    return [(float(low), float(high)) for low, high in ends.T], len(found)
