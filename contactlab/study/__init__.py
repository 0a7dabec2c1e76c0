"""Studies of many runs, as data; figures and commands draw and print them."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from contactlab.impact.coupling import coupling_shift
    from contactlab.study.comparison import Comparison, compare
    from contactlab.study.paper_figures import SOLID_CHI, paper_data

__all__ = ["SOLID_CHI", "Comparison", "compare", "coupling_shift", "paper_data"]
#: Module of each public name; a module is imported on first use.
MODULES = {
    "SOLID_CHI": "contactlab.study.paper_figures",
    "Comparison": "contactlab.study.comparison",
    "compare": "contactlab.study.comparison",
    "coupling_shift": "contactlab.impact.coupling",
    "paper_data": "contactlab.study.paper_figures",
}


def __getattr__(name: str) -> Any:
    """Return a public name, imported on first use."""
    if name not in MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(MODULES[name]), name)
