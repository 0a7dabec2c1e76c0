"""Predictions near the best values of a fit: polynomials of second order in the parameters."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import attrs
import numpy as np

from contactlab.numeric.types import Array, Real
from contactlab_fit.model import Model
from contactlab_fit.problem import Problem

#: Distance from the best values, in standard errors, of the points that make a polynomial: a 95 %
#: interval ends at two.
REACH = 2.5
#: Largest error of a value by polynomials, over the half-width of the interval of its samples.
OFF = 0.05


@attrs.frozen(kw_only=True, eq=False)
class Nearby(Model):
    """A model whose quantities are polynomials, for values near those of a fit.

    Attributes
    ----------
    centre : array, shape (parameters,)
        The best values.
    axes : array, shape (parameters, parameters)
        A square root of the covariance: lengths along its columns are in standard errors.
    coefficients : mapping of str to array, shape (terms, n)
    """

    centre: Array
    axes: Array
    coefficients: Mapping[str, Array]

    def predict(self, points: Array, quantities: Sequence[str]) -> dict[str, Array]:
        """Return quantities of all impacts, shape (m, n), at points of shape (m, parameters)."""
        terms = _terms(_offsets(self.axes, points - self.centre))
        return {name: terms @ self.coefficients[name] for name in quantities}


def nearby(problem: Problem, values: Array, scales: Mapping[str, Real]) -> Problem:
    """Return the problem with polynomials about the best values in place of its laws."""
    weighted, slopes = problem.linearise(values, scales)
    square = float(weighted @ weighted) / max(len(weighted) - len(values), 1)
    axes = np.linalg.cholesky(square * np.linalg.inv(slopes.T @ slopes))
    low, high = problem.bounds()
    points = np.clip(values + REACH * _design(len(values)) @ axes.T, low, high)
    terms, model = _terms(_offsets(axes, points - values)), problem.model
    coefficients = {
        name: np.asarray(np.linalg.lstsq(terms, rows, rcond=None)[0])
        for name, rows in model.predict(points, list(problem.measured)).items()
    }
    near = Nearby(
        setup=model.setup,
        parameters=model.parameters,
        centre=values,
        axes=axes,
        coefficients=coefficients,
    )
    return attrs.evolve(problem, model=near)


def faithful(
    problem: Problem, near: Problem, samples: Array, ends: Array, scales: Mapping[str, Real]
) -> bool:
    """Return whether samples, shape (m, parameters), by polynomials are those of the laws.

    The laws run at the samples next to the ``ends`` of each interval, shape (2, parameters).
    The first step of a search from there tells how far the sample is off.
    """
    places = {
        int(np.argmin(np.abs(samples[:, k] - end))) for row in ends for k, end in enumerate(row)
    }
    points = samples[sorted(places)]
    gaps = problem.weigh(points, scales) - near.weigh(points, scales)
    _, slopes = near.linearise(np.mean(ends, axis=0), scales)
    moves = gaps @ np.linalg.pinv(slopes).T
    return bool(np.all(np.abs(moves) <= OFF * 0.5 * (ends[1] - ends[0])))


def _design(count: int) -> Array:
    """Return points within 1 along each axis that determine a polynomial of second order."""
    axes = np.concatenate((np.zeros((1, count)), np.eye(count), -np.eye(count)))
    pairs = [
        first * np.eye(count)[i] + second * np.eye(count)[j]
        for i, j in itertools.combinations(range(count), 2)
        for first, second in itertools.product((-1.0, 1.0), repeat=2)
    ]
    return np.concatenate((axes, np.sqrt(0.5) * np.reshape(pairs, (-1, count))))


def _offsets(axes: Array, offsets: Array) -> Array:
    """Return offsets of points, shape (m, parameters), in standard errors along the axes."""
    return np.asarray(np.linalg.solve(axes, offsets.T).T)


def _terms(z: Array) -> Array:
    """Return 1, the coordinates and their products in pairs, shape (m, terms)."""
    first, second = np.triu_indices(z.shape[1])
    return np.hstack((np.ones((len(z), 1)), z, z[:, first] * z[:, second]))
