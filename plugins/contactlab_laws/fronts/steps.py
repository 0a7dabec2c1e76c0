"""The steps of an impact, by the compiled law or in Python, from which a history is made."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from contactlab.numeric.types import Array
from contactlab_laws.compiled import library
from contactlab_laws.fronts import compiled
from contactlab_laws.fronts.path import Impact
from contactlab_laws.fronts.series import ORDER

#: Error of a step over the accuracy that is asked for, as an impact has some tens of steps.
STEP_PART = 1e-3
#: Most error of a step: forces between its ends, which a history shows, err more than its ends do.
MOST_ERROR = 1e-8


def error_of_step(accuracy: float) -> float:
    """Return the error that a step may have for an accuracy of the answer."""
    return min(max(compiled.LEAST_ERROR, STEP_PART * accuracy), MOST_ERROR)


class Steps(NamedTuple):
    """The entries of ``contactlab_impact_step`` as columns, a row for each step.

    ``series`` are the series of u, V, k, J, c and T, shape (steps, 6, coefficients).
    """

    part: Array
    phase: Array
    sign: Array
    change: Array
    work: Array
    length: Array
    series: Array

    @staticmethod
    def of(rows: Array) -> Steps:
        """Return the steps of rows."""
        part, phase, sign, change, work, length = rows[:, :6].T
        series = rows[:, 6:].reshape(len(rows), 6, rows.shape[1] // 6 - 1)
        return Steps(part, phase, sign, change, work, length, series)

    def take(self, part: slice) -> Steps:
        """Return some of the steps."""
        return Steps(*(column[part] for column in self))

    def at(self, places: Array) -> Array:
        """Return u, V, k, J, c and T at places of each step, shape (6, steps, places)."""
        powers = places[..., None] ** np.arange(self.series.shape[-1])
        return np.asarray(np.einsum("smn,sin->ism", powers, self.series))


def follow_one(numbers: Sequence[float], tolerance: float, most: int) -> tuple[Any, int, Steps]:
    """Return the end of one impact, its status and its steps.

    Parameters
    ----------
    numbers : sequence of float
        psi1, chi, lam and eta.
    tolerance : float
        Error of a step.
    most : int
        Steps by Python's solver after which the impact is given up.
    """
    if library() is not None:
        ends, status, rows = compiled.follow_one(numbers, tolerance)
        if status != compiled.MEMORY:
            return ends, status, Steps.of(rows)
    shown: list[list[float]] = []
    impact = Impact(*numbers, tolerance=tolerance, most=most, shown=shown)
    status = impact.follow()
    # a row has six numbers, and six series of ORDER + 1 coefficients
    return impact.ends(), status, Steps.of(np.reshape(shown, (len(shown), 6 * (ORDER + 2))))
