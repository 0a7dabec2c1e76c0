"""The map of usable regions: resolution against chi, a panel a method."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from contactlab.analysis.stability_cases import LIMIT
from contactlab.analysis.stability_map import (
    ALL_ANSWERED,
    ONE_RAISED,
    ONE_REFUSED,
    ONE_WRONG,
    Region,
)
from contactlab.figures.files import save_figure
from contactlab.figures.style import ORDERED_MAP, QUIET, styled

#: Errors over the range at which the colour changes: whole decades.
DECADES = (1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0)
WRONG_COLOUR, RAISED_COLOUR = "#D00000", "#F08000"
REFUSED_COLOUR, UNTRIED_COLOUR = "#E4E4E4", "#FBF3E4"
PANEL_WIDTH, PANEL_HEIGHT = 2.4, 2.0
LIMIT_LOOK: Any = {"color": "black", "linestyle": (0, (4, 2)), "linewidth": 1.1}


def draw_regions(path: Path, regions: Sequence[Region]) -> None:
    """Draw a panel a method and write a PNG."""
    found = {tuple(region.method.split(" / ")): region for region in regions}
    laws = list(dict.fromkeys(law for law, _ in found))
    integrators = sorted({name for _, name in found}, key=_rank)
    lowest = {name: law for law in laws for name in integrators if (law, name) in found}
    with styled():
        rows, columns = len(laws), len(integrators)
        figure = Figure(figsize=(PANEL_WIDTH * columns + 1.3, PANEL_HEIGHT * rows + 1.0))
        FigureCanvasAgg(figure)
        panels = figure.subplots(rows, columns, squeeze=False, sharex=True)
        image = None
        for row, law in enumerate(laws):
            for column, integrator in enumerate(integrators):
                axes, region = panels[row, column], found.get((law, integrator))
                if region is None:
                    _empty(axes)
                else:
                    image = usable_region(axes, region)
                if row == 0:
                    axes.set_title(integrator)
                if law == lowest[integrator]:
                    axes.set_xlabel(r"inertia ratio $\chi$")
                    axes.tick_params(labelbottom=True)
            panels[row, 0].annotate(
                law.replace("_", " "), (-0.42, 0.5), xycoords="axes fraction", rotation=90,
                ha="center", va="center", fontsize=12.0,
            )  # fmt: skip
        assert image is not None
        bar = figure.colorbar(
            image, ax=panels, extend="both", ticks=DECADES, shrink=0.6, aspect=30, pad=0.02
        )
        bar.set_ticklabels([f"$10^{{{round(math.log10(error))}}}$" for error in DECADES])
        bar.set_label(r"worst error of $\psi_2$, over its possible range")
        entries: list[Any] = [
            Patch(facecolor=REFUSED_COLOUR, edgecolor=QUIET, hatch="////",
                  label="refused (by default: refined)"),
            Patch(color=WRONG_COLOUR, label="silently wrong"),
            Patch(facecolor=UNTRIED_COLOUR, edgecolor=QUIET, label="not tried, takes too long"),
            Line2D([], [], label="stability limit", **LIMIT_LOOK),
        ]  # fmt: skip
        if any(np.any(region.state == ONE_RAISED) for region in regions):
            entries.insert(2, Patch(color=RAISED_COLOUR, label="raised"))
        figure.legend(handles=entries, loc="outside upper center", ncols=2)
        save_figure(figure, path)


def _rank(integrator: str) -> tuple[int, str]:
    known = ("paper", "symplectic", "adaptive", "events")
    return (known.index(integrator) if integrator in known else len(known)), integrator


def _empty(axes: Axes) -> None:
    """Say that law and integrator do not fit."""
    axes.text(0.5, 0.5, "does not fit", transform=axes.transAxes, ha="center", color=QUIET)
    axes.set_yticks([])
    axes.tick_params(which="both", bottom=False, labelbottom=False)
    axes.spines[:].set_visible(False)


def usable_region(axes: Axes, region: Region) -> Any:
    """Draw one method's region: error in colour, refusal hatched, silent wrong red, raise orange.

    Returns
    -------
    The mesh, for a colour bar.
    """
    tolerance = region.word == "tolerance"
    fineness = np.array(region.resolutions)
    chi, fine = _edges(np.array(region.chis)), _edges(fineness)
    colours = mpl.colormaps[ORDERED_MAP + "_r"]
    norm = BoundaryNorm(DECADES, colours.N, extend="both")
    axes.set_facecolor(UNTRIED_COLOUR)
    answered = np.where(region.state == ALL_ANSWERED, region.error, np.nan)
    mesh = axes.pcolormesh(chi, fine, answered, cmap=colours, norm=norm)
    refused = np.ma.masked_where(region.state != ONE_REFUSED, np.ones(region.state.shape))
    axes.pcolor(
        chi,
        fine,
        refused,
        facecolor=REFUSED_COLOUR,
        edgecolor=QUIET,
        hatch="////",
        linewidth=0.0,
        cmap=mpl.colors.ListedColormap([REFUSED_COLOUR]),
    )
    for state, colour in ((ONE_WRONG, WRONG_COLOUR), (ONE_RAISED, RAISED_COLOUR)):
        failed = np.ma.masked_where(region.state != state, np.ones(region.state.shape))
        axes.pcolormesh(chi, fine, failed, cmap=mpl.colors.ListedColormap([colour]))
    axes.set_xscale("log")
    axes.set_yscale("log")
    if tolerance:
        axes.invert_yaxis()
    elif region.error.size and not region.method.startswith("coulomb"):
        # omega dt = 2, theory §4; a rigid body has no stiffness.
        axes.plot(chi, LIMIT * np.sqrt(chi), **LIMIT_LOOK)
        axes.set_ylim(fine[0], fine[-1])
    axes.set_ylabel(region.word)
    return mesh


def _edges(centres: Any) -> Any:
    """Return cell edges half-way between centres, on a logarithmic scale."""
    logs = np.log(centres)
    middles = 0.5 * (logs[1:] + logs[:-1])
    first, last = logs[0] - (middles[0] - logs[0]), logs[-1] + (logs[-1] - middles[-1])
    return np.exp(np.concatenate([[first], middles, [last]]))
