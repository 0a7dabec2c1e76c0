"""Result of a fit: parameters, intervals, residuals and notes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from contactlab.impact.scene import entry_unit
from contactlab.numeric.checks import refuse
from contactlab.numeric.names import tell_attributes
from contactlab.numeric.types import Array, Json, Numbers
from contactlab.outcome.columns import QUANTITIES, json_value
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.sheet import Sheet, batch_axes
from contactlab.outcome.tabled import Tabled
from contactlab_fit.measurements import Measurements

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from contactlab.outcome.style import Width

Interval = tuple[float, float]


@attrs.frozen(kw_only=True)
class Estimate:
    """A fitted parameter.

    Attributes
    ----------
    name, unit : str
    value : float
    standard_error : float
        From the covariance; NaN if no number is left to estimate the scatter.
    interval : tuple of float
        95 % interval from the covariance and Student's t.
    bootstrap : tuple of float or None
        95 % interval of the bootstrap; None without a bootstrap.
    robust : float or None
        Value of the robust fit, which few outliers hardly move; None for too few numbers.
    """

    name: str
    unit: str
    value: float
    standard_error: float
    interval: Interval
    bootstrap: Interval | None = None
    robust: float | None = None


@tell_attributes
@attrs.frozen(kw_only=True, eq=False, repr=False)
class Fit(Tabled):
    """Best parameters, their errors, and the residuals.

    Attributes
    ----------
    parameters : mapping of str to Estimate
    correlation : array, shape (parameters, parameters)
    laws : str
    measurements : Measurements
    predicted : mapping of str to array, shape (n,)
        Quantities at the best values.
    aic : float
        Akaike's criterion up to a constant, to compare laws over the same measurements: lower
        is better, and a difference of 10 is beyond doubt.
    reduced_chi_square : float or None
        Sum of squares of residuals over their stated errors, per degree of freedom; None
        without stated errors.
    notes : tuple of str
        What the measurement looks like: reasons to look at it.
    cautions : tuple of str
        Errors of the model that the intervals do not hold, with their size where it is known.
    taken : tuple of str
        Numbers that enter the fit and stand in neither table nor scene.
    samples : int
        Samples of the bootstrap; fewer than requested after Ctrl-C, 0 without a bootstrap.
    impacts : callable
        Returns the impacts of a mapping of entries: see ``predict``.
    """

    parameters: Mapping[str, Estimate]
    correlation: Array
    laws: str
    measurements: Measurements
    predicted: Mapping[str, Array]
    aic: float
    reduced_chi_square: float | None = None
    notes: tuple[str, ...] = ()
    cautions: tuple[str, ...] = ()
    taken: tuple[str, ...] = ()
    samples: int = 0
    impacts: Callable[[Mapping[str, Numbers]], ImpactResult]

    def predict(self, **entries: Numbers) -> ImpactResult:
        """Return other impacts of the fitted bodies and laws.

        Parameters
        ----------
        **entries : float or array, shape (n,)
            What was given beside the measured quantities, under the same names and in the same
            units: ``predict(angle_deg=[10, 20, 30], speed=3.9)``.

        Raises
        ------
        ValueError
            If an entry is not of the scene, or has another length.
        """
        return self.impacts(entries)

    def __getitem__(self, name: str) -> float:
        """Return the value of a parameter."""
        if name not in self.parameters:
            raise refuse("name", name, "was not fitted", f"fitted: {', '.join(self.parameters)}")
        return self.parameters[name].value

    @property
    def residuals(self) -> dict[str, Array]:
        """Measured less predicted, shape (n,), by quantity; NaN where not measured."""
        measured = self.measurements.measured
        return {name: values - self.predicted[name] for name, values in measured.items()}

    @property
    def counts(self) -> dict[str, int]:
        """Count of measured numbers, by quantity."""
        return {name: int(np.isfinite(r).sum()) for name, r in self.residuals.items()}

    @property
    def rms(self) -> dict[str, float]:
        """Root mean square of the residuals, by quantity."""
        return {name: math.sqrt(np.nanmean(r**2)) for name, r in self.residuals.items()}

    @property
    def largest(self) -> dict[str, float]:
        """Largest absolute residual, by quantity."""
        return {name: float(np.nanmax(np.abs(r))) for name, r in self.residuals.items()}

    def _sheet(self) -> Sheet:
        """Return given, measured and predicted columns, one row for each impact."""
        content, shape = self.measurements, (len(self.measurements),)
        columns: dict[str, Any] = dict(content.given)
        units = {name: entry_unit(name) for name in content.given}
        kinds = {"": content.measured, "predicted_": self.predicted, "residual_": self.residuals}
        for before, values in (kinds | {"error_": content.errors}).items():
            columns |= {before + name: each for name, each in values.items()}
            units |= {before + name: QUANTITIES[name].unit for name in values}
        return Sheet(columns, units, batch_axes(shape), shape, {"laws": self.laws})

    def plot(
        self,
        quantity: str | None = None,
        *,
        axes: Axes | None = None,
        width: Width | None = None,
    ) -> Axes:
        """Return axes with measured values of a quantity as points, and the law as a curve.

        Parameters
        ----------
        quantity : str, optional
            A measured quantity; the first by default.
        axes : Axes, optional
            Axes to draw on; a new figure of ``matplotlib.pyplot`` by default.
        width : {"one", "two"}, optional
            Columns of a page that a new figure fills.

        Raises
        ------
        ValueError
            If the quantity was not measured.
        """
        from contactlab.outcome.history_figure import on_axes  # matplotlib only when drawing
        from contactlab_fit.figures import draw_measurements

        quantity = quantity or next(iter(self.predicted))
        if quantity not in self.predicted:
            remedy = f"there are {', '.join(self.predicted)}"
            raise refuse("quantity", quantity, "was not measured", remedy)
        with on_axes(axes, width) as drawn:
            return draw_measurements(drawn, {"law": self}, quantity)

    def to_dict(self) -> dict[str, Json]:
        """Return everything as plain numbers, lists and text."""
        content = self.measurements
        return {
            "laws": self.laws,
            "parameters": {
                name: {
                    "value": estimate.value,
                    "unit": estimate.unit,
                    "standard_error": json_value(estimate.standard_error),
                    "interval_95": [json_value(end) for end in estimate.interval],
                    "bootstrap_95": list(estimate.bootstrap) if estimate.bootstrap else None,
                    "robust": estimate.robust,
                }
                for name, estimate in self.parameters.items()
            },
            "correlation": json_value(self.correlation),
            "rms": self.rms,
            "largest": self.largest,
            "aic": json_value(self.aic),
            "reduced_chi_square": json_value(self.reduced_chi_square),
            "given": {name: json_value(values) for name, values in content.given.items()},
            "measured": {name: json_value(values) for name, values in content.measured.items()},
            "predicted": {name: json_value(values) for name, values in self.predicted.items()},
            "notes": list(self.notes),
            "cautions": list(self.cautions),
            "taken": list(self.taken),
            "samples": self.samples,
        }

    def __repr__(self) -> str:
        """Return parameters and residuals as a table."""
        lines = [f"Fit of {len(self.measurements)} impacts to {self.laws}"]
        for name, estimate in self.parameters.items():
            low, high = estimate.interval
            unit = "" if estimate.unit == "1" else f" {estimate.unit}"
            error = f"± {estimate.standard_error:.2g}, 95 % {low:.4g} to {high:.4g}"
            lines.append(f"  {name:24} {estimate.value:.5g}{unit} {error}")
            if estimate.bootstrap:
                lines[-1] += (
                    f" (bootstrap {estimate.bootstrap[0]:.4g} to {estimate.bootstrap[1]:.4g})"
                )
        for name, rms in self.rms.items():
            lines.append(f"  {name:24} rms {rms:.3g}, largest {self.largest[name]:.3g}")
        lines += [f"  taken: {each}" for each in self.taken]
        lines += [f"  note: {note}" for note in self.notes]
        return "\n".join([*lines, *(f"  caution: {caution}" for caution in self.cautions)])
