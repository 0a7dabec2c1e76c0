"""Least squares: measured less predicted, over the error of each quantity."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

import attrs
import numpy as np

from contactlab.numeric.types import Array, Real
from contactlab_fit.model import Model
from contactlab_fit.parameters import Parameter

Loss = Literal["linear", "soft_l1"]

#: Step of a derivative over the size of the parameter: the table of psi2 is good to 1e-9, steps
#: of an integrator make answers uneven by less than that, and the third derivative costs 1e-6.
STEP = 1e-3
#: Relative tolerance of a parameter: far below any scatter, far above the error of the table.
TOLERANCE = 1e-6
#: Relative tolerance of a robust fit, which only serves comparison.
ROUGHLY = 1e-4
#: Most points of the grid of starts, and most searches.
GRID, SEARCHES = 400, 4
#: Most rounds that re-estimate the errors of quantities from residuals, and relative change of
#: the errors that ends the rounds.
ROUNDS, STEADY = 6, 0.02
#: Rows of a long table that are searched first, and for mistakes: they suffice to see mistakes far
#: smaller than any that is told.
MANY = 20_000
#: Rows in a block of a long table's sample, so that most rows keep their neighbours.
BLOCK = 100
#: Least error of a quantity over its size: data made by the model itself have no error.
LEAST_ERROR = 1e-9


@attrs.frozen(kw_only=True, eq=False)
class Problem:
    """A model and the measured numbers to meet.

    Attributes
    ----------
    model : Model
    measured : mapping of str to array, shape (n,)
        NaN where not measured.
    errors : mapping of str to array, shape (n,)
        Stated standard errors.
    """

    model: Model
    measured: Mapping[str, Array]
    errors: Mapping[str, Array]

    @property
    def counts(self) -> dict[str, int]:
        """Count of measured numbers, by quantity."""
        return {name: int(np.isfinite(v).sum()) for name, v in self.measured.items()}

    def by_quantity(self, numbers: Array) -> dict[str, Array]:
        """Return the rows of ``numbers``, shape (numbers, ...), of each quantity."""
        ends = np.cumsum(list(self.counts.values()))[:-1]
        return dict(zip(self.measured, np.split(numbers, ends), strict=True))

    def residuals(self, points: Array) -> dict[str, Array]:
        """Return measured less predicted, shape (m, n) by quantity, at points (m, parameters)."""
        predicted = self.model.predict(points, list(self.measured))
        return {name: values - predicted[name] for name, values in self.measured.items()}

    def weigh(self, points: Array, scales: Mapping[str, Real]) -> Array:
        """Return residuals over errors, shape (m, numbers), by quantity, without gaps."""
        return self._over(self.residuals(points), scales)

    def _over(self, residuals: Mapping[str, Array], scales: Mapping[str, Real]) -> Array:
        """Return residuals over errors, shape (m, numbers)."""
        present = {name: np.isfinite(values) for name, values in self.measured.items()}
        parts = [(residuals[name] / scales[name])[:, present[name]] for name in residuals]
        return np.concatenate(parts, axis=1)

    def sizes(self) -> dict[str, float]:
        """Return the greatest magnitude of each quantity, 1 if zero."""
        return {name: float(np.nanmax(np.abs(v))) or 1.0 for name, v in self.measured.items()}

    def scales(self, residuals: Mapping[str, Array] | None = None) -> dict[str, Real]:
        """Return the error of each quantity: stated, or else the rms of its residuals.

        Without residuals the rms spread of the measured values is returned.
        """
        scales: dict[str, Real] = {}
        for name, measured in self.measured.items():
            if name in self.errors:
                scales[name] = self.errors[name]
                continue
            least = LEAST_ERROR * self.sizes()[name]
            off = measured - np.nanmean(measured) if residuals is None else residuals[name]
            scales[name] = max(float(np.sqrt(np.nanmean(off**2))), least)
        return scales

    def bounds(self) -> tuple[Array, Array]:
        """Return the lower and the upper ends of the parameters, shape (parameters,) each."""
        ends = [(parameter.least, parameter.most) for parameter in self.model.parameters]
        return np.array([low for low, _ in ends]), np.array([high for _, high in ends])

    def criterion(self, values: Array) -> float:
        """Return Akaike's criterion, up to a constant: -2 log likelihood + 2 parameters."""
        residuals = self.residuals(values[None])
        scales = self.scales(residuals)
        weighted = self._over(residuals, scales)[0]
        unknown = [name for name in self.measured if name not in self.errors]
        logs = sum(2.0 * self.counts[name] * math.log(scales[name]) for name in unknown)
        return float(weighted @ weighted) + logs + 2.0 * (len(values) + len(unknown))

    def linearise(self, values: Array, scales: Mapping[str, Real]) -> tuple[Array, Array]:
        """Return weighted residuals, shape (numbers,), and their derivatives by the parameters.

        The derivatives, shape (numbers, parameters), are central differences inside the bounds,
        from one batch of impacts.
        """
        count = len(values)
        low, high = self.bounds()
        steps = STEP * np.array([abs(v) or 1.0 for v in values.tolist()])
        below = np.maximum(values - steps, low)
        above = np.minimum(values + steps, high)
        points = np.tile(values, (1 + 2 * count, 1))
        points[1 : 1 + count][np.diag_indices(count)] = below
        points[1 + count :][np.diag_indices(count)] = above
        weighted = self.weigh(points, scales)
        slopes = (weighted[1 + count :] - weighted[1 : 1 + count]).T / (above - below)
        return weighted[0], slopes


def fewer(problem: Problem, *tables: Mapping[str, Array]) -> tuple[Problem, list[dict[str, Array]]]:
    """Return a problem, and columns of its rows, with ``MANY`` rows where there are more.

    The rows are blocks of neighbours, evenly from the whole table.
    """
    count = len(next(iter(problem.measured.values())))
    if count <= MANY:
        return problem, [dict(table) for table in tables]
    first = np.linspace(0, count - BLOCK, MANY // BLOCK).astype(int)
    rows = (first[:, None] + np.arange(BLOCK)).ravel()
    parts = [
        {name: values[rows] for name, values in table.items()}
        for table in (problem.measured, problem.errors, *tables)
    ]
    model = problem.model.at(problem.model.setup.scene.take(rows))
    return Problem(model=model, measured=parts[0], errors=parts[1]), parts[2:]


def starting(problem: Problem) -> list[Array]:
    """Return the starts of searches: local minima of the cost on a grid, the best first.

    Several starts are needed: a quantity often has the same value at two friction coefficients,
    and a search ends in the nearest minimum.
    """
    points = _points(problem.model.parameters)
    weighted = problem.weigh(grid(problem.model.parameters), problem.scales())
    costs = np.sum(weighted**2, axis=1).reshape(points.shape[:-1])
    least = np.ones(costs.shape, dtype=bool)
    for axis in range(costs.ndim):
        ends = [(1, 1) if padded == axis else (0, 0) for padded in range(costs.ndim)]
        steps = np.diff(np.pad(costs, ends, constant_values=np.inf), axis=axis)
        count = costs.shape[axis]
        least &= np.take(steps, range(count), axis) < 0.0
        least &= np.take(steps, range(1, count + 1), axis) >= 0.0
    least.flat[int(np.argmin(costs))] = True  # also if all costs are equal
    order = np.argsort(costs[least], kind="stable")[:SEARCHES]
    return list(points[least][order])


def grid(parameters: tuple[Parameter, ...]) -> Array:
    """Return the grid of candidate starts, shape (m, parameters)."""
    return _points(parameters).reshape(-1, len(parameters))


def _points(parameters: tuple[Parameter, ...]) -> Array:
    """Return the grid of starts: an axis for each parameter, then an axis of their values."""
    most = int(GRID ** (1.0 / len(parameters)) + 1e-9)
    axes = [_some(sorted(set(parameter.starts)), most) for parameter in parameters]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def _some(starts: list[float], most: int) -> Array:
    """Return at most ``most`` starts, evenly chosen, with both ends."""
    places = np.linspace(0, len(starts) - 1, min(len(starts), max(most, 2)))
    return np.array([starts[place] for place in sorted(set(places.round().astype(int).tolist()))])


def solve_problem(
    problem: Problem, start: Array, scales: Mapping[str, Real] | None = None
) -> Array:
    """Return the best values of the parameters, shape (parameters,).

    Quantities without stated errors are weighted by their own residuals in rounds that begin with
    ``scales``: the maximum of likelihood.
    """
    unknown = [name for name in problem.measured if name not in problem.errors]
    scales = problem.scales() if scales is None else scales
    values = minimum(problem, start, scales)
    if len(problem.measured) == 1 or not unknown:
        return values  # weights would not change the minimum
    for _ in range(ROUNDS):
        before, scales = scales, problem.scales(problem.residuals(values[None]))
        values = minimum(problem, values, scales)
        if all(np.allclose(scales[name], before[name], rtol=STEADY, atol=0.0) for name in unknown):
            break
    return values


def minimum(
    problem: Problem, start: Array, scales: Mapping[str, Real], *, loss: Loss = "linear"
) -> Array:
    """Return the values, shape (parameters,), at the least sum of a loss of residuals."""
    from scipy.optimize import least_squares  # only a fit needs scipy

    latest: dict[bytes, tuple[Array, Array]] = {}

    def linearise(values: Array) -> tuple[Array, Array]:
        """Return residuals and derivatives; the search requests them in turn at one point."""
        key = values.tobytes()
        if key not in latest:
            latest.clear()
            latest[key] = problem.linearise(values, scales)
        return latest[key]

    def residuals(values: Array) -> Array:
        return linearise(values)[0]

    def slopes(values: Array) -> Array:
        return linearise(values)[1]

    low, high = problem.bounds()
    search = least_squares(
        residuals,
        np.clip(start, low, high),
        jac=slopes,
        bounds=(low, high),
        x_scale=np.array([abs(v) or 1.0 for v in start.tolist()]),
        xtol=TOLERANCE if loss == "linear" else ROUGHLY,
        ftol=TOLERANCE**2 if loss == "linear" else ROUGHLY**2,
        gtol=TOLERANCE**2,
        loss=loss,
    )
    return np.asarray(search.x)
