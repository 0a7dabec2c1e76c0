"""What a fit has to say of the measurement: slips, outliers, patterns, unlikely numbers."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting import outliers, patterns, plausible
from contactlab.fitting.measurements import Measurements
from contactlab.fitting.problem import Problem
from contactlab.fitting.slips import slips, tilted

Array = NDArray[np.float64]

#: Chance with which normal scatter under the right law is told to follow a column.
CHANCE = 1e-3
#: Beside outliers, which explain the residuals better, a pattern is told below this chance.
POSSIBLE = 1e-5


@attrs.frozen(kw_only=True)
class Diagnosis:
    """Sentences on the measurement, and the robust second fit.

    Attributes
    ----------
    slips : tuple of str
        Columns that are met far better if read another way, and numbers that nobody measures.
    others : tuple of str
        Outliers, patterns and leverage; empty if there is a slip, which would explain them.
    robust : list of float or None
        Values of the robust fit; None where there are too few numbers.
    """

    slips: tuple[str, ...]
    others: tuple[str, ...]
    robust: list[float] | list[None]

    @property
    def sentences(self) -> tuple[str, ...]:
        """All sentences."""
        return self.slips + self.others


def diagnosed(problem: Problem, table: Measurements, values: Array) -> Diagnosis:
    """Return what is to be said of a measurement and its fit.

    Parameters
    ----------
    problem : Problem
    table : Measurements
    values : array, shape (parameters,)
        The best values.
    """
    robust: list[float] | list[None] = [None] * len(values)
    far = outliers.none(problem, values)
    if sum(problem.counts.values()) >= outliers.LEAST + len(values) - 1:
        found, scales = outliers.robust(problem, values)
        far, robust = outliers.outliers(problem, found, scales), found.tolist()
    certain, possible = slips(problem, table.given, values, far.rest.measured)
    unlikely = plausible.unlikely_numbers(problem, table)
    slipped = (*certain, *unlikely)
    others = () if slipped else (*_others(problem, table, values, far), *possible)
    return Diagnosis(slips=slipped, others=others, robust=robust)


def _others(
    problem: Problem, table: Measurements, values: Array, far: outliers.Outliers
) -> tuple[str, ...]:
    """Return sentences on outliers, patterns and leverage.

    Parameters
    ----------
    problem : Problem
    table : Measurements
    values : array, shape (parameters,)
    far : Outliers
    """
    chance, tilt = tilted(problem, table.given, values)
    if tilt and chance <= far.chance:
        return (tilt,)
    found: list[str] = []
    scales = problem.scales(problem.residuals(values[None]))
    seen = patterns.pattern(problem, values, scales, table.given)
    if far.places and far.chance <= seen.chance:
        found += outliers.told(problem, far)
        if seen.chance < POSSIBLE:
            found.append(f"or, with every number kept, {seen.words}")
        problem, values = far.rest, far.values
        scales = problem.scales(problem.residuals(values[None]))
        seen = patterns.pattern(problem, values, scales, table.given)
    if seen.chance < CHANCE:
        found.append(seen.words)
    return (*found, *patterns.leverage(problem, values, scales))
