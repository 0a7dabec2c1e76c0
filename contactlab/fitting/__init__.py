"""Fits of laws and scenes to measured impacts: estimates, intervals, ranking of laws."""

from contactlab.fitting.estimation import fit
from contactlab.fitting.measurements import (
    Measurements,
    read_measurements,
    with_measurements,
)
from contactlab.fitting.outcome import Estimate, Fit
from contactlab.fitting.ranking import Ranked, in_order, rank

__all__ = [
    "Estimate",
    "Fit",
    "Measurements",
    "Ranked",
    "fit",
    "in_order",
    "rank",
    "read_measurements",
    "with_measurements",
]
