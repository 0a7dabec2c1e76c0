"""Diagnosis of a measurement by its fit: slips, outliers, patterns, unlikely numbers."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting import outliers, patterns, plausible
from contactlab.fitting.measurements import Measurements
from contactlab.fitting.problem import Problem
from contactlab.fitting.slips import slips, tilted

Array = NDArray[np.float64]

#: A pattern is reported if normal scatter under the right law makes it with less than this chance.
CHANCE = 1e-3
#: The same limit beside outliers, which explain the residuals better.
POSSIBLE = 1e-5


@attrs.frozen(kw_only=True)
class Diagnosis:
    """Sentences on the measurement, and the robust second fit.

    Attributes
    ----------
    slips : tuple of str
        Columns that a fit meets far better if read another way, and implausible numbers.
    others : tuple of str
        Outliers, patterns and leverage; empty after a slip, which would explain them.
    robust : list of float or None
        Values of the robust fit; None for too few numbers.
    """

    slips: tuple[str, ...]
    others: tuple[str, ...]
    robust: list[float] | list[None]

    @property
    def sentences(self) -> tuple[str, ...]:
        """Sentences of ``slips``, then of ``others``."""
        return self.slips + self.others


def diagnosed(problem: Problem, table: Measurements, values: Array) -> Diagnosis:
    """Return the diagnosis of a measurement at the best values, shape (parameters,)."""
    robust: list[float] | list[None] = [None] * len(values)
    far = outliers.none(problem, values)
    if sum(problem.counts.values()) >= outliers.LEAST + len(values) - 1:
        robust_values, scales = outliers.robust(problem, values)
        far, robust = outliers.outliers(problem, robust_values, scales), robust_values.tolist()
    certain, possible = slips(problem, table.given, values, far.rest.measured)
    unlikely = plausible.unlikely_numbers(problem, table)
    slipped = (*certain, *unlikely)
    others = () if slipped else (*_others(problem, table, values, far), *possible)
    return Diagnosis(slips=slipped, others=others, robust=robust)


def _others(
    problem: Problem, table: Measurements, values: Array, far: outliers.Outliers
) -> tuple[str, ...]:
    """Return sentences on outliers, patterns and leverage."""
    chance, tilt = tilted(problem, table.given, values)
    if tilt and chance <= far.chance:
        return (tilt,)
    sentences: list[str] = []
    scales = problem.scales(problem.residuals(values[None]))
    seen = patterns.pattern(problem, values, scales, table.given)
    if far.places and far.chance <= seen.chance:
        sentences += outliers.described(problem, far)
        if seen.chance < POSSIBLE:
            sentences.append(f"or, with every number kept, {seen.words}")
        problem, values = far.rest, far.values
        scales = problem.scales(problem.residuals(values[None]))
        seen = patterns.pattern(problem, values, scales, table.given)
    if seen.chance < CHANCE:
        sentences.append(seen.words)
    return (*sentences, *patterns.leverage(problem, values, scales))
