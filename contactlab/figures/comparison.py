"""Laws side by side: quantities above, differences below."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactlab.figures.names import name_curves
from contactlab.impact.scene import entry_unit
from contactlab.numeric.types import Array
from contactlab.outcome.columns import find_quantity
from contactlab.outcome.history import scaled_forces
from contactlab.outcome.style import (
    BELOW,
    MEASURED_COLOUR,
    NARROW,
    curve_colour,
    error_band,
    figure_width,
    force_axes,
    friction_limit,
    label,
    law_style,
    verbatim,
    zero_line,
)
from contactlab.study.agreement import Agreement
from contactlab.study.comparison import Comparison

POINTS: dict[str, Any] = {
    "color": MEASURED_COLOUR, "linestyle": "none", "marker": "o", "markersize": 4.5,
    "markerfacecolor": "white", "markeredgewidth": 1.1, "elinewidth": 0.9, "capsize": 2.0,
    "zorder": 5,
}  # fmt: skip

#: A law within this share of the range from the first law is named beside the first, not drawn.
AS_GOOD_AS = 0.01
#: Quantities that are drawn less the abscissa: what the law changes, and no diagonal.
LESS = {("rebound_angle_deg", "angle_deg"): "rebound angle less angle of incidence (°)"}
FORM_DASHES: tuple[Any, ...] = ("-", (0, (6, 1.5)), (0, (2.5, 1.2)), (0, (1, 1)))
MARKERS = "os^Dv"
#: The names of the first law and of points, above the curves.
CODES_AT: Any = {"loc": "upper center", "bbox_to_anchor": (0.56, 1.03), "handlelength": 1.0}
#: Entries of ``POINTS`` that points without error bars share.
CODE_LOOK = ("color", "linestyle", "markersize", "markerfacecolor", "markeredgewidth", "zorder")


def all_laws(upper: Axes, lower: Axes, comparison: Comparison, quantity: str) -> tuple[Axes, Axes]:
    """Draw many laws above, the first thick; below, differences from the first law.

    Laws that agree with the first are named beside the first; laws without force are left out.
    Forms of one law share a colour. Bands are numerical errors.

    Parameters
    ----------
    upper, lower : Axes
        Axes of the curves, and of the differences.
    comparison : Comparison
    quantity : str
        Name of a quantity, such as ``"psi2"``.
    """
    varied, x, ordered = _abscissa(comparison, None)
    first, *others = comparison.names
    exact = comparison.values(quantity, first)
    size = float(np.nanmax(exact) - np.nanmin(exact)) or 1.0
    drawn: list[str] = []
    close: list[str] = []
    for name in others:
        difference = np.abs(comparison.difference(quantity, name))
        if (np.nan_to_num(comparison.values("psi2", name) - comparison.scene.psi1) == 0.0).all():
            continue
        (close if np.nanmax(difference) < AS_GOOD_AS * size else drawn).append(name)
    close = _by_law(Counter(name.split()[0] for name in close))
    drawn.sort(key=lambda name: -float(np.nanmax(np.abs(comparison.difference(quantity, name)))))
    families = list(dict.fromkeys(name.split()[0] for name in sorted(drawn)))
    words = _said(comparison, first) if comparison.model(first) else f"{first} (the reference)"
    if close:
        words += "; on its line:\n" + ",\n".join(close)
    (reference,) = upper.plot(
        x, ordered(exact), color="black", linewidth=3.2, label=verbatim(words), zorder=4
    )
    groups: dict[str, list[Line2D]] = {first: [reference]}
    below: dict[str, Line2D] = {}
    for axes in (upper, lower):
        zero_line(axes)
    forms: dict[str, int] = {}
    for name in drawn:
        family = name.split()[0]
        number = forms[family] = forms.get(family, -1) + 1
        look: Any = {
            "color": curve_colour(families.index(family)),
            "linestyle": FORM_DASHES[number % len(FORM_DASHES)],
            "linewidth": 1.6,
        }
        values = ordered(comparison.values(quantity, name))
        difference = ordered(comparison.difference(quantity, name))
        half = ordered(comparison.band(quantity, name))
        groups.setdefault(family, []).extend(
            upper.plot(x, values, label=verbatim(name), zorder=3, **look)
        )
        (below[name],) = lower.plot(x, difference, **look)
        for axes, middle in ((upper, values), (lower, difference)):
            error_band(axes, x, middle, half, look)
    points = _codes(upper, comparison, quantity, varied)
    upper.set_ylabel(label(quantity, find_quantity(quantity).unit_in(comparison.scene)))
    lower.set_ylabel(rf"law $-$ {verbatim(comparison.model(first) or first)}")
    lower.set_xlabel(label(varied, entry_unit(varied)))
    named = {name: _said(comparison, name) for name in (first, *drawn)}
    if not _write_names(upper, lower, groups, below, close, points, named):
        _legend_of_all(upper, lower)
    return upper, lower


def _write_names(
    upper: Axes,
    lower: Axes,
    groups: Mapping[str, list[Line2D]],
    below: Mapping[str, Line2D],
    close: list[str],
    points: list[Line2D],
    said: Mapping[str, str],
) -> bool:
    """Write names beside the curves; return False if there is no room for all of them."""
    first, *others = groups
    words = _by_law({said.get(name, name): len(groups[name]) for name in others})
    lines = [groups[name][0] for name in others]
    names = [verbatim(name) for name in words]
    if points:
        key = [Line2D([], [], color="black", linewidth=3.2, label=verbatim(said[first])), *points]
        upper.legend(handles=key, fontsize="small", **CODES_AT)
    else:
        lines, names = [*groups[first], *lines], [verbatim(said[first]), *names]
    if close:
        upper.text(
            0.015, 0.02, verbatim("\n".join([f"on the line of {first}:", *close])),
            transform=upper.transAxes, fontsize="small",
        )  # fmt: skip
    if not name_curves(upper, lines, names, alike=list(groups.values())):
        return False
    forms = [name for name in below if len(groups[name.split()[0]]) > 1]
    short = [verbatim(name.partition(" ")[2] or name) for name in forms]
    name_curves(lower, [below[name] for name in forms], short)
    return True


def _said(comparison: Comparison, name: str) -> str:
    """Return the name of a law, with what it takes the bodies for where the name does not say."""
    model = comparison.model(name)
    return f"{name} ({model})" if model and model not in name else name


def _by_law(forms: Mapping[str, int]) -> list[str]:
    """Return the name of each law, with the number of its forms if there are several."""
    return [f"{name}, {count} forms" if count > 1 else name for name, count in forms.items()]


def _legend_of_all(upper: Axes, lower: Axes) -> None:
    """Name all curves in a legend, beside the axes or in a narrow figure below."""
    for text in upper.texts:
        text.remove()
    if figure_width(upper) < NARROW:
        if (own := upper.get_legend()) is not None:
            own.remove()
        lower.legend(*upper.get_legend_handles_labels(), **BELOW)
    else:
        upper.legend(loc="upper left", bbox_to_anchor=(1.0, 1.03), borderaxespad=0.0)


def _codes(axes: Axes, comparison: Comparison, quantity: str, varied: str) -> list[Line2D]:
    """Draw the measured series of the scene file as points; return them."""
    series = [item.measured for item in comparison.agreements]
    drawn = [item for item in series if (item.quantity, item.against) == (quantity, varied)]
    points: list[Line2D] = []
    for number, item in enumerate(drawn):
        look = {key: POINTS[key] for key in CODE_LOOK} | {"marker": MARKERS[number % len(MARKERS)]}
        points += axes.plot(item.x, item.values, label=verbatim(item.label), **look)
    return points


def laws_over_sweep(
    axes: Axes, comparison: Comparison, quantity: str, agreement: Agreement | None = None
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
    varied, x, ordered = _abscissa(comparison, agreement)
    words = LESS.get((quantity, varied))
    # of impacts that differ in several entries, a line between two is no impact
    several = len(comparison.varied) > 1 or not np.ptp(x)
    rows = agreement is not None and several and not _axes(comparison)

    def drawn(values: Array, at: Array) -> Array:
        return values if words is None else values - at

    for number, name in enumerate(comparison.names):
        values = drawn(ordered(comparison.values(quantity, name)), x)
        look = law_style(number) | (_point_look(number) if rows else {})
        axes.plot(x, values, label=verbatim(_said(comparison, name)), **look)
        half = ordered(comparison.band(quantity, name))
        error_band(axes, x, values, half, law_style(number))
    if agreement is not None:
        measured = agreement.measured
        axes.errorbar(
            measured.x,
            drawn(measured.values, measured.x),
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
    """Return the lengths of error bars; None if nobody gave any, so that the legend has none."""
    return errors if np.any(errors > 0.0) else None


def _point_look(number: int) -> dict[str, Any]:
    """Return the look of a law whose impacts are points, joined by a thin line."""
    return {"marker": "os^Dv<"[number % 6], "markersize": 4.0, "linewidth": 1.0}


def differences(
    axes: Axes, comparison: Comparison, quantity: str, agreement: Agreement | None = None
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
    varied, x, ordered = _abscissa(comparison, agreement)
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


def forces_over_contact(axes: Axes, comparison: Comparison) -> Axes:
    """Draw the tangential force of each law over one impact, with the friction limit."""
    zero_line(axes)
    drawn = False
    for number, run in enumerate(comparison.runs):
        if not run.result.history or run.result.history.time.size == 0:
            words = f"{_said(comparison, run.name)}: no course"
            axes.plot([], [], label=verbatim(words), **law_style(number))
            continue
        time, tangential, normal = scaled_forces(run.result)
        if not drawn:
            friction_limit(axes, time, normal)
            drawn = True
        words = verbatim(_said(comparison, run.name))
        axes.plot(time, tangential, label=words, **law_style(number))
    force_axes(axes)
    axes.set_ylim(-1.05, 1.05)
    axes.legend(loc="lower left")
    return axes


def _axes(comparison: Comparison) -> Mapping[str, Any]:
    """Return the axes of a grid of several entries; empty for other sweeps."""
    scene = comparison.scene
    return scene.axes if len(scene.axes) > 1 else {}


def _abscissa(
    comparison: Comparison, agreement: Agreement | None
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

    def ordered(values: Array) -> Array:
        curves = np.moveaxis(np.reshape(values, sizes), along, -1).reshape(-1, sizes[along])
        return np.pad(curves, ((0, 0), (0, 1)), constant_values=np.nan).ravel()

    return name, ordered(x), ordered
