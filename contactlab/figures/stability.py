"""Stability picture: a map of steps against chi for each law, and model errors below.

The error is the distance from the law's own limit. Laws whose limit is another than the elastic
continuum have other colours, so that a fine step of a rough model does not look like an accurate
answer.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.path import Path as Line

from contactlab.figures.files import save_figure
from contactlab.figures.style import ORDERED_MAP, WIDTHS, Look, Width, label, law_style, styled
from contactlab.study.error_map import ErrorMap
from contactlab.study.model_error import ModelError

#: Errors between which the colours lie, and errors with a contour.
LEAST, LARGEST, CONTOURS = 1e-4, 1.0, (1e-3, 1e-2)
#: Colours for laws that do not converge to the continuum, without the palest, which are white.
MODEL_MAP, MODEL_BEGIN = "Purples", 0.25
REFUSED_COLOUR = "#DDDDDD"
PANEL_WIDTH, PANEL_HEIGHT, MODELS_HEIGHT, COLUMNS = 2.7, 2.4, 2.6, 3
#: Least model error drawn; smaller ones, from slip throughout, are rounding.
LEAST_MODEL = 1e-6


def draw_stability(
    path: Path,
    maps: Sequence[ErrorMap],
    models: Sequence[ModelError] = (),
    *,
    look: Look = "print",
    width: Width | None = None,
) -> None:
    """Draw a panel for each law and the model errors below, and write a picture.

    Parameters
    ----------
    path : Path
    maps : sequence of ErrorMap
    models : sequence of ModelError
    look : {"print", "slides"}
    width : {"two"}, optional
        Columns of a page that the picture fills; one is too narrow for the panels.
    """
    groups = [[each for each in maps if each.converges is kind] for kind in (True, False)]
    columns = max(2, min(COLUMNS, max(map(len, groups))))
    lines = [group[k : k + columns] for group in groups for k in range(0, len(group), columns)]
    heights = [PANEL_HEIGHT] * len(lines) + [MODELS_HEIGHT] * bool(models)
    with styled(look, width):
        across = PANEL_WIDTH * columns + 1.2
        scale = 1.0 if width is None else WIDTHS[width] / across
        figure = Figure(figsize=(scale * across, scale * (sum(heights) + 0.4)))
        FigureCanvasAgg(figure)
        grid = figure.add_gridspec(len(heights), columns, height_ratios=heights)
        panels = [
            [figure.add_subplot(grid[row, column]) for column in range(len(line))]
            for row, line in enumerate(lines)
        ]
        for line, row in zip(lines, panels, strict=True):
            for axes, each in zip(row, line, strict=True):
                error_over_steps(axes, each)
                axes.set_xlabel(label("chi"))
            row[0].set_ylabel("steps of one contact")
        _bars(figure, panels, [line[0].converges for line in lines])
        if models:
            model_errors(figure.add_subplot(grid[len(lines), :]), models)
        save_figure(figure, path)


def error_colours(converges: bool) -> tuple[Colormap, LogNorm]:
    """Return colours of errors, for laws that converge to the continuum or do not."""
    colours: Colormap = mpl.colormaps[ORDERED_MAP + "_r"]
    if not converges:
        shades = mpl.colormaps[MODEL_MAP](np.linspace(MODEL_BEGIN, 1.0, colours.N))
        colours = ListedColormap(shades, name="model")
    return colours, LogNorm(LEAST, LARGEST, clip=True)


def error_over_steps(axes: Axes, drawn: ErrorMap) -> Axes:
    """Draw the map of a law: errors coloured with contours, refused cells plain grey.

    Parameters
    ----------
    axes : Axes
    drawn : ErrorMap
        The colours of its errors are ``error_colours(drawn.converges)``.
    """
    colours, norm = error_colours(drawn.converges)
    chi, steps = np.array(drawn.chis), np.array(drawn.steps, dtype=float)
    axes.set_facecolor(REFUSED_COLOUR)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.pcolormesh(_edges(chi), _edges(steps), drawn.error, cmap=colours, norm=norm)
    within = drawn.error[np.isfinite(drawn.error)]
    shown = [level for level in CONTOURS if within.size and within.min() < level < within.max()]
    if shown:
        line = "white" if drawn.converges else "black"
        contours = axes.contour(chi, steps, drawn.error, shown, colors=line, linewidths=1.0)
        axes.clabel(
            contours,
            fmt=lambda level: f"$10^{{{round(math.log10(level))}}}$",
            fontsize="x-small",
            manual=[_middle(path) for path in contours.get_paths()],
        )
    axes.set_title(f"{drawn.law.replace('_', ' ')} / {drawn.integrator}", fontsize="medium")
    if np.isnan(drawn.error).any():
        axes.text(
            0.97, 0.06, "refused: too few steps", transform=axes.transAxes, ha="right",
            fontsize="x-small", color="#555555",
        )  # fmt: skip
    return axes


def _middle(path: Line) -> tuple[float, float]:
    """Return the middle of the longest piece of a contour line: one label a line."""
    pieces: Any = path.to_polygons(closed_only=False)
    longest = max(pieces, key=len)
    x, y = longest[len(longest) // 2]
    return float(x), float(y)


def _bars(figure: Figure, panels: Sequence[list[Axes]], kinds: Sequence[bool]) -> None:
    """Draw the colour bars in use, each beside its rows; ``kinds`` are those of the rows."""
    words = {
        True: "error of $\\psi_2$, from\nthe exact solution",
        False: "error of $\\psi_2$, from the\nlaw's own, other limit",
    }
    for converges in dict.fromkeys(kinds):
        colours, norm = error_colours(converges)
        beside = [
            axes
            for row, kind in zip(panels, kinds, strict=True)
            if kind is converges
            for axes in row
        ]
        bar = figure.colorbar(
            ScalarMappable(norm, colours), ax=beside, extend="min", aspect=20, pad=0.02
        )
        bar.set_label(words[converges])


def model_errors(axes: Axes, models: Sequence[ModelError]) -> Axes:
    """Draw the model error of each law over chi."""
    for number, item in enumerate(models):
        look = law_style(number) | {"marker": "os^Dv<>p"[number % 8], "markersize": 3.5}
        error = np.maximum(item.error, LEAST_MODEL)  # keeps NaN
        axes.plot(item.chis, error, label=item.law.replace("_", " "), **look)
    axes.set_xscale("log")
    axes.set_yscale("log")
    least = min(float(np.nanmin(item.error)) for item in models)
    axes.set_ylim(0.7 * max(LEAST_MODEL, least), 1.5)
    axes.set_xlabel(label("chi"))
    axes.set_ylabel("model error of $\\psi_2$\nover its possible range")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    return axes


def _edges(centres: Any) -> Any:
    """Return the edges of cells half-way between centres, on a logarithmic scale."""
    logs = np.log(centres)
    middles = 0.5 * (logs[1:] + logs[:-1])
    first, last = logs[0] - (middles[0] - logs[0]), logs[-1] + (logs[-1] - middles[-1])
    return np.exp(np.concatenate([[first], middles, [last]]))
