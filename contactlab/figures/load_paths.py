"""Hysteresis loops: friction force over displacement."""

from __future__ import annotations

from collections.abc import Mapping

from matplotlib.axes import Axes

from contactlab.numeric.types import Array
from contactlab.outcome.style import law_style, verbatim, zero_line


def draw_loops(axes: Axes, curves: Mapping[str, tuple[Array, Array]], *, title: str = "") -> Axes:
    """Draw friction force over displacement, one curve for each law.

    Parameters
    ----------
    axes : Axes
    curves : mapping of str to (array, array)
        Displacement over that of gross slip, and F/(mu P_max), by the name of the law.
    title : str
        Above the axes.
    """
    zero_line(axes)
    for number, (name, (displacement, force)) in enumerate(curves.items()):
        axes.plot(displacement, force, label=verbatim(name), **law_style(number))
    axes.set_xlabel(r"displacement over that of gross slip $D/D_{\mathrm{s}}$")
    axes.set_ylabel(r"friction force $F/(\mu P_{\max})$")
    if title:
        axes.set_title(title)
    return axes
