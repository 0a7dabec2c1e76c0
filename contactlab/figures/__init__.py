"""Figures: each function takes Axes and data, and returns the Axes.

The functions choose no backend and open no window; the caller does.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactlab.numeric.names import import_on_use

if TYPE_CHECKING:
    from contactlab.figures.files import save, save_figure
    from contactlab.figures.names import name_curves
    from contactlab.figures.paper import draw_paper
    from contactlab.figures.stick_slip import draw_stick_slip
    from contactlab.outcome.style import law_style, ordered_colours, styled
    from contactlab.study.comparison_figure import laws_over_sweep
    from contactlab_fit.figures import draw_fits as draw_fits  # its folder can be taken out

__all__ = [
    "draw_paper",
    "draw_stick_slip",
    "law_style",
    "laws_over_sweep",
    "name_curves",
    "ordered_colours",
    "save",
    "save_figure",
    "styled",
]

__getattr__, __dir__ = import_on_use(
    __name__,
    {
        "draw_fits": "contactlab_fit.figures",
        "draw_paper": "figures.paper",
        "draw_stick_slip": "figures.stick_slip",
        "law_style": "outcome.style",
        "laws_over_sweep": "study.comparison_figure",
        "name_curves": "figures.names",
        "ordered_colours": "outcome.style",
        "save": "figures.files",
        "save_figure": "figures.files",
        "styled": "outcome.style",
    },
)
