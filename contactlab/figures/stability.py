"""Stability map: resolution over chi in a panel for each method; model errors below.

Numerical error and model error are drawn apart. A panel shows the distance of a method from the
exact solution of its law. Laws that do not converge to the elastic continuum have other colours,
so that a fine step of a rough model does not look like an accurate answer.
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
from matplotlib.colors import BoundaryNorm, Colormap, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from contactlab.figures.files import save_figure
from contactlab.figures.style import (
    ORDERED_MAP,
    QUIET,
    WIDTHS,
    Look,
    Width,
    label,
    law_style,
    styled,
)
from contactlab.study.model_error import ModelError
from contactlab.study.stability import Stability
from contactlab.study.stability_cases import LIMIT
from contactlab.study.stability_map import (
    ALL_ANSWERED,
    ONE_RAISED,
    ONE_REFUSED,
    ONE_WRONG,
    Region,
)

#: Errors over the range of psi2 at which the colour changes: whole decades.
DECADES = (1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0)
#: Colours for laws that do not converge to the continuum, without the palest, which are white.
MODEL_MAP, MODEL_BEGIN = "Purples", 0.3
WRONG_COLOUR, RAISED_COLOUR = "#D00000", "#F08000"
REFUSED_COLOUR, UNTRIED_COLOUR = "#E4E4E4", "#FBF3E4"
PANEL_WIDTH, PANEL_HEIGHT, MODELS_HEIGHT = 2.4, 2.0, 2.6
#: Look of answers without a known exact solution.
UNKNOWN_LOOK: Any = {"edgecolor": QUIET, "hatch": "...."}
LIMIT_LOOK: Any = {"color": "black", "linestyle": (0, (4, 2)), "linewidth": 1.1}
#: Offset of the name of a law from the left edge of its panel, in points: beyond ticks and label.
NAME_PLACE = (-58.0, 0.0)
#: Least model error drawn; smaller ones, from slip throughout, are rounding.
LEAST_MODEL = 1e-6


def draw_stability(
    path: Path, found: Stability, *, look: Look = "print", width: Width | None = None
) -> None:
    """Draw a panel for each method and the model errors below, and write a picture.

    Parameters
    ----------
    path : Path
    found : Stability
    look : {"print", "slides"}
    width : {"two"}, optional
        Columns of a page that the picture fills; one is too narrow for the panels.
    """
    regions = {tuple(region.method.split(" / ")): region for region in found.regions}
    laws = list(dict.fromkeys(law for law, _ in regions))
    integrators = sorted({name for _, name in regions}, key=_rank)
    rows, columns = len(laws), max(len(integrators), 2)
    below = bool(found.models)
    with styled(look, width):
        across, up = PANEL_WIDTH * columns + 1.3, PANEL_HEIGHT * rows + MODELS_HEIGHT * below + 1.0
        scale = 1.0 if width is None else WIDTHS[width] / across
        figure = Figure(figsize=(scale * across, scale * up))
        FigureCanvasAgg(figure)
        heights = [PANEL_HEIGHT] * rows + [MODELS_HEIGHT] * below
        grid = figure.add_gridspec(rows + below, columns, height_ratios=heights)
        if rows:
            panels = np.array(
                [[figure.add_subplot(grid[i, j]) for j in range(len(integrators))]
                 for i in range(rows)]
            )  # fmt: skip
            _fill(panels, regions, laws, integrators)
            _bars(figure, panels, found.regions)
            _legend(figure, found.regions)
        if below:
            model_errors(figure.add_subplot(grid[rows, :]), found.models)
        save_figure(figure, path)


def _fill(panels: Any, regions: Any, laws: Sequence[str], integrators: Sequence[str]) -> None:
    """Draw the regions in their panels."""
    lowest = {name: law for law in laws for name in integrators if (law, name) in regions}
    for row, law in enumerate(laws):
        for column, integrator in enumerate(integrators):
            axes, region = panels[row, column], regions.get((law, integrator))
            if region is None:
                _empty(axes)
            else:
                usable_region(axes, region)
                axes.tick_params(labelbottom=law == lowest[integrator])
            if row == 0:
                axes.set_title(integrator)
            if law == lowest[integrator]:
                axes.set_xlabel(label("chi"))
        panels[row, 0].annotate(
            law.replace("_", " "), (0.0, 0.5), xycoords="axes fraction", xytext=NAME_PLACE,
            textcoords="offset points", rotation=90, ha="center", va="center", fontsize="large",
        )  # fmt: skip


def _bars(figure: Figure, panels: Any, regions: Sequence[Region]) -> None:
    """Draw the colour bars in use, one below the other."""
    words = {
        True: "numerical error of $\\psi_2$\nover its range, from\nthe exact solution",
        False: "numerical error of $\\psi_2$\nover its range, from the\nlaw's own, other limit",
    }
    shown = [key for key in words if any(item.converges is key for item in regions)]
    parts = np.array_split(np.arange(len(panels)), len(shown))
    for converges, rows in zip(shown, parts, strict=True):
        colours, norm = error_colours(converges)
        bar = figure.colorbar(
            ScalarMappable(norm, colours), ax=list(panels[rows if len(rows) else slice(None)].flat),
            extend="both", ticks=DECADES, shrink=0.9, aspect=25, pad=0.02,
        )  # fmt: skip
        bar.set_ticklabels([f"$10^{{{round(math.log10(error))}}}$" for error in DECADES])
        bar.set_label(words[converges])


def _legend(figure: Figure, regions: Sequence[Region]) -> None:
    """Draw the legend of the colours that are no errors."""
    entries: list[Any] = [
        Patch(facecolor=REFUSED_COLOUR, edgecolor=QUIET, hatch="////",
              label="refused (by default: refined)"),
        Patch(color=WRONG_COLOUR, label="silently wrong"),
        Patch(facecolor=UNTRIED_COLOUR, edgecolor=QUIET, label="not tried, takes too long"),
        Patch(facecolor="white", label="answered, its limit not known", **UNKNOWN_LOOK),
        Line2D([], [], label="stability limit", **LIMIT_LOOK),
    ]  # fmt: skip
    if any(np.any(region.state == ONE_RAISED) for region in regions):
        entries.insert(2, Patch(color=RAISED_COLOUR, label="raised"))
    figure.legend(handles=entries, loc="outside upper center", ncols=3)


def _rank(integrator: str) -> tuple[int, str]:
    """Return the sort key of an integrator: built-in ones first, then by name."""
    order = ("paper", "symplectic", "adaptive", "events")
    return (order.index(integrator) if integrator in order else len(order)), integrator


def _empty(axes: Axes) -> None:
    """Draw the words for a law and an integrator that do not fit."""
    axes.text(0.5, 0.5, "does not fit", transform=axes.transAxes, ha="center", color=QUIET)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(False)


def error_colours(converges: bool) -> tuple[Colormap, BoundaryNorm]:
    """Return colours of numerical errors, for laws that converge to the continuum or do not."""
    colours: Colormap = mpl.colormaps[ORDERED_MAP + "_r"]
    if not converges:
        shades = mpl.colormaps[MODEL_MAP](np.linspace(MODEL_BEGIN, 1.0, colours.N))
        colours = ListedColormap(shades, name="model")
    return colours, BoundaryNorm(DECADES, colours.N, extend="both")


def usable_region(axes: Axes, region: Region) -> Axes:
    """Draw the region of a method: errors coloured, refused hatched, wrong red, raised orange.

    Parameters
    ----------
    axes : Axes
    region : Region
        The colours of its errors are ``error_colours(region.converges)``.
    """
    tolerance = region.word == "tolerance"
    fineness = np.array(region.resolutions)
    chi, fine = _edges(np.array(region.chis)), _edges(fineness)
    colours, norm = error_colours(region.converges)
    axes.set_facecolor(UNTRIED_COLOUR)
    answered = np.where(region.state == ALL_ANSWERED, region.error, np.nan)
    axes.pcolormesh(chi, fine, answered, cmap=colours, norm=norm)
    refused = np.ma.masked_where(region.state != ONE_REFUSED, np.ones(region.state.shape))
    axes.pcolor(
        chi,
        fine,
        refused,
        facecolor=REFUSED_COLOUR,
        edgecolor=QUIET,
        hatch="////",
        linewidth=0.0,
        cmap=ListedColormap([REFUSED_COLOUR]),
    )
    unknown = np.ma.masked_where(
        (region.state != ALL_ANSWERED) | np.isfinite(region.error), np.ones(region.state.shape)
    )
    axes.pcolor(chi, fine, unknown, cmap=ListedColormap(["white"]), linewidth=0.0, **UNKNOWN_LOOK)
    for state, colour in ((ONE_WRONG, WRONG_COLOUR), (ONE_RAISED, RAISED_COLOUR)):
        failed = np.ma.masked_where(region.state != state, np.ones(region.state.shape))
        axes.pcolormesh(chi, fine, failed, cmap=ListedColormap([colour]))
    axes.set_xscale("log")
    axes.set_yscale("log")
    if tolerance:
        axes.invert_yaxis()
    else:
        # The stability limit is omega dt = 2, theory §4.
        axes.plot(chi, LIMIT * np.sqrt(chi), **LIMIT_LOOK)
        axes.set_ylim(fine[0], fine[-1])
    axes.set_ylabel(region.word)
    return axes


def model_errors(axes: Axes, models: Sequence[ModelError]) -> Axes:
    """Draw the model error of each law over chi."""
    for number, item in enumerate(models):
        look = law_style(number) | {"marker": "os^Dv<"[number % 6], "markersize": 3.5}
        error = np.maximum(item.error, LEAST_MODEL)  # keeps NaN
        axes.plot(item.chis, error, label=item.law.replace("_", " "), **look)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(0.7 * LEAST_MODEL, 1.5)
    axes.set_xlabel(label("chi"))
    axes.set_ylabel("model error of $\\psi_2$\nover its possible range")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    return axes


def _edges(centres: Any) -> Any:
    """Return the edges of cells half-way between centres, on a logarithmic scale."""
    logs = np.log(centres)
    middles = 0.5 * (logs[1:] + logs[:-1])
    first, last = logs[0] - (middles[0] - logs[0]), logs[-1] + (logs[-1] - middles[-1])
    return np.exp(np.concatenate([[first], middles, [last]]))
