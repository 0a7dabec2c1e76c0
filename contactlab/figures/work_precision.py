"""Error against run time, log-log, with the Pareto front."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from contactlab.analysis.work_precision import Benchmark
from contactlab.figures.style import LAW_COLOURS, QUIET

MARKERS = {"paper": "o", "symplectic": "s", "adaptive": "D", "events": "*"}
#: Errors below this are drawn at it: the axis would otherwise be all rounding.
FLOOR = 1e-12


def work_precision(axes: Axes, benchmark: Benchmark) -> Axes:
    """Draw each method's ladder: colour is the law, marker the integrator; lower left is better."""
    laws = list(dict.fromkeys(row.method.partition(" / ")[0] for row in benchmark.rows))
    for method in dict.fromkeys(row.method for row in benchmark.rows):
        law, _, integrator = method.partition(" / ")
        rows = [row for row in benchmark.rows if row.method == method]
        order = benchmark.orders.get(method, np.nan)
        place = laws.index(law)
        axes.plot(
            [row.time_s * 1e3 for row in rows],
            [max(row.error_rms, FLOOR) if row.ok else np.nan for row in rows],
            color=LAW_COLOURS[place % len(LAW_COLOURS)],
            linestyle=("-", "--")[place // len(LAW_COLOURS) % 2],
            linewidth=1.1,
            marker=MARKERS.get(integrator, "^"),
            markersize=9.0 if integrator == "events" else 4.5,
            label=f"{law}, {integrator}" + (f"  (order {order:.1f})" if order == order else ""),
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
        label="Pareto front",
    )
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("run time of one impact (ms)")
    axes.set_ylabel(r"error of $\psi_2$, rms over the scenes")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=8.5)
    return axes
