"""Rounds of panels until every impact of a chunk has ended."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab_fronts.many import edge_slip, stuck
from contactlab_fronts.many.impacts import (
    DONE,
    EDGE_SLIP,
    GROSS_SLIP,
    STUCK,
    Impacts,
)
from contactlab_fronts.many.pieces import LAID

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Impacts in one call: an array of 8 nodes of them fits in the cache next to the processor.
BLOCK = 2000
#: Rounds: an impact takes some 30, and as sqrt(chi) for large chi; about ten times that.
ROUNDS, ROUNDS_PER_SWING = 200, 40


def march(psi1: Array, chi: Array, tolerance: float) -> tuple[Array, Flags]:
    """Return (psi2 - psi1, solved) of impacts that do not slip throughout, psi1 > 0."""
    impacts = Impacts(psi1, chi, stuck.NODES)
    rounds = ROUNDS + int(ROUNDS_PER_SWING * np.sqrt(chi.max()))
    with np.errstate(under="ignore"):
        for _ in range(rounds):
            if not _round(impacts, tolerance):
                break
    return impacts.change, (impacts.doing == DONE) & np.isfinite(impacts.change)


def _round(impacts: Impacts, tolerance: float) -> bool:
    """Take every impact one panel further; return whether any was left."""
    impacts.slide_through(np.flatnonzero(impacts.doing == GROSS_SLIP))
    sticking = np.flatnonzero(impacts.doing == STUCK)
    for first in range(0, sticking.size, BLOCK):
        stuck.advance(impacts, sticking[first : first + BLOCK])
    slipping = np.flatnonzero(impacts.doing == EDGE_SLIP)
    if not slipping.size:
        return bool(np.any(impacts.doing <= GROSS_SLIP))
    on_laid = impacts.pieces["sign"][impacts.outermost[slipping]] == LAID
    fitted = impacts.fitted[slipping]
    for laid in (False, True):
        for fit in (False, True):
            who = slipping[(on_laid == laid) & (fitted == fit)]
            for first in range(0, who.size, BLOCK):
                edge_slip.advance(
                    impacts, who[first : first + BLOCK], tolerance, laid=laid, fitted=fit
                )
    return True
