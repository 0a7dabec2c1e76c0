"""Fits of laws and scenes to measured impacts: estimates, intervals, ranking of laws."""

from contactlab.fitting.beside import with_measurements
from contactlab.fitting.estimation import Ranked, fit, in_order, rank
from contactlab.fitting.fit_result import Estimate, Fit
from contactlab.fitting.flight import read_flight
from contactlab.fitting.measurements import Measurements, read_measurements

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
