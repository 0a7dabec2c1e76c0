"""Rounds of panels until every impact of an array has ended."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab.collocation import lobatto
from contactlab.contracts import ClosedFormMotion
from contactlab_fronts.many import edge_slip, stuck
from contactlab_fronts.many.impacts import DONE, EDGE_SLIP, GROSS_SLIP, STUCK, Impacts

Array = NDArray[np.float64]

#: Impacts in one call: an array of 8 nodes of them fits in the cache next to the processor.
BLOCK = 2000
#: Rounds: an impact takes some 30, and as sqrt(chi) for large chi; about ten times that.
ROUNDS, ROUNDS_PER_SWING = 200, 40


def march(velocity: Array, inertia: Array, motion: ClosedFormMotion, tolerance: float) -> Impacts:
    """Return impacts of scaled velocity > 0, followed to their end; unfinished if given up."""
    impacts = Impacts(velocity, inertia, motion, lobatto(stuck.NODES))
    swings = np.sqrt(0.5 * inertia.max(initial=0.0) * motion.scaled_mass)
    with np.errstate(under="ignore"):
        for _ in range(ROUNDS + int(ROUNDS_PER_SWING * swings)):
            if not _round(impacts, tolerance):
                break
    impacts.doing[~np.isfinite(impacts.change + impacts.work)] = STUCK
    return impacts


def _round(impacts: Impacts, tolerance: float) -> bool:
    """Take every impact one panel further; return whether any was left."""
    sliding = np.flatnonzero(impacts.doing == GROSS_SLIP)
    if sliding.size:
        impacts.slide_through(sliding)
    sticking = np.flatnonzero(impacts.doing == STUCK)
    for first in range(0, sticking.size, BLOCK):
        stuck.advance(impacts, sticking[first : first + BLOCK])
    slipping = np.flatnonzero(impacts.doing == EDGE_SLIP)
    if not slipping.size:
        return bool(np.any(impacts.doing < DONE))
    laid = impacts.pieces["sign"][impacts.outermost[slipping]] == 0.0
    fitted = impacts.fitted[slipping]
    for is_laid in (False, True):
        for fit in (False, True):
            who = slipping[(laid == is_laid) & (fitted == fit)]
            for first in range(0, who.size, BLOCK):
                part = who[first : first + BLOCK]
                edge_slip.advance(impacts, part, tolerance, laid=is_laid, fitted=fit)
    return True
