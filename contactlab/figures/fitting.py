"""Fits: measured values and laws above, residuals below."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from contactlab.figures.comparison import POINTS
from contactlab.figures.files import save
from contactlab.figures.style import label, law_style, verbatim, zero_line
from contactlab.fitting.outcome import Fit
from contactlab.impact.scene import entry_unit
from contactlab.outcome.columns import QUANTITIES

MARKERS = "os^Dv<"


def draw_fits(path: Path, fits: Mapping[str, Fit], **look: Any) -> None:
    """Draw every quantity that was measured in a column of its own, and write a picture.

    Options ``look`` and ``width`` are those of ``contactlab.figures.files.save``.
    """
    names = list(next(iter(fits.values())).measurements.measured)

    def draw(axes: Any) -> None:
        for column, name in enumerate(names):
            measured_and_laws(axes[0, column], fits, name)
            residuals(axes[1, column], fits, name)
            axes[0, column].set_xlabel("")
            axes[0, column].get_legend().remove()  # the same laws in the same colours
        known = axes[0, 0].get_legend_handles_labels()
        axes[0, 0].figure.legend(*known, loc="outside upper left", ncols=len(names))
        axes[0, 0].figure.align_ylabels()

    save(path, draw, rows=2, columns=len(names), heights=(2.0, 1.0), **look)


def measured_and_laws(axes: Axes, fits: Mapping[str, Fit], quantity: str) -> Axes:
    """Draw measured values of a quantity with their errors, and what each law says there."""
    first = next(iter(fits.values()))
    x, words = _abscissa(first)
    measured = first.measurements.measured[quantity]
    for number, (name, one) in enumerate(fits.items()):
        look = law_style(number) | {"marker": MARKERS[number % 6], "markersize": 3.0}
        there = np.isfinite(measured)
        law = one.predicted[quantity][there]
        axes.plot(*_means(x[there], law), label=_legend(name, one), markevery=[], **look)
        axes.plot(x[there], law, **(look | {"linestyle": "none"}))
    errors = first.measurements.errors.get(quantity)
    axes.errorbar(x, measured, yerr=errors, label="measured", **POINTS)
    axes.set_xlabel(words)
    axes.set_ylabel(label(quantity, QUANTITIES[quantity].unit))
    axes.legend()
    return axes


def _means(x: Any, values: Any) -> tuple[Any, Any]:
    """Return the means of what has the same abscissa: a repeat is no step of the law's curve."""
    places, which = np.unique(x, return_inverse=True)
    return places, np.bincount(which, values) / np.bincount(which)


def residuals(axes: Axes, fits: Mapping[str, Fit], quantity: str) -> Axes:
    """Draw measured less predicted of each law."""
    zero_line(axes)
    for number, one in enumerate(fits.values()):
        x, words = _abscissa(one)
        look = {"color": law_style(number)["color"], "linestyle": "none"}
        errors = one.measurements.errors.get(quantity)
        axes.errorbar(
            x,
            one.residuals[quantity],
            yerr=errors,
            marker=MARKERS[number % 6],
            markersize=4.0,
            elinewidth=0.8,
            **look,
        )
        axes.set_xlabel(words)
    axes.set_ylabel(label("measured $-$ law", QUANTITIES[quantity].unit))
    return axes


def _abscissa(one: Fit) -> tuple[Any, str]:
    """Return what to draw against: the angle of incidence, or else what varied most."""
    given = one.measurements.given
    if "angle_deg" in given:
        return given["angle_deg"], label("angle_deg", "deg")
    if {"normal_speed", "tangential_velocity"} <= set(given):
        ratio = given["tangential_velocity"] / given["normal_speed"]
        return np.degrees(np.arctan(ratio)), label("angle_deg", "deg")
    varied = [name for name, values in given.items() if np.ptp(values) > 0.0]
    if varied:
        return given[varied[0]], label(varied[0], entry_unit(varied[0]))
    return np.arange(1.0, 1.0 + len(one.measurements)), "impact"


def _legend(name: str, one: Fit) -> str:
    values = ", ".join(
        f"{key.rpartition('.')[2].replace('_', ' ')} {part.value:.3g}"
        for key, part in one.parameters.items()
    )
    return verbatim(f"{name}: {values}")
