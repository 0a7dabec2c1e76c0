"""Error over run time on logarithmic scales, with the Pareto front."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactlab.figures.style import ASIDE, LAW_COLOURS, NARROW, QUIET, figure_width
from contactlab.study.work_precision import Benchmark

MARKERS = {"paper": "o", "symplectic": "s", "adaptive": "D", "events": "*"}
#: Name in place of an integrator for laws that answer whole impacts.
NONE = "none needed"
#: Least error drawn; smaller ones are rounding.
FLOOR = 1e-12


def work_precision(axes: Axes, benchmark: Benchmark) -> Axes:
    """Draw error over run time of each method: colours are laws, markers are integrators.

    A second law of one colour has dashes and hollow markers.
    """
    laws = list(dict.fromkeys(row.method.partition(" / ")[0] for row in benchmark.rows))
    for method in dict.fromkeys(row.method for row in benchmark.rows):
        law, _, integrator = method.partition(" / ")
        rows = [row for row in benchmark.rows if row.method == method]
        axes.plot(
            [row.time_s * 1e3 for row in rows],
            [max(row.error_rms, FLOOR) if row.ok else np.nan for row in rows],
            linewidth=1.1,
            **_line(laws.index(law)),
            **_mark(integrator),
        )
    front = benchmark.front()
    axes.plot(
        [row.time_s * 1e3 for row in front],
        [max(row.error_rms, FLOOR) for row in front],
        color=QUIET,
        linewidth=6.0,
        alpha=0.35,
        solid_capstyle="round",
        zorder=0,
    )
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("run time of one impact (ms)")
    axes.set_ylabel(r"error of $\psi_2$, rms over the scenes")
    if any(row.ok and row.error_rms <= FLOOR for row in benchmark.rows):
        axes.annotate(
            f"≤ {FLOOR:.0e}: rounding", (0.01, FLOOR), xycoords=("axes fraction", "data"),
            va="center", **ASIDE,
        )  # fmt: skip
    _legends(axes, [row.method for row in benchmark.rows])
    return axes


def _legends(axes: Axes, methods: list[str]) -> None:
    """Draw the legends of laws and of integrators."""
    laws = list(dict.fromkeys(method.partition(" / ")[0] for method in methods))
    integrators = {method.partition(" / ")[2] for method in methods}
    whole = [method for method in methods if " / " not in method]
    colours: list[Any] = [
        Line2D(
            [],
            [],
            label=law.replace("_", " "),
            **_line(place),
            **(_mark("") if law in whole else {}),
        )
        for place, law in enumerate(laws)
    ]
    markers: list[Any] = [
        Line2D([], [], color=QUIET, linestyle="", label=name or NONE, **_mark(name))
        for name in sorted(integrators, reverse=True)
    ]
    markers.append(Line2D([], [], color=QUIET, linewidth=6.0, alpha=0.35, label="Pareto front"))
    if figure_width(axes) < NARROW:
        below: dict[str, Any] = {"alignment": "left", "borderaxespad": 0.0}
        first = axes.legend(
            handles=markers, title="integrator", loc="upper right", bbox_to_anchor=(1.0, -0.25),
            **below,
        )  # fmt: skip
        axes.add_artist(first)
        axes.legend(
            handles=colours, title="law", loc="upper left", bbox_to_anchor=(-0.15, -0.25), **below
        )
        return
    beside: dict[str, Any] = {"bbox_to_anchor": (1.0, 0.5), "alignment": "left"}
    # The layout makes room for the last legend only: draw the wider one last.
    first = axes.legend(handles=markers, title="integrator", loc="upper left", **beside)
    axes.add_artist(first)
    axes.legend(handles=colours, title="law", loc="lower left", **beside)


def _line(place: int) -> dict[str, Any]:
    """Return the look of the law at ``place``."""
    colour = LAW_COLOURS[place % len(LAW_COLOURS)]
    if place // len(LAW_COLOURS) % 2:
        return {"color": colour, "linestyle": "--", "markerfacecolor": "white"}
    return {"color": colour, "linestyle": "-"}


def _mark(integrator: str) -> dict[str, Any]:
    """Return the look of an integrator."""
    size = 9.0 if integrator == "events" else 4.5
    return {"marker": MARKERS.get(integrator, "^"), "markersize": size}
