"""Steps of Dormand and Prince's method of order 8, for many systems at once or for one."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from operator import mul
from typing import NamedTuple

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
        values = flat + spread * _sum(weights, slopes)
        slopes[stage] = slope(values.reshape(begin.shape)).reshape(-1)
        if stage == count - 1:
            end = values
    scale = tolerance * (1.0 + np.maximum(np.abs(flat), np.abs(end)))
    fifth, third = (
        np.square(_sum(each, slopes) / scale).reshape(begin.shape).sum(axis=0)
        for each in (tableau.fifth, tableau.third)
    )
    squared = fifth + LOWER * third
    error = width * fifth / np.sqrt(np.where(squared > 0.0, squared, 1.0))
    gained, first, last = end - flat, spread * slopes[0], spread * slopes[count - 1]
    parts = [gained, first - gained, 2.0 * gained - first - last]
    parts += [spread * _sum(weights, slopes) for weights in tableau.dense]
    course = flat + _sum(_basis(points.tobytes()), np.array(parts)[:, None])
    return Attempt(np.where(np.isnan(squared), np.nan, error), course.reshape(-1, *begin.shape))


class Alone:
    """One step of a single autonomous system y' = ``slope(y)``, in plain numbers.

    Parameters
    ----------
    slope : callable
        Takes and returns a number for each value.
    begin, first : sequence of float
        Values and slopes where the step begins.
    width, tolerance : float
        As in ``attempt``.

    Attributes
    ----------
    error : float
        Error over tolerance, accepted up to 1; NaN where a slope was not finite.
    end, last : sequence of float
        Values and slopes where the step ends.
    """

    def __init__(
        self,
        slope: Callable[[Sequence[float]], Sequence[float]],
        begin: Sequence[float],
        first: Sequence[float],
        width: float,
        *,
        tolerance: float,
    ) -> None:
        self.slope, self.begin, self.width = slope, begin, width
        self.slopes = [[each] for each in first]
        self.parts: list[list[float]] = []
        plain = _plain()
        self.end = begin
        for weights in plain.steps:
            self.end = self._stage(weights)
        self.last = [each[-1] for each in self.slopes]
        fifth = third = 0.0
        for begins, ends, slopes in zip(begin, self.end, self.slopes, strict=True):
            scale = tolerance * (1.0 + max(abs(begins), abs(ends)))
            off, less = (sum(map(mul, each, slopes)) / scale for each in (plain.fifth, plain.third))
            fifth, third = fifth + off * off, third + less * less
        squared = fifth + LOWER * third
        self.error = width * fifth / math.sqrt(squared) if squared != 0.0 else 0.0

    def _stage(self, weights: list[float]) -> list[float]:
        """Return the values of a stage, and keep its slopes."""
        values = [
            begins + self.width * sum(map(mul, weights, slopes))
            for begins, slopes in zip(self.begin, self.slopes, strict=True)
        ]
        for slopes, found in zip(self.slopes, self.slope(values), strict=True):
            slopes.append(found)
        return values

    def at(self, place: float) -> list[float]:
        """Return the values at a fraction of the step."""
        if not self.parts:
            self._interpolate()
        rest, values = 1.0 - place, []
        for begins, parts in zip(self.begin, self.parts, strict=True):
            total = 0.0
            for index in range(len(parts) - 1, -1, -1):
                total = (total + parts[index]) * (rest if index % 2 else place)
            values.append(begins + total)
        return values

    def _interpolate(self) -> None:
        """Find the polynomials, by three more stages."""
        plain, width = _plain(), self.width
        last = len(self.slopes[0]) - 1
        for weights in plain.more:
            self._stage(weights)
        for begins, ends, slopes in zip(self.begin, self.end, self.slopes, strict=True):
            gained, start, stop = ends - begins, width * slopes[0], width * slopes[last]
            parts = [gained, start - gained, 2.0 * gained - start - stop]
            parts += [width * sum(map(mul, weights, slopes)) for weights in plain.dense]
            self.parts.append(parts)


class _Plain(NamedTuple):
    """The tableau in plain numbers: stages to the end of a step, and of the polynomial."""

    steps: list[list[float]]
    more: list[list[float]]
    fifth: list[float]
    third: list[float]
    dense: list[list[float]]


@cache
def _plain() -> _Plain:
    """Return the tableau in plain numbers."""
    tableau = _tableau()
    stages = [each.tolist() for each in tableau.stages]
    count = len(tableau.fifth)
    ends = tableau.fifth.tolist(), tableau.third.tolist(), tableau.dense.tolist()
    return _Plain(stages[1:count], stages[count:], *ends)


def _sum(weights: Array, values: Array) -> Array:
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

    method = DOP853
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
