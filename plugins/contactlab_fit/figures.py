"""Figures of fits: measured values and laws above, residuals below."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from contactlab.figures.files import Panels, save
from contactlab.impact.scene import entry_unit
from contactlab.numeric.types import Array, Numbers
from contactlab.outcome.columns import QUANTITIES
from contactlab.outcome.functions_of_results import WithScene
from contactlab.outcome.style import Look, Width, label, law_style, verbatim, zero_line
from contactlab.study.comparison_figure import POINTS
from contactlab_fit.measurements import Measurements

MARKERS = "os^Dv<"
#: Impacts at which the curve of a law is drawn, beside the measured impacts.
SMOOTH = 100


class Valued(Protocol):
    """A fitted parameter."""

    @property
    def value(self) -> float:
        """Its value."""


class Fitted(Protocol):
    """The part of a fit that is drawn."""

    @property
    def parameters(self) -> Mapping[str, Valued]:
        """The fitted parameters."""

    @property
    def measurements(self) -> Measurements:
        """The measured impacts."""

    @property
    def predicted(self) -> Mapping[str, Array]:
        """The measured quantities by the law."""

    @property
    def residuals(self) -> Mapping[str, Array]:
        """Measured less predicted."""

    def predict(self, **entries: Numbers) -> WithScene:
        """Return other impacts of the law."""


def draw_fits(
    path: Path, fits: Mapping[str, Fitted], *, look: Look = "print", width: Width | None = None
) -> None:
    """Draw each measured quantity in a column of panels, and write a picture.

    Parameters
    ----------
    path : Path
    fits : mapping of str to Fitted
        Fits to the same measurements, by the names of their laws.
    look, width
        As of ``contactlab.figures.files.save``.
    """
    names = list(dict.fromkeys(name for fit in fits.values() for name in fit.predicted))

    def draw(axes: Panels) -> None:
        for column, name in enumerate(names):
            draw_measurements(axes[0, column], fits, name)
            residuals(axes[1, column], fits, name)
            axes[0, column].set_xlabel("")
            axes[0, column].get_legend().remove()  # one legend serves all panels
        entries = axes[0, 0].get_legend_handles_labels()
        axes[0, 0].figure.legend(*entries, loc="outside upper left", ncols=len(names))
        axes[0, 0].figure.align_ylabels()

    save(path, draw, rows=2, columns=len(names), heights=(2.0, 1.0), look=look, width=width)


def draw_measurements(axes: Axes, fits: Mapping[str, Fitted], quantity: str) -> Axes:
    """Draw measured values of a quantity with their errors, and the predictions of each law."""
    first = next(iter(fits.values()))
    x, words = _abscissa(first)
    measured = first.measurements.measured[quantity]
    for number, (name, fit) in enumerate(fits.items()):
        look = law_style(number) | {"marker": MARKERS[number % len(MARKERS)], "markersize": 3.0}
        present = np.isfinite(measured)
        between, law = _curve(fit, x[present], present, quantity)
        axes.plot(between, law, label=_legend(name, fit), markevery=[], **look)
        axes.plot(x[present], fit.predicted[quantity][present], **(look | {"linestyle": "none"}))
    errors = first.measurements.errors.get(quantity)
    axes.errorbar(x, measured, yerr=errors, label="measured", **POINTS)
    axes.set_xlabel(words)
    axes.set_ylabel(label(quantity, QUANTITIES[quantity].unit))
    axes.legend()
    return axes


def _curve(fit: Fitted, x: Array, present: NDArray[np.bool_], quantity: str) -> tuple[Array, Array]:
    """Return the law between the measured impacts: abscissas, and the quantity there."""
    if not fit.measurements.given:
        return x, fit.predicted[quantity][present]
    distinct, place = np.unique(x, return_inverse=True)
    between = np.unique(np.append(np.linspace(distinct[0], distinct[-1], SMOOTH), distinct))
    entries = {
        name: np.interp(between, distinct, np.bincount(place, values[present]) / np.bincount(place))
        for name, values in fit.measurements.given.items()
    }
    return between, QUANTITIES[quantity].of(fit.predict(**entries))


def residuals(axes: Axes, fits: Mapping[str, Fitted], quantity: str) -> Axes:
    """Draw the residuals, measured less predicted, of each law."""
    zero_line(axes)
    for number, fit in enumerate(fits.values()):
        x, words = _abscissa(fit)
        look = {"color": law_style(number)["color"], "linestyle": "none"}
        errors = fit.measurements.errors.get(quantity)
        axes.errorbar(
            x,
            fit.residuals[quantity],
            yerr=errors,
            marker=MARKERS[number % len(MARKERS)],
            markersize=4.0,
            elinewidth=0.8,
            **look,
        )
        axes.set_xlabel(words)
    axes.set_ylabel(label("measured $-$ law", QUANTITIES[quantity].unit))
    return axes


def _abscissa(fit: Fitted) -> tuple[Any, str]:
    """Return abscissa and label: the angle of incidence, else the first entry that varies."""
    given = fit.measurements.given
    if "angle_deg" in given:
        return given["angle_deg"], label("angle_deg", "deg")
    if {"normal_speed", "tangential_velocity"} <= set(given):
        ratio = given["tangential_velocity"] / given["normal_speed"]
        return np.degrees(np.arctan(ratio)), label("angle_deg", "deg")
    varied = [name for name, values in given.items() if np.ptp(values) > 0.0]
    if varied:
        return given[varied[0]], label(varied[0], entry_unit(varied[0]))
    return np.arange(1.0, 1.0 + len(fit.measurements)), "impact"


def _legend(name: str, fit: Fitted) -> str:
    """Return the name of a law with its parameters."""
    values = ", ".join(
        f"{key.rpartition('.')[2].replace('_', ' ')} {estimate.value:.3g}"
        for key, estimate in fit.parameters.items()
    )
    return verbatim(f"{name}: {values}")
