"""Least squares: measured less predicted, over the error of each quantity."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.measurements import Measurements
from contactlab.fitting.model import Model
from contactlab.fitting.parameters import Parameter

Array = NDArray[np.float64]
Loss = Literal["linear", "soft_l1"]

#: Step of a derivative, of the parameter's size: the table of psi2 is good to 1e-9, steps of
#: an integrator make answers uneven by less than that, and the third derivative costs 1e-6.
STEP = 1e-3
#: Share of a parameter to which it is found: far below any scatter, far above the table's error.
TOLERANCE = 1e-6
#: The same of a robust fit, which is there to be compared.
ROUGHLY = 1e-4
#: Points of the grid on which searches begin, and most searches.
GRID, SEARCHES = 400, 4
#: Most rounds in which the errors of several quantities are taken from their own residuals, and
#: share to which these then stand still.
ROUNDS, STEADY = 6, 0.02
#: Least error of a quantity, of the size of its values: data made by the model itself have none.
LEAST_ERROR = 1e-9


@attrs.frozen(kw_only=True, eq=False)
class Problem:
    """A model and what it is to meet.

    Attributes
    ----------
    model : Model
    measured : mapping of str to array, shape (n,)
        NaN where there is no value.
    errors : mapping of str to array, shape (n,)
        Known standard errors.
    """

    model: Model
    measured: Mapping[str, Array]
    errors: Mapping[str, Array]

    @classmethod
    def of(cls, model: Model, measurements: Measurements) -> Problem:
        """Return the problem of measurements."""
        return cls(model=model, measured=measurements.measured, errors=measurements.errors)

    @property
    def counts(self) -> dict[str, int]:
        """Numbers measured, by quantity."""
        return {name: int(np.isfinite(v).sum()) for name, v in self.measured.items()}

    def residuals(self, points: Array) -> dict[str, Array]:
        """Return measured less predicted, shape (m, n) by quantity, at points (m, parameters)."""
        predicted = self.model.predicted(points, list(self.measured))
        return {name: found - predicted[name] for name, found in self.measured.items()}

    def weighted(self, points: Array, scales: Mapping[str, Any]) -> Array:
        """Return residuals over errors, shape (m, numbers), quantity after quantity, no gaps."""
        return self._over(self.residuals(points), scales)

    def _over(self, residuals: Mapping[str, Array], scales: Mapping[str, Any]) -> Array:
        known = {name: np.isfinite(values) for name, values in self.measured.items()}
        parts = [(residuals[name] / scales[name])[:, known[name]] for name in residuals]
        return np.concatenate(parts, axis=1)

    def sizes(self) -> dict[str, float]:
        """Return the size of the values of each quantity."""
        return {name: float(np.nanmax(np.abs(v))) or 1.0 for name, v in self.measured.items()}

    def scales(self, residuals: Mapping[str, Array] | None = None) -> dict[str, Any]:
        """Return the error of each quantity: known, or by the rms of its residuals.

        Before there are residuals the spread of the values stands for them.
        """
        found: dict[str, Any] = {}
        for name, measured in self.measured.items():
            if name in self.errors:
                found[name] = self.errors[name]
                continue
            least = LEAST_ERROR * self.sizes()[name]
            off = measured - np.nanmean(measured) if residuals is None else residuals[name]
            found[name] = max(float(np.sqrt(np.nanmean(off**2))), least)
        return found

    def bounds(self) -> tuple[Array, Array]:
        """Return the ends of the ranges of the parameters."""
        ends = [(parameter.least, parameter.most) for parameter in self.model.parameters]
        return np.array([low for low, _ in ends]), np.array([high for _, high in ends])

    def criterion(self, values: Array) -> float:
        """Return Akaike's: -2 log likelihood + 2 parameters, Gaussian errors, up to a constant."""
        residuals = self.residuals(values[None])
        scales = self.scales(residuals)
        weighted = self._over(residuals, scales)[0]
        unknown = [name for name in self.measured if name not in self.errors]
        logs = sum(2.0 * self.counts[name] * math.log(scales[name]) for name in unknown)
        return float(weighted @ weighted) + logs + 2.0 * (len(values) + len(unknown))

    def linearised(self, values: Array, scales: Mapping[str, Any]) -> tuple[Array, Array]:
        """Return weighted residuals, shape (numbers,), and their derivatives by the parameters.

        Derivatives, shape (numbers, parameters), are central differences inside the bounds; all
        impacts that they need are run together.
        """
        count = len(values)
        low, high = self.bounds()
        steps = STEP * np.array([abs(v) or 1.0 for v in values.tolist()])
        below = np.maximum(values - steps, low)
        above = np.minimum(values + steps, high)
        points = np.tile(values, (1 + 2 * count, 1))
        points[1 : 1 + count][np.diag_indices(count)] = below
        points[1 + count :][np.diag_indices(count)] = above
        found = self.weighted(points, scales)
        slopes = (found[1 + count :] - found[1 : 1 + count]).T / (above - below)
        return found[0], slopes


def starting(problem: Problem) -> list[Array]:
    """Return where searches begin: the least of the costs on a grid of starts, the best first.

    One quantity of one impact, as a rule, has the same value at two coefficients of friction, and
    a search goes no further than the minimum that is next.
    """
    points = _points(problem.model.parameters)
    weighted = problem.weighted(grid(problem.model.parameters), problem.scales())
    costs = np.sum(weighted**2, axis=1).reshape(points.shape[:-1])
    least = np.ones(costs.shape, dtype=bool)
    for axis in range(costs.ndim):
        ends = [(1, 1) if other == axis else (0, 0) for other in range(costs.ndim)]
        steps = np.diff(np.pad(costs, ends, constant_values=np.inf), axis=axis)
        count = costs.shape[axis]
        least &= np.take(steps, range(count), axis) < 0.0
        least &= np.take(steps, range(1, count + 1), axis) >= 0.0
    least.flat[int(np.argmin(costs))] = True  # also on a plain, where nothing is lower
    order = np.argsort(costs[least], kind="stable")[:SEARCHES]
    return list(points[least][order])


def grid(parameters: tuple[Parameter, ...]) -> Array:
    """Return the points among which searches begin, shape (m, parameters)."""
    return _points(parameters).reshape(-1, len(parameters))


def _points(parameters: tuple[Parameter, ...]) -> Array:
    """Return the starts of all parameters combined, an axis for each, and one of the values."""
    most = int(GRID ** (1.0 / len(parameters)) + 1e-9)
    axes = [_some(sorted(set(parameter.starts)), most) for parameter in parameters]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def _some(starts: list[float], most: int) -> Array:
    """Return at most so many of the starts, from end to end."""
    places = np.linspace(0, len(starts) - 1, min(len(starts), max(most, 2)))
    return np.array([starts[place] for place in sorted(set(places.round().astype(int).tolist()))])


def solved(problem: Problem, start: Array, scales: Mapping[str, Any] | None = None) -> Array:
    """Return the values of the parameters that meet the measurements best.

    Where several quantities have unknown errors, each is weighted by its own residuals, round
    after round, from ``scales`` on: the maximum of likelihood.
    """
    unknown = [name for name in problem.measured if name not in problem.errors]
    scales = problem.scales() if scales is None else scales
    values = minimum(problem, start, scales)
    if len(problem.measured) == 1 or not unknown:
        return values  # the one error, or none, changes nothing
    for _ in range(ROUNDS):
        before, scales = scales, problem.scales(problem.residuals(values[None]))
        values = minimum(problem, values, scales)
        if all(np.allclose(scales[name], before[name], rtol=STEADY, atol=0.0) for name in unknown):
            break
    return values


def minimum(
    problem: Problem, start: Array, scales: Mapping[str, Any], *, loss: Loss = "linear"
) -> Array:
    """Return the values at the least sum of a loss of residuals.

    Parameters
    ----------
    problem : Problem
    start : array, shape (parameters,)
    scales : mapping of str to float or array
        Errors that residuals are taken over, by quantity.
    loss : str
        Of ``scipy.optimize.least_squares``: "soft_l1" hardly feels a few far numbers.
    """
    from scipy.optimize import least_squares  # only those who fit pay for it

    known: dict[bytes, tuple[Array, Array]] = {}

    def linearised(values: Array) -> tuple[Array, Array]:
        """Return residuals and derivatives; the search asks for them one after the other."""
        key = values.tobytes()
        if key not in known:
            known.clear()
            known[key] = problem.linearised(values, scales)
        return known[key]

    def residuals(values: Array) -> Array:
        return linearised(values)[0]

    def slopes(values: Array) -> Array:
        return linearised(values)[1]

    low, high = problem.bounds()
    found = least_squares(
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
    return np.asarray(found.x)
