"""Steps of Dormand and Prince's method of order 8, for many systems at once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Share of the error of order 3 in the error of a step (Hairer, Nørsett & Wanner, §II.10).
LOWER = 0.01


class Tableau(NamedTuple):
    """Coefficients: stages, weights, two error estimates, and what a polynomial is made of."""

    stages: list[Array]
    fifth: Array
    third: Array
    dense: Array


class Attempt(NamedTuple):
    """A step of every system.

    Attributes
    ----------
    error : array, shape (systems,)
        Over the tolerance: at most 1 is good enough; NaN where a slope was not finite.
    course : array, shape (P, n, systems)
        The values at the points asked for.
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
    """Return one step of autonomous systems y' = f(y), each of its own width.

    Parameters
    ----------
    slope : callable
        Returns f of values, shape (n, systems), in the same shape.
    begin : array, shape (n, systems)
        Values at the start of the step.
    width : array, shape (systems,)
    tolerance : float
        Of the error over 1 + abs(y), summed over the n values in quadrature.
    points : array, shape (P,)
        Fractions of the step.
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
    both = fifth + LOWER * third
    error = width * fifth / np.sqrt(np.where(both > 0.0, both, 1.0))
    gained, first, last = end - flat, spread * slopes[0], spread * slopes[count - 1]
    parts = [gained, first - gained, 2.0 * gained - first - last]
    parts += [spread * _summed(weights, slopes) for weights in tableau.dense]
    course = flat + _summed(_basis(points.tobytes()), np.array(parts)[:, None])
    return Attempt(np.where(np.isnan(both), np.nan, error), course.reshape(-1, *begin.shape))


def _summed(weights: Array, values: Array) -> Array:
    """Return the weighted sum along the first axis.

    Added up in the same order however many systems there are: a product of matrices is not, and
    the steps of a system would depend on the last bits of what stands beside it.
    """
    weights = weights.reshape(weights.shape + (1,) * (values.ndim - weights.ndim))
    return np.asarray((weights * values[: len(weights)]).sum(axis=0))


@cache
def _tableau() -> Tableau:
    """Return the coefficients: stages of the step, its end, and three more for the polynomial."""
    from scipy.integrate import DOP853  # not before a law without closed form is met

    method: Any = DOP853
    inner = [np.array(row[:stage]) for stage, row in enumerate(method.A)]
    more = [np.array(row[: len(inner) + 1 + k]) for k, row in enumerate(method.A_EXTRA)]
    stages = [*inner, np.array(method.B), *more]
    return Tableau(stages, np.array(method.E5), np.array(method.E3), np.array(method.D))


@cache
def _basis(points: bytes) -> Array:
    """Return the seven polynomials of the method's interpolant at points, shape (7, P, 1)."""
    x = np.frombuffer(points)
    left, right = x, 1.0 - x
    columns = [left]
    for degree in range(6):
        columns.append(columns[-1] * (right if degree % 2 == 0 else left))
    return np.stack(columns)[..., None]
