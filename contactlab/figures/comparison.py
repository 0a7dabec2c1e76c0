"""Many laws side by side: a quantity above, differences below."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Literal, TypedDict

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.typing import ColorType, LineStyleType

from contactlab.figures.names import name_curves
from contactlab.impact.scene import entry_unit
from contactlab.outcome.columns import find_quantity
from contactlab.outcome.style import (
    BELOW,
    NARROW,
    curve_colour,
    error_band,
    figure_width,
    label,
    verbatim,
    zero_line,
)
from contactlab.study.comparison import Comparison
from contactlab.study.comparison_figure import POINTS, describe_law, find_abscissa

#: A law within this share of the range from the first law is named beside the first, not drawn.
AS_GOOD_AS = 0.01
FORM_DASHES: tuple[LineStyleType, ...] = ("-", (0, (6, 1.5)), (0, (2.5, 1.2)), (0, (1, 1)))
MARKERS = "os^Dv"


class Codes(TypedDict):
    """Place and look of a legend of names."""

    loc: Literal["upper center"]
    bbox_to_anchor: tuple[float, float]
    handlelength: float


class Curve(TypedDict):
    """Look of the curve of a law."""

    color: ColorType
    linestyle: LineStyleType
    linewidth: float


#: The names of the first law and of points, above the curves.
CODES_AT: Codes = {"loc": "upper center", "bbox_to_anchor": (0.56, 1.03), "handlelength": 1.0}
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
    varied, x, ordered = find_abscissa(comparison, None)
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
    words = (
        describe_law(comparison, first) if comparison.model(first) else f"{first} (the reference)"
    )
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
        look: Curve = {
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
    named = {name: describe_law(comparison, name) for name in (first, *drawn)}
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
            0.985, 0.02, verbatim("\n".join([f"on the line of {first}:", *close])),
            transform=upper.transAxes, fontsize="small", ha="right",
        )  # fmt: skip
    if not name_curves(upper, lines, names, alike=list(groups.values())):
        return False
    forms = [name for name in below if len(groups[name.split()[0]]) > 1]
    short = [verbatim(name.partition(" ")[2] or name) for name in forms]
    name_curves(lower, [below[name] for name in forms], short)
    return True


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
