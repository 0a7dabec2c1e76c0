"""Laws side by side: the answers above, what parts them below."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from contactlab.figures.style import (
    BELOW,
    LAW_COLOURS,
    MEASURED_COLOUR,
    NARROW,
    error_band,
    figure_width,
    force_axes,
    friction_limit,
    label,
    law_style,
    verbatim,
    zero_line,
)
from contactlab.impact.scene import entry_unit
from contactlab.outcome.columns import QUANTITIES, scaled_forces
from contactlab.study.compare import Agreement, Comparison

POINTS: dict[str, Any] = {
    "color": MEASURED_COLOUR, "linestyle": "none", "marker": "o", "markersize": 4.5,
    "markerfacecolor": "white", "markeredgewidth": 1.1, "elinewidth": 0.9, "capsize": 2.0,
    "zorder": 5,
}  # fmt: skip


#: Laws this close to the first, over the range drawn, would lie within its line: they are named
#: with it.
AS_GOOD_AS = 0.01
FORM_DASHES: tuple[Any, ...] = ("-", (0, (6, 1.5)), (0, (2.5, 1.2)), (0, (1, 1)))
MARKERS = "os^Dv"
#: What points without error bars take of the look of measured ones.
CODE_LOOK = ("color", "linestyle", "markersize", "markerfacecolor", "markeredgewidth", "zorder")


def all_laws(upper: Axes, lower: Axes, comparison: Comparison, quantity: str) -> tuple[Axes, Axes]:
    """Draw many laws: the first thick, above; below what the others are off by.

    Laws that agree with the first are named with it; those that make no force are left out.
    Forms of one law share its colour. Bands are numerical errors.

    Parameters
    ----------
    upper, lower : Axes
        Of the curves and of the differences.
    comparison : Comparison
    quantity : str
        Name of what is compared, such as ``"psi2"``.
    """
    varied, x, ordered = _abscissa(comparison, None)
    first, *others = comparison.names
    exact = comparison.values(quantity, first)
    size = float(np.nanmax(exact) - np.nanmin(exact)) or 1.0
    drawn: list[str] = []
    close: list[str] = []
    for name in others:
        off = np.abs(comparison.difference(quantity, name))
        if (np.nan_to_num(comparison.values("psi2", name) - comparison.scene.psi1) == 0.0).all():
            continue
        (close if np.nanmax(off) < AS_GOOD_AS * size else drawn).append(name)
    drawn.sort(key=lambda name: -float(np.nanmax(np.abs(comparison.difference(quantity, name)))))
    families = list(dict.fromkeys(name.split()[0] for name in sorted(drawn)))
    known = f"{first}, the reference"
    if close:
        known += "; on its line:\n" + ",\n".join(close)
    upper.plot(x, ordered(exact), color="black", linewidth=3.2, label=verbatim(known), zorder=4)
    for axes in (upper, lower):
        zero_line(axes)
    forms: dict[str, int] = {}
    for name in drawn:
        family = name.split()[0]
        number = forms[family] = forms.get(family, -1) + 1
        look: Any = {
            "color": LAW_COLOURS[families.index(family) % len(LAW_COLOURS)],
            "linestyle": FORM_DASHES[number % len(FORM_DASHES)],
            "linewidth": 1.6,
        }
        values = ordered(comparison.values(quantity, name))
        apart = ordered(comparison.difference(quantity, name))
        half = ordered(comparison.band(quantity, name))
        upper.plot(x, values, label=verbatim(name), zorder=3, **look)
        lower.plot(x, apart, **look)
        for axes, middle in ((upper, values), (lower, apart)):
            error_band(axes, x, middle, half, look)
    _codes(upper, comparison, quantity, varied)
    upper.set_ylabel(label(quantity, QUANTITIES[quantity].unit_in(comparison.scene)))
    lower.set_ylabel(rf"law $-$ {verbatim(first)}")
    lower.set_xlabel(label(varied, entry_unit(varied)))
    if figure_width(upper) < NARROW:
        lower.legend(*upper.get_legend_handles_labels(), **BELOW)
    else:
        upper.legend(loc="upper left", bbox_to_anchor=(1.0, 1.03), borderaxespad=0.0)
    return upper, lower


def _codes(axes: Axes, comparison: Comparison, quantity: str, varied: str) -> None:
    """Draw the series that the scene file carries, as points."""
    found = [item.measured for item in comparison.agreements]
    for number, item in enumerate(one for one in found if (one.quantity, one.against) == (
        quantity, varied
    )):  # fmt: skip
        look = {key: POINTS[key] for key in CODE_LOOK} | {"marker": MARKERS[number % len(MARKERS)]}
        axes.plot(item.x, item.values, label=verbatim(item.label), **look)


def laws_over_sweep(
    axes: Axes, comparison: Comparison, quantity: str, agreement: Agreement | None = None
) -> Axes:
    """Draw a quantity over the sweep, one curve a law, with measured points if there are any.

    A sweep of every combination of several entries is drawn over the one of most values, with a
    curve for each combination of the others, which the title names.

    Parameters
    ----------
    axes : Axes
    comparison : Comparison
        Of a sweep.
    quantity : str
        By its name in ``contactlab.outcome.quantities``.
    agreement : Agreement, optional
        With measured values, drawn too.
    """
    varied, x, ordered = _abscissa(comparison, agreement)
    for number, name in enumerate(comparison.names):
        values = ordered(comparison.values(quantity, name))
        axes.plot(x, values, label=verbatim(name), **law_style(number))
    for number, name in enumerate(comparison.names):
        values = ordered(comparison.values(quantity, name))
        half = ordered(comparison.band(quantity, name))
        error_band(axes, x, values, half, law_style(number))
    if agreement is not None:
        measured = agreement.measured
        axes.errorbar(
            measured.x,
            measured.values,
            xerr=measured.x_error,
            yerr=measured.error,
            label=verbatim(measured.label),
            **POINTS,
        )
    axes.set_xlabel(label(varied, entry_unit(varied)))
    axes.set_ylabel(label(quantity, QUANTITIES[quantity].unit_in(comparison.scene)))
    others = [name for name in _axes(comparison) if name != varied]
    if others and varied in _axes(comparison):
        axes.set_title(f"a curve for each {' and '.join(map(verbatim, others))}")
    axes.legend()
    return axes


def differences(
    axes: Axes, comparison: Comparison, quantity: str, agreement: Agreement | None = None
) -> Axes:
    """Draw each law less the measured values, or, where there are none, less the first law.

    Parameters
    ----------
    axes : Axes
    comparison : Comparison
        Of a sweep.
    quantity : str
        By its name in ``contactlab.outcome.quantities``.
    agreement : Agreement, optional
        With measured values, drawn too.
    """
    varied, x, ordered = _abscissa(comparison, agreement)
    zero_line(axes)
    names = comparison.names
    for number, name in enumerate(names):
        style = law_style(number)
        if agreement is not None:
            axes.plot(
                agreement.measured.x,
                agreement.difference(name),
                marker="os^Dv<"[number % 6],
                markersize=4.0,
                linewidth=1.0,
                color=style["color"],
                linestyle=style["linestyle"],
            )
        elif number:
            axes.plot(x, ordered(comparison.difference(quantity, name)), **style)
    axes.set_xlabel(label(varied, entry_unit(varied)))
    other = "measured" if agreement is not None else names[0]
    axes.set_ylabel(label(f"law $-$ {other}", QUANTITIES[quantity].unit_in(comparison.scene)))
    return axes


def forces_over_contact(axes: Axes, comparison: Comparison) -> Axes:
    """Draw the tangential force of each law over one impact, inside the limit of friction."""
    zero_line(axes)
    drawn = False
    for number, run in enumerate(comparison.runs):
        if run.result.history is None or run.result.history.time.size == 0:
            continue
        time, tangential, normal = scaled_forces(run.result)
        if not drawn:
            friction_limit(axes, time, normal)
            drawn = True
        axes.plot(time, tangential, label=verbatim(run.name), **law_style(number))
    force_axes(axes)
    axes.set_ylim(-1.05, 1.05)
    axes.legend(loc="lower left")
    return axes


def _axes(comparison: Comparison) -> Mapping[str, Any]:
    """Return the entries that vary independently, where there are several."""
    scene = comparison.scene
    return scene.axes if len(scene.axes) > 1 else {}


def _abscissa(
    comparison: Comparison, agreement: Agreement | None
) -> tuple[str, Any, Callable[[Any], Any]]:
    """Return the name and the values to draw against, and what brings a quantity in their order.

    That is what the measurement varied; or else the sweep's first entry, or of several that vary
    independently the one of most values. Over these, NaN parts one curve from the next.
    """
    several = _axes(comparison)
    if agreement is not None:
        name = agreement.measured.against
    elif several:
        name = max(several, key=lambda one: len(several[one]))
    else:
        name = next(iter(comparison.varied))
    if name not in comparison.varied:
        return name, np.full(comparison.scene.shape, np.nan), np.asarray
    x = np.asarray(comparison.varied[name])
    if not several:
        return name, x, np.asarray
    sizes, along = [len(values) for values in several.values()], list(several).index(name)

    def ordered(values: Any) -> Any:
        curves = np.moveaxis(np.reshape(values, sizes), along, -1).reshape(-1, sizes[along])
        return np.pad(curves, ((0, 0), (0, 1)), constant_values=np.nan).ravel()

    return name, ordered(x), ordered
