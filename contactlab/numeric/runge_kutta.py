"""Steps of Dormand and Prince's method of order 8, for many systems at once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from contactlab.numeric.types import Array

#: Weight of the third-order error in the error of a step (Hairer, Nørsett & Wanner, §II.10).
LOWER = 0.01


class Tableau(NamedTuple):
    """Coefficients of the stages, of two error estimates, and of the interpolating polynomial."""

    stages: list[Array]
    fifth: Array
    third: Array
    dense: Array


class Attempt(NamedTuple):
    """One step of every system.

    Attributes
    ----------
    error : array, shape (systems,)
        Error over tolerance, accepted up to 1; NaN where a slope was not finite.
    course : array, shape (P, n, systems)
        Values at the requested points of the step.
    """

    error: Array
    course: Array


def attempt(
    slope: Callable[[Array], Array],
    begin: Array,
    width: Array,
    *,
    tolerance: float,
    points: Array,
) -> Attempt:
    """Return one step of autonomous systems y' = ``slope(y)``, y of shape (n, systems).

    ``width`` has one step width per system, ``points`` are fractions of the step, ``tolerance``
    bounds the error over 1 + abs(y), summed over the n values in quadrature.
    """
    tableau = _tableau()
    count = len(tableau.fifth)
    slopes = np.empty((len(tableau.stages), begin.size))
    flat = begin.reshape(-1)
    spread = np.broadcast_to(width, begin.shape).reshape(-1)
    end = flat
    for stage, weights in enumerate(tableau.stages):
        values = flat + spread * _summed(weights, slopes)
        slopes[stage] = slope(values.reshape(begin.shape)).reshape(-1)
        if stage == count - 1:
            end = values
    scale = tolerance * (1.0 + np.maximum(np.abs(flat), np.abs(end)))
    fifth, third = (
        np.square(_summed(each, slopes) / scale).reshape(begin.shape).sum(axis=0)
        for each in (tableau.fifth, tableau.third)
    )
    squared = fifth + LOWER * third
    error = width * fifth / np.sqrt(np.where(squared > 0.0, squared, 1.0))
    gained, first, last = end - flat, spread * slopes[0], spread * slopes[count - 1]
    parts = [gained, first - gained, 2.0 * gained - first - last]
    parts += [spread * _summed(weights, slopes) for weights in tableau.dense]
    course = flat + _summed(_basis(points.tobytes()), np.array(parts)[:, None])
    return Attempt(np.where(np.isnan(squared), np.nan, error), course.reshape(-1, *begin.shape))


def _summed(weights: Array, values: Array) -> Array:
    """Return the weighted sum along the first axis.

    The order of summation does not depend on the number of systems. In a product of matrices the
    order does depend on that number, so last bits would differ between batches.
    """
    weights = weights.reshape(weights.shape + (1,) * (values.ndim - weights.ndim))
    return np.asarray((weights * values[: len(weights)]).sum(axis=0))


@cache
def _tableau() -> Tableau:
    """Return scipy's coefficients: stages, end of the step, and three stages for the polynomial."""
    from scipy.integrate import DOP853  # only laws without closed form need scipy

    method: Any = DOP853
    inner = [np.array(row[:stage]) for stage, row in enumerate(method.A)]
    more = [np.array(row[: len(inner) + 1 + k]) for k, row in enumerate(method.A_EXTRA)]
    stages = [*inner, np.array(method.B), *more]
    return Tableau(stages, np.array(method.E5), np.array(method.E3), np.array(method.D))


@cache
def _basis(points: bytes) -> Array:
    """Return the interpolant's seven polynomials at ``points``, shape (7, P, 1)."""
    x = np.frombuffer(points)
    left, right = x, 1.0 - x
    columns = [left]
    for degree in range(6):
        columns.append(columns[-1] * (right if degree % 2 == 0 else left))
    return np.stack(columns)[..., None]
