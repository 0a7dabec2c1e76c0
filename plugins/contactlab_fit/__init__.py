"""Fits of laws and scenes to measured impacts: estimates, intervals, ranking of laws."""

from __future__ import annotations

from typing import TYPE_CHECKING

from contactlab.numeric.names import import_on_use

if TYPE_CHECKING:
    from contactlab_fit.beside import with_measurements
    from contactlab_fit.estimation import Ranked, fit, in_order, rank
    from contactlab_fit.fit_result import Estimate, Fit
    from contactlab_fit.flight import read_flight
    from contactlab_fit.measurements import Measurements, read_measurements

__all__ = [
    "Estimate",
    "Fit",
    "Measurements",
    "Ranked",
    "fit",
    "in_order",
    "rank",
    "read_flight",
    "read_measurements",
    "with_measurements",
]

MODULES = {
    "Estimate": "fit_result",
    "Fit": "fit_result",
    "Measurements": "measurements",
    "Ranked": "estimation",
    "fit": "estimation",
    "in_order": "estimation",
    "rank": "estimation",
    "read_flight": "flight",
    "read_measurements": "measurements",
    "with_measurements": "beside",
}
__getattr__, __dir__ = import_on_use(
    __name__, {name: f"contactlab_fit.{module}" for name, module in MODULES.items()}
)
