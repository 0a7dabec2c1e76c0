"""Picture of measured slopes: each row with its error bar, and a line for each law."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from contactlab.figures.files import Panels, save
from contactlab.outcome.style import QUIET, law_style, verbatim
from contactlab.study.by_row import ByRow
from contactlab.study.comparison_figure import POINTS

#: Laws in the picture, if installed, and what each takes for granted.
DRAWN = {
    "fronts": "elastic",
    "springs, viscoelastic": "one loss for pressure and shear",
    "annulus, viscoelastic": "loss in pressure alone",
    "mindlin_cap, viscoelastic": "one spring with a cap",
}
#: Height of a panel beside that of its rows, in rows.
HEAD = 2.0
#: beta0 drawn: an impact that grips and one that slips.
RANGE = (-0.2, 0.8)


def draw_slopes(path: Path, sets: Sequence[ByRow]) -> None:
    """Draw the measured slopes of each set in a panel, by size, with the laws of ``DRAWN``.

    Parameters
    ----------
    path : Path
    sets : sequence of ByRow
        Sets of slopes beta0.
    """

    def draw(axes: Panels) -> None:
        for panel, one in zip(axes[:, 0], sets, strict=True):
            _panel(panel, one)
        axes[-1, 0].set_xlabel(r"slope $\beta_0 = -\psi_2/\psi_1$")
        axes[0, 0].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))

    heights = tuple(len(one.rows) + HEAD for one in sets)
    save(path, draw, rows=len(sets), heights=heights, wide=True)


def _panel(axes: Axes, one: ByRow) -> None:
    order = np.argsort(one.values)
    places = np.arange(len(order))
    for number, (law, words) in enumerate(DRAWN.items()):
        if law in one.laws:
            look = law_style(number) | {"linewidth": 1.3, "marker": ".", "markersize": 5.0}
            name = verbatim(f"{words}\n({law})")
            axes.plot(one.laws[law][order], places, label=name, **look)
    axes.errorbar(one.values[order], places, xerr=one.errors[order], label="measured", **POINTS)
    axes.set_yticks(places, [verbatim(one.rows[place]) for place in order], fontsize="small")
    axes.set_ylim(-0.6, len(order) - 0.4)
    axes.set_xlim(*RANGE)
    axes.set_title(verbatim(one.title), fontsize="small", loc="left")
    axes.axvline(0.0, color=QUIET, linewidth=0.8, zorder=0)
