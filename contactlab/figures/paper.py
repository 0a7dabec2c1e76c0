"""The paper's Figs 1-4, drawn from their numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactlab.figures.names import name_curves
from contactlab.outcome.style import (
    ASIDE,
    QUIET,
    curve_colour,
    force_axes,
    friction_limit,
    label,
    law_style,
    ordered_colours,
    zero_line,
)
from contactlab.study.paper_figures import FIXED_PSI1, FigureData, chi_of_gyration

#: chi of solid spheres: nu = 0.5 and nu = 0 in eq. (38).
SOLID_CHI_RANGE = (3.5 / 3.0, 3.5 / 2.0)
#: Place of a legend for whose names there is no room beside the curves.
BESIDE: Mapping[str, Any] = {"loc": "center left", "bbox_to_anchor": (1.0, 0.5)}


def draw_paper(axes: Axes, data: FigureData) -> Axes:
    """Draw a figure of the paper; plain curves if the figure has no function of its own."""
    return FIGURES.get(data.number, curves)(axes, data)


def curves(axes: Axes, data: FigureData) -> Axes:
    """Draw all curves, with their names or parameters in a legend."""
    for curve, colour in zip(data.curves, ordered_colours(len(data.curves)), strict=True):
        name = curve.name if np.isnan(curve.parameter) else f"{curve.parameter:g}"
        axes.plot(curve.x, curve.y, color=colour, label=name)
    axes.set(xlabel=label(data.x), ylabel=label(data.y))
    axes.legend(title=data.parameter)
    return axes


def figure_1(axes: Axes, data: FigureData) -> Axes:
    """Draw the forces over the contact at several angles of incidence."""
    lines = _forces(axes, data)
    axes.text(0.02, 0.03, rf"$\chi$ = {data.ball.chi:.4f}", transform=axes.transAxes)
    names = [f"{curve.parameter:g}" for curve in data.curves[1:]]
    return _write_values(axes, lines, r"$\psi_1$", names, title=r"$\psi_1$")


def figure_2(axes: Axes, data: FigureData) -> Axes:
    """Draw psi2 against psi1 with the rigid-body theory, and name the regimes."""
    lines = _reflexion(axes, data)
    axes.set_xlabel(label("psi1"))
    axes.set_xlim(0.0, data.curves[0].x[-1])
    full_slip = 4.0 * data.ball.chi - 1.0
    for place in (1.0, full_slip):
        axes.axvline(place, color=QUIET, linewidth=0.8, linestyle=":", zorder=0)
    top = 1.7  # room for the words above the curves
    axes.set_ylim(top=top)
    words = {0.5: "sticks\nat first", 0.5 * (1.0 + full_slip): "slips, sticks, slips"}
    words[0.5 * (full_slip + data.curves[0].x[-1])] = "slips\nthroughout"
    for place, text in words.items():
        axes.text(place, top, text, ha="center", va="top", **ASIDE)
    axes.text(0.98, 0.03, rf"$\chi$ = {data.ball.chi:.4f}", ha="right", transform=axes.transAxes)
    _name_reflexion(axes, lines)
    return axes


def figure_3(axes: Axes, data: FigureData) -> Axes:
    """Draw the forces over the contact for several radii of gyration."""
    nu = data.ball.poisson_ratio

    def name(ratio: float) -> str:
        return f"{ratio:.3g}  ({chi_of_gyration(ratio, nu):.2f})"

    lines = _forces(axes, data, name=name)
    axes.text(0.02, 0.03, rf"$\psi_1$ = {FIXED_PSI1}", transform=axes.transAxes)
    names = [f"{curve.parameter:.3g}" for curve in data.curves[1:]]
    return _write_values(axes, lines, "$K$", names, title=r"$K$  ($\chi$)")


def figure_4(axes: Axes, data: FigureData) -> Axes:
    """Draw psi2 against chi with the rigid-body theory, and the range of solid spheres."""
    axes.set_xscale("log")
    lines = _reflexion(axes, data)
    axes.set_xlabel(label("chi"))
    axes.set_xlim(data.curves[0].x[0], data.curves[0].x[-1])
    ticks = [0.25, 0.5, 1, 2, 4, 8, 16]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
    axes.set_ylim(top=0.95)  # room for the words above the oscillation
    axes.axvspan(*SOLID_CHI_RANGE, color="#E4E4E4", zorder=-1, linewidth=0.0)
    axes.text(
        0.97 * SOLID_CHI_RANGE[0],
        axes.get_ylim()[1],
        "solid spheres,\n" r"$\nu$ from 0 to 0.5",
        ha="right",
        va="top",
        **ASIDE,
    )
    axes.text(0.02, 0.03, rf"$\psi_1$ = {FIXED_PSI1}", transform=axes.transAxes)
    _name_reflexion(axes, lines)
    return axes


#: Functions of the figures by number.
FIGURES = {1: figure_1, 2: figure_2, 3: figure_3, 4: figure_4}


def _write_values(
    axes: Axes, lines: list[Line2D], symbol: str, values: list[str], *, title: str
) -> Axes:
    """Write the values beside the curves, the first with its symbol; else draw a legend."""
    if not name_curves(axes, lines, [f"{symbol} = {values[0]}", *values[1:]]):
        axes.legend(title=title, **BESIDE)
    return axes


def _forces(
    axes: Axes, data: FigureData, name: Callable[[float], str] = lambda value: f"{value:g}"
) -> list[Line2D]:
    """Draw the tangential forces of a figure with the friction limit; return their lines."""
    normal, *tangential = data.curves
    zero_line(axes)
    friction_limit(axes, normal.x, normal.y)
    lines = []
    for curve, colour in zip(tangential, ordered_colours(len(tangential)), strict=True):
        lines += axes.plot(curve.x, curve.y, color=colour, label=name(curve.parameter))
    force_axes(axes)
    axes.set_ylim(-1.05, 1.05)
    return lines


def _reflexion(axes: Axes, data: FigureData) -> list[Line2D]:
    """Draw psi2 of the elastic law, the exact solution and the rigid-body theory; return lines."""
    zero_line(axes)
    elastic, rigid, exact = data.curves
    law = f"{elastic.name} law"
    lines = axes.plot(elastic.x, elastic.y, color=curve_colour(0), linewidth=3.0, label=law)
    lines += axes.plot(exact.x, exact.y, color="black", linewidth=0.9, label=exact.name)
    lines += axes.plot(rigid.x, rigid.y, **law_style(1), label=rigid.name)
    axes.set_ylabel(label("psi2"))
    return lines


def _name_reflexion(axes: Axes, lines: list[Line2D]) -> None:
    """Name the law, on which the exact solution lies, and the rigid-body theory."""
    law, exact, rigid = lines
    names = [f"{law.get_label()} (thick),\n{exact.get_label()} (thin)", str(rigid.get_label())]
    if not name_curves(axes, [law, rigid], names, alike=[[law, exact]]):
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, columnspacing=1.2)
