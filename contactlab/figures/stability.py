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
from matplotlib.patches import Patch

from contactlab.analysis.stability_map import Region
from contactlab.figures.style import ORDERED_MAP, QUIET, RESOLUTION, styled

#: Errors over the range at which the colour changes: whole decades.
DECADES = (1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0)
WRONG_COLOUR, REFUSED_COLOUR = "#D00000", "#E4E4E4"
COLUMNS, PANEL_WIDTH, PANEL_HEIGHT = 4, 2.5, 2.2


def draw_regions(path: Path, regions: Sequence[Region]) -> None:
    """Draw a panel a method and write a PNG."""
    with styled():
        columns = min(COLUMNS, len(regions))
        rows = math.ceil(len(regions) / columns)
        size = (PANEL_WIDTH * columns + 1.0, PANEL_HEIGHT * rows + 0.9)
        figure = Figure(figsize=size)
        FigureCanvasAgg(figure)
        panels = figure.subplots(rows, columns, squeeze=False, sharex=True)
        image = None
        for place, axes in enumerate(panels.flat):
            if place >= len(regions):
                axes.set_visible(False)
                continue
            image = usable_region(axes, regions[place])
            last = place + columns >= len(regions)
            axes.tick_params(labelbottom=last)
            if last:
                axes.set_xlabel(r"inertia ratio $\chi$")
        assert image is not None
        bar = figure.colorbar(image, ax=panels, extend="both", ticks=DECADES, pad=0.015)
        bar.set_label(r"worst error of $\psi_2$, over its possible range")
        entries = [
            Patch(facecolor=REFUSED_COLOUR, edgecolor=QUIET, hatch="////", label="refused"),
            Patch(color=WRONG_COLOUR, label="silently wrong"),
        ]
        figure.legend(handles=entries, loc="outside upper center", ncols=2)
        figure.savefig(path, dpi=RESOLUTION)


def usable_region(axes: Axes, region: Region) -> Any:
    """Draw one method's region: colour is error, hatching refusal, red a silent wrong.

    Returns
    -------
    The mesh, for a colour bar.
    """
    tolerance = region.word == "tolerance"
    fineness = np.array(region.resolutions)
    chi, fine = _edges(np.array(region.chis)), _edges(fineness)
    colours = mpl.colormaps[ORDERED_MAP + "_r"]
    norm = BoundaryNorm(DECADES, colours.N, extend="both")
    answered = np.where(region.state == 0, region.error, np.nan)
    mesh = axes.pcolormesh(chi, fine, answered, cmap=colours, norm=norm)
    refused = np.ma.masked_where(region.state != 1, np.ones(region.state.shape))
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
    wrong = np.ma.masked_where(region.state != 2, np.ones(region.state.shape))
    axes.pcolormesh(chi, fine, wrong, cmap=mpl.colors.ListedColormap([WRONG_COLOUR]))
    axes.set_xscale("log")
    axes.set_yscale("log")
    if tolerance:
        axes.invert_yaxis()
    axes.set_title(region.method, fontsize=10.0)
    axes.set_ylabel(region.word)
    return mesh


def _edges(centres: Any) -> Any:
    """Return cell edges half-way between centres, on a logarithmic scale."""
    logs = np.log(centres)
    middles = 0.5 * (logs[1:] + logs[:-1])
    first, last = logs[0] - (middles[0] - logs[0]), logs[-1] + (logs[-1] - middles[-1])
    return np.exp(np.concatenate([[first], middles, [last]]))
