"""Intervals of fitted parameters: from the covariance, or profiles where the surface bends."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import attrs
import numpy as np

from contactlab.numeric.types import Array, Real
from contactlab_fit.problem import Problem, minimum

#: Share of each tail beyond a 95 % interval.
TAIL = 0.025
#: The sum of squares grows by t² to the ends of an interval where predictions are lines; where it
#: grows by less or more than these shares of t² the surface bends.
BENT = (0.5, 2.0)
#: Mean weighted square of residuals below which they are numerical error, and tell no scatter.
EXACT = 1e-3
#: Steps of a profile on its way outwards: this share of the value, and most steps.
SHARE, STEPS = 0.03, 100
#: Relative error of the end of a profile.
TOLERANCE = 1e-4


class Spread(NamedTuple):
    """Covariance of the parameters, their standard errors, and their intervals.

    ``reaches`` are half-widths, ``low`` and ``high`` the ends within the bounds.
    ``mean_square`` is the sum of squares over the degrees of freedom, and ``rise`` the growth of
    the sum up to which the F test does not part other values; NaN without degrees of freedom.
    """

    covariance: Array
    errors: Array
    reaches: Array
    low: Array
    high: Array
    mean_square: float
    rise: float

    def holds(self, values: Array) -> bool:
        """Return whether all values lie in their intervals."""
        return bool(np.all((self.low <= values) & (values <= self.high)))


def spread(problem: Problem, values: Array, first: Array | None = None) -> Spread:
    """Return the spread of parameters about a minimum.

    Parameters
    ----------
    problem : Problem
    values : array, shape (parameters,)
        The minimum.
    first : array, shape (parameters,), optional
        The best minimum, if ``values`` are another one: its scatter is that of the data.

    Notes
    -----
    Where predictions are no lines between the ends of an interval, as where e_t over friction
    turns, its ends are those of the profile: the sum of squares, least over the other parameters,
    has grown by t² times the mean square, as the F test of one parameter has it. Bates & Watts,
    Nonlinear Regression Analysis (1988), section 6.1.
    """
    from scipy.special import stdtrit  # only a fit needs scipy

    best = values if first is None else first
    scales = problem.scales(problem.residuals(best[None]))
    weighted, jacobian = problem.linearise(values, scales)
    square = float(weighted @ weighted)
    if first is not None:
        square = float(np.sum(problem.weigh(first[None], scales) ** 2))
    freedom = len(weighted) - len(values)
    mean_square = square / freedom if freedom > 0 else math.nan
    stated = all(name in problem.errors for name in problem.measured)
    factor = mean_square
    if stated:  # stated errors may be too small; they never count as too large
        factor = max(mean_square, 1.0) if freedom else 1.0
    size = np.sqrt(np.sum(jacobian**2, axis=0))
    covariance = np.linalg.inv((jacobian / size).T @ (jacobian / size)) / np.outer(size, size)
    errors = np.sqrt(factor * np.diag(covariance))
    student = float(stdtrit(freedom, 1.0 - TAIL)) if freedom > 0 else math.nan
    least, most = problem.bounds()
    reaches = errors * student
    low, high = np.maximum(values - reaches, least), np.minimum(values + reaches, most)
    rise = factor * student**2
    if freedom > 0 and mean_square > EXACT and problem.model.at_once(list(problem.measured)):
        for place in _find_bends(problem, values, scales, covariance, rise):
            low[place], high[place] = _profile(problem, values, place, scales, square + rise)
            reaches[place] = 0.5 * (high[place] - low[place])
            errors[place] = reaches[place] / student
    return Spread(covariance, errors, reaches, low, high, mean_square, max(rise, student**2))


def _find_bends(
    problem: Problem, values: Array, scales: Mapping[str, Real], covariance: Array, rise: float
) -> list[int]:
    """Return the places of parameters at whose ends the sum of squares has not grown by ``rise``.

    The ends lie where the other parameters follow, by the covariance.
    """
    low, high = problem.bounds()
    count = len(values)
    reaches = np.sqrt(rise * np.diag(covariance))
    moves = (covariance / np.sqrt(np.diag(covariance))).T * math.sqrt(rise)
    points = np.clip(np.concatenate([values + moves, values - moves]), low, high)
    squares = np.sum(problem.weigh(np.vstack([values, points]), scales) ** 2, axis=1)
    grown = (squares[1:] - squares[0]).reshape(2, count)
    shares = np.abs(np.diagonal((points - values).reshape(2, count, count), axis1=1, axis2=2))
    expected = rise * (shares / reaches) ** 2
    bent = (grown < BENT[0] * expected) | (grown > BENT[1] * expected)
    return np.flatnonzero(np.any(bent & (expected > 0.0), axis=0)).tolist()


def _profile(
    problem: Problem, values: Array, place: int, scales: Mapping[str, Real], square: float
) -> tuple[float, float]:
    """Return the ends of the values of a parameter about a minimum with less than a square."""
    from scipy.optimize import brentq  # only a fit needs scipy

    least, most = (float(end[place]) for end in problem.bounds())
    value = float(values[place])
    step = SHARE * (abs(value) or 1.0)
    latest = values

    def excess(x: float) -> float:
        """Return the least square with the parameter at x, less the square."""
        nonlocal latest
        latest = _with_parameter(problem, latest, place, x, scales)
        return float(np.sum(problem.weigh(latest[None], scales) ** 2)) - square

    def end(sign: float, bound: float) -> float:
        """Return the first value outwards at which the square is reached."""
        nonlocal latest
        inside, latest = value, values
        for _ in range(STEPS):
            outside = inside + sign * step
            if (outside - bound) * sign >= 0.0:
                outside = bound
            if excess(outside) > 0.0:
                if excess(inside) >= 0.0:  # numbers without scatter: rounding alone
                    return inside
                return float(brentq(excess, inside, outside, rtol=TOLERANCE))
            if outside == bound:
                break
            inside = outside
        return inside if outside != bound else bound

    if excess(value) >= 0.0:
        return value, value
    return end(-1.0, least), end(1.0, most)


def _with_parameter(
    problem: Problem, values: Array, place: int, x: float, scales: Mapping[str, Real]
) -> Array:
    """Return the best values with one parameter at x."""
    at = values.copy()
    at[place] = x
    if len(values) == 1:
        return at
    model = problem.model
    rest = [k for k in range(len(values)) if k != place]
    fixed = attrs.evolve(
        model,
        setup=model.parameters[place].apply(model.setup, x),
        parameters=tuple(model.parameters[k] for k in rest),
    )
    at[rest] = minimum(attrs.evolve(problem, model=fixed), values[rest], scales)
    return at
