"""Studies of many runs, as data; figures and commands draw and print them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactlab.numeric.names import import_on_use

if TYPE_CHECKING:
    from contactlab.impact.coupling import coupling_shift
    from contactlab.study.comparison import Comparison, compare
    from contactlab.study.paper_figures import SOLID_CHI, paper_data

__all__ = ["SOLID_CHI", "Comparison", "compare", "coupling_shift", "paper_data"]

__getattr__, __dir__ = import_on_use(
    __name__,
    {
        "SOLID_CHI": "study.paper_figures",
        "Comparison": "study.comparison",
        "compare": "study.comparison",
        "coupling_shift": "impact.coupling",
        "paper_data": "study.paper_figures",
    },
)
