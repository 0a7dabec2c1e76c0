"""Picture of stability: the steps that each law needs, over chi, in one panel."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from contactlab.figures.names import name_curves
from contactlab.outcome.style import ASIDE, label, law_style, verbatim
from contactlab.study.error_map import ErrorMap

#: Error of psi2 that is asked for, from the law's own limit.
ALLOWED = 0.01
#: The factor of the root of chi that is enough is told in multiples of this number.
ROUNDED = 5
REFUSED_COLOUR = "#DDDDDD"


def draw_least_steps(axes: Axes, maps: Sequence[ErrorMap]) -> Axes:
    """Draw the least steps with which a law stays within ``ALLOWED``, and what is enough for all.

    Parameters
    ----------
    axes : Axes
    maps : sequence of ErrorMap
    """
    lines, names = [], []
    for number, each in enumerate(maps):
        lines += axes.plot(
            each.chis,
            _least(each, each.error <= ALLOWED, np.nan),
            **(law_style(number) | {"linewidth": 1.0}),
        )
        names.append(verbatim(each.law.replace("_", " ")))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(label("chi"))
    axes.set_ylabel("steps of one contact")
    factor, beyond = enough_steps(maps)
    what = rf"keep $\psi_2$ within {ALLOWED:g} of the law's own limit"
    axes.set_title(rf"${factor:g}\,\sqrt{{\chi}}$ steps {what}" if factor else f"steps that {what}")
    if factor:
        chis = np.array(maps[0].chis)
        steps = np.maximum(factor * np.sqrt(chis), min(maps[0].steps))
        lines += axes.plot(chis, steps, color="black", linewidth=3.0)
        names.append(rf"take ${factor:g}\,\sqrt{{\chi}}$")
    if factor and beyond:
        words = "\n".join([rf"more than {max(maps[0].steps)} at some $\chi$:", *beyond])
        axes.text(0.03, 0.97, words, transform=axes.transAxes, va="top", **ASIDE)
    if maps:
        refused = np.min(
            [_least(each, np.isfinite(each.error), each.steps[-1]) for each in maps], axis=0
        )
        lowest = min(maps[0].steps)
        axes.fill_between(maps[0].chis, lowest, refused, color=REFUSED_COLOUR, linewidth=0.0)
        axes.set_ylim(lowest, None)
        axes.text(
            0.97, 0.04, "refused: too few steps", transform=axes.transAxes, ha="right", **ASIDE
        )
    name_curves(axes, lines, names)
    return axes


def enough_steps(maps: Sequence[ErrorMap]) -> tuple[int, list[str]]:
    """Return the factor of the root of chi that is enough, and the laws for which it is not.

    The factor counts laws that stay within ``ALLOWED`` at every chi with the most steps mapped; 0
    without such a law.
    """
    needs: list[float] = []
    beyond: list[str] = []
    for each in maps:
        least = _least(each, each.error <= ALLOWED, np.nan)
        if np.isnan(least).any():
            beyond.append(each.law.replace("_", " "))
            continue
        factors = least / np.sqrt(each.chis)
        needs.append(float(np.max(factors, where=least > min(each.steps), initial=0.0)))
    factor = ROUNDED * math.ceil(max(needs, default=0.0) / ROUNDED)
    return factor, beyond


def _least(drawn: ErrorMap, good: NDArray[np.bool_], beyond: float) -> NDArray[np.float64]:
    """Return the least steps from which on all are good, for each chi; ``beyond`` if none are."""
    steps = np.array([*drawn.steps, beyond], dtype=np.float64)
    from_above = np.cumprod(good[::-1], axis=0).sum(axis=0)  # rows, counted from the last
    return np.asarray(steps[len(drawn.steps) - from_above])
