"""Laws side by side: the answers above, what parts them below."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from contactlab.analysis.compare import Agreement, Comparison
from contactlab.analysis.paper_figures import scaled_forces
from contactlab.figures.style import (
    MEASURED_COLOUR,
    friction_limit,
    label,
    law_style,
    verbatim,
    zero_line,
)
from contactlab.quantities import QUANTITIES
from contactlab.scene_file.entries import entry_unit

POINTS: dict[str, Any] = {
    "color": MEASURED_COLOUR, "linestyle": "none", "marker": "o", "markersize": 4.5,
    "markerfacecolor": "white", "markeredgewidth": 1.1, "elinewidth": 0.9, "capsize": 2.0,
    "zorder": 5,
}  # fmt: skip


def laws_over_sweep(
    axes: Axes, comparison: Comparison, quantity: str, agreement: Agreement | None = None
) -> Axes:
    """Draw a quantity over the sweep, one curve a law, with measured points if there are any.

    Parameters
    ----------
    axes : Axes
    comparison : Comparison
        Of a sweep.
    quantity : str
        By its name in ``contactlab.quantities``.
    agreement : Agreement, optional
        With measured values, drawn too.
    """
    varied, x = _abscissa(comparison, agreement)
    for number, name in enumerate(comparison.names):
        axes.plot(x, comparison.values(quantity, name), label=verbatim(name), **law_style(number))
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
        By its name in ``contactlab.quantities``.
    agreement : Agreement, optional
        With measured values, drawn too.
    """
    varied, x = _abscissa(comparison, agreement)
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
            axes.plot(x, comparison.difference(quantity, name), **style)
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
    axes.set_xlabel(r"time over duration of contact $t/t_{\mathrm{c}}$")
    axes.set_ylabel(r"tangential force $F/(\mu P_{\max})$")
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(-1.05, 1.05)
    axes.legend(loc="lower left")
    return axes


def _abscissa(comparison: Comparison, agreement: Agreement | None) -> tuple[str, Any]:
    """Return what to draw against: what the measurement varied, or the sweep's first entry."""
    name = agreement.measured.against if agreement else next(iter(comparison.varied))
    if name in comparison.varied:
        return name, np.asarray(comparison.varied[name])
    return name, np.full(comparison.scene.shape, np.nan)
