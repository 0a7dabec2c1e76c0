"""Figures: each function takes Axes and data, and returns the Axes.

The functions choose no backend and open no window; the caller does.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from contactlab.figures.comparison import laws_over_sweep
    from contactlab.figures.files import save, save_figure
    from contactlab.figures.fitting import draw_fits
    from contactlab.figures.names import name_curves
    from contactlab.figures.paper import draw_paper
    from contactlab.figures.stick_slip import draw_stick_slip
    from contactlab.figures.style import law_style, ordered_colours, styled

__all__ = [
    "draw_fits",
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
#: Module of each public name; a module is imported on first use.
MODULES = {
    "draw_fits": "fitting",
    "draw_paper": "paper",
    "draw_stick_slip": "stick_slip",
    "law_style": "style",
    "laws_over_sweep": "comparison",
    "name_curves": "names",
    "ordered_colours": "style",
    "save": "files",
    "save_figure": "files",
    "styled": "style",
}


def __getattr__(name: str) -> Any:
    """Return a public name, imported on first use."""
    if name not in MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{MODULES[name]}"), name)
