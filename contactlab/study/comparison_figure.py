"""Figure of a comparison: a quantity of each law over a sweep, differences, forces of an impact."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

import numpy as np
from matplotlib.axes import Axes

from contactlab.impact.scene import entry_unit
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array
from contactlab.outcome.columns import find_quantity
from contactlab.outcome.history import scale_forces
from contactlab.outcome.history_figure import on_axes
from contactlab.outcome.style import (
    MEASURED_COLOUR,
    Width,
    error_band,
    force_axes,
    friction_limit,
    label,
    law_style,
    verbatim,
    zero_line,
)
from contactlab.study.agreement import Agreement
from contactlab.study.side_by_side import Compared, default_quantities

POINTS: dict[str, Any] = {
    "color": MEASURED_COLOUR, "linestyle": "none", "marker": "o", "markersize": 4.5,
    "markerfacecolor": "white", "markeredgewidth": 1.1, "elinewidth": 0.9, "capsize": 2.0,
    "zorder": 5,
}  # fmt: skip

#: Quantities that are drawn less the abscissa: what the law changes, and no diagonal.
LESS = {("rebound_angle_deg", "angle_deg"): "rebound angle less angle of incidence (°)"}


class Drawn(Compared, Protocol):
    """The part of a comparison that is drawn."""

    def model(self, law: str) -> str:
        """Return what one law takes the bodies for."""

    def band(self, quantity: str, law: str) -> Array:
        """Return the numerical error of a quantity."""


def draw_compared(
    axes: Axes | None, comparison: Drawn, quantity: str | None, width: Width | None
) -> Axes:
    """Draw a quantity of each law over a sweep, with measured values, or forces of one impact.

    Parameters are those of ``contactlab.study.comparison.Comparison.plot``.
    """
    if comparison.scene.shape:
        quantity = quantity or default_quantities(comparison)[0]
        series = [item for item in comparison.agreements if item.measured.quantity == quantity]
        find_quantity(quantity)
        with on_axes(axes, width) as drawn:
            return laws_over_sweep(drawn, comparison, quantity, *series[:1])
    if quantity is not None:
        raise refuse(
            "quantity", quantity, "is for the comparison of a sweep", "leave it out for forces"
        )
    if not any(run.result.history for run in comparison.runs):
        raise refuse(
            "history", False, "leaves no forces to draw", "compare(scene, laws, history=True)"
        )
    with on_axes(axes, width) as drawn:
        return forces_over_contact(drawn, comparison)


def laws_over_sweep(
    axes: Axes, comparison: Drawn, quantity: str, agreement: Agreement | None = None
) -> Axes:
    """Draw a quantity over the sweep, a curve for each law, with any measured points.

    The abscissa of a grid of several entries is the entry with most values. Each combination of
    the other entries has a curve; the title names these entries.

    Parameters
    ----------
    axes : Axes
    comparison : Comparison
        Comparison of a sweep.
    quantity : str
        Name of a column in ``contactlab.outcome.columns``.
    agreement : Agreement, optional
        Agreement with measured values, which are drawn too.
    """
    varied, x, ordered = find_abscissa(comparison, agreement)
    words = LESS.get((quantity, varied))
    # between impacts that differ in several entries a line means nothing
    several = len(comparison.varied) > 1 or not np.ptp(x)
    rows = agreement is not None and several and not _axes(comparison)

    def draw(values: Array, at: Array) -> Array:
        return values if words is None else values - at

    for number, name in enumerate(comparison.names):
        values = draw(ordered(comparison.values(quantity, name)), x)
        look = law_style(number) | (_point_look(number) if rows else {})
        axes.plot(x, values, label=verbatim(describe_law(comparison, name)), **look)
        half = ordered(comparison.band(quantity, name))
        error_band(axes, x, values, half, law_style(number))
    if agreement is not None:
        measured = agreement.measured
        axes.errorbar(
            measured.x,
            draw(measured.values, measured.x),
            xerr=_bars(measured.x_error),
            yerr=_bars(measured.error),
            label=verbatim(measured.label),
            **POINTS,
        )
    axes.set_xlabel(label(varied, entry_unit(varied)))
    axes.set_ylabel(words or label(quantity, find_quantity(quantity).unit_in(comparison.scene)))
    parted = [name for name in _axes(comparison) if name != varied]
    if parted and varied in _axes(comparison):
        axes.set_title(f"a curve for each {' and '.join(map(verbatim, parted))}")
    axes.legend()
    return axes


def _bars(errors: Array) -> Array | None:
    """Return the lengths of error bars; None without errors, so that the legend has no bars."""
    return errors if np.any(errors > 0.0) else None


def _point_look(number: int) -> dict[str, Any]:
    """Return the look of a law whose impacts are points, joined by a thin line."""
    return {"marker": "os^Dv<"[number % 6], "markersize": 4.0, "linewidth": 1.0}


def differences(
    axes: Axes, comparison: Drawn, quantity: str, agreement: Agreement | None = None
) -> Axes:
    """Draw the differences of laws from measured values, or without these from the first law.

    Parameters
    ----------
    axes : Axes
    comparison : Comparison
        Comparison of a sweep.
    quantity : str
        Name of a column in ``contactlab.outcome.columns``.
    agreement : Agreement, optional
        Agreement with measured values, which are drawn too.
    """
    varied, x, ordered = find_abscissa(comparison, agreement)
    zero_line(axes)
    names = comparison.names
    for number, name in enumerate(names):
        style = law_style(number)
        if agreement is not None:
            order = np.argsort(agreement.measured.x, kind="stable")
            at, off = agreement.measured.x[order], agreement.difference(name)[order]
            look = {key: style[key] for key in ("color", "linestyle")} | _point_look(number)
            axes.plot(at, off, **look)
        elif number:
            axes.plot(x, ordered(comparison.difference(quantity, name)), **style)
    axes.set_xlabel(label(varied, entry_unit(varied)))
    reference = "measured" if agreement is not None else names[0]
    axes.set_ylabel(
        label(f"law $-$ {reference}", find_quantity(quantity).unit_in(comparison.scene))
    )
    return axes


def forces_over_contact(axes: Axes, comparison: Drawn) -> Axes:
    """Draw the tangential force of each law over one impact, with the friction limit."""
    zero_line(axes)
    drawn = False
    for number, run in enumerate(comparison.runs):
        if not run.result.history or run.result.history.time.size == 0:
            words = f"{describe_law(comparison, run.name)}: no course"
            axes.plot([], [], label=verbatim(words), **law_style(number))
            continue
        time, tangential, normal = scale_forces(run.result)
        if not drawn:
            friction_limit(axes, time, normal)
            drawn = True
        words = verbatim(describe_law(comparison, run.name))
        axes.plot(time, tangential, label=words, **law_style(number))
    force_axes(axes)
    axes.set_ylim(-1.05, 1.05)
    axes.legend(loc="lower left")
    return axes


def _axes(comparison: Drawn) -> Mapping[str, Any]:
    """Return the axes of a grid of several entries; empty for other sweeps."""
    scene = comparison.scene
    return scene.axes if len(scene.axes) > 1 else {}


def find_abscissa(
    comparison: Drawn, agreement: Agreement | None
) -> tuple[str, Any, Callable[[Any], Any]]:
    """Return name and values of the abscissa, and a function that orders a quantity alike.

    The abscissa is the measured entry, else the axis of a grid with most values, else the first
    entry of the sweep. NaN separates the curves of a grid.
    """
    several = _axes(comparison)
    if agreement is not None:
        name = agreement.measured.against
    elif several:
        name = max(several, key=lambda entry: len(several[entry]))
    else:
        name = next(iter(comparison.varied))
    if name not in comparison.varied:
        return name, np.full(comparison.scene.shape, np.nan), np.asarray
    x = np.asarray(comparison.varied[name])
    if not several:
        return name, x, np.asarray
    sizes, along = [len(values) for values in several.values()], list(several).index(name)

    def order(values: Array) -> Array:
        curves = np.moveaxis(np.reshape(values, sizes), along, -1).reshape(-1, sizes[along])
        return np.pad(curves, ((0, 0), (0, 1)), constant_values=np.nan).ravel()

    return name, order(x), order


def describe_law(comparison: Drawn, name: str) -> str:
    """Return the name of a law, with its model of the bodies if the name does not tell."""
    model = comparison.model(name)
    return f"{name} ({model})" if model and model not in name else name
