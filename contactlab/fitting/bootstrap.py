"""Intervals by the bootstrap: the fit again, of data made of the fit and its own residuals."""

from __future__ import annotations

import math
from collections.abc import Callable

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.problem import Problem, solved

Array = NDArray[np.float64]


def bootstrapped(
    problem: Problem,
    values: Array,
    samples: int,
    *,
    seed: int,
    tail: float,
    progress: Callable[[int, int], object] | None = None,
) -> list[tuple[float, float]]:
    """Return an interval for each parameter, between quantiles of the samples.

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
    numbers = sum(problem.counts.values())
    wider = math.sqrt(numbers / max(numbers - len(values), 1))
    found = np.empty((samples, len(values)))
    for sample in range(samples):
        signs = wider * generator.choice([-1.0, 1.0], len(residuals[next(iter(residuals))]))
        measured = {
            name: numbers_measured + (signs - 1.0) * residuals[name]
            for name, numbers_measured in problem.measured.items()
        }
        found[sample] = solved(attrs.evolve(problem, measured=measured), values)
        if progress is not None:
            progress(sample + 1, samples)
    ends = np.quantile(found, [tail, 1.0 - tail], axis=0)
    return [(float(low), float(high)) for low, high in ends.T]
