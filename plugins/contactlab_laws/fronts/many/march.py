"""Rounds of panels until every impact of an array has ended."""

from __future__ import annotations

import numpy as np

from contactlab.contracts import ClosedFormMotion, ManyImpacts
from contactlab.numeric.lobatto import Array, lobatto
from contactlab_laws.fronts.many import edge_slip, stuck
from contactlab_laws.fronts.many.impacts import DONE, EDGE_SLIP, GROSS_SLIP, STUCK, Impacts

#: Impacts in one call while edges slip: an array of 8 nodes of them fits in the cache next to the
#: processor, and the largest matrix product, with 25 finer points, has less than 2**18 terms:
#: OpenBLAS shares larger ones among threads, and the last bits depend on how many there are.
BLOCK = 1250
#: Impacts of which the memory is kept at one time: some 50 MB. Beyond this chi there is more of
#: it for each impact, about as sqrt(chi).
CHUNK, CHUNK_CHI = 10_000, 30.0
#: Up to here answers were checked against those of one impact.
LARGEST_CHI = 1e3
#: Distance of the velocity from 1 below which the centre slips too soon after first touch; and of
#: it and of 2 chi, below which nearly all is at the limit of slip at all times.
ALMOST_ONE, ALMOST_BALANCED = 1e-6, 2e-2
#: Rounds: an impact takes some 30, and as sqrt(chi) for large chi; about ten times that.
ROUNDS, ROUNDS_PER_SWING = 200, 40


def march(
    velocity: Array, inertia: Array, motion: ClosedFormMotion, tolerance: float
) -> ManyImpacts:
    """Return the answers to impacts of scaled velocity > 0 that do not slip throughout.

    Parameters
    ----------
    velocity, inertia : ndarray, shape (impacts,)
    motion : ClosedFormMotion
        Of a batch; only what is scaled is asked of it.
    tolerance : float
        Error of psi2 over max(1, psi1).
    """
    change, work = np.zeros_like(velocity), np.zeros_like(velocity)
    solved = np.zeros(velocity.shape, dtype=bool)
    panels = 0
    chi, away = 0.5 * inertia * motion.scaled_mass, np.abs(velocity - 1.0)
    hard = (away < ALMOST_ONE) | (chi > LARGEST_CHI)
    hard |= velocity >= np.maximum(1.0, 4.0 * chi - 1.0)
    hard |= (away < ALMOST_BALANCED) & (np.abs(2.0 * chi - 1.0) < ALMOST_BALANCED)
    rest = np.flatnonzero(~hard)
    chunk = int(CHUNK * np.sqrt(CHUNK_CHI / chi[rest].max(initial=CHUNK_CHI)))
    with np.errstate(under="ignore"):
        for first in range(0, rest.size, chunk):
            part = rest[first : first + chunk]
            impacts = Impacts(velocity[part], inertia[part], motion, lobatto(stuck.NODES))
            rounds = ROUNDS + int(ROUNDS_PER_SWING * np.sqrt(chi[part].max()))
            while rounds and _round(impacts, tolerance):
                rounds -= 1
            change[part], work[part] = impacts.change, impacts.work
            solved[part] = (impacts.regime == DONE) & np.isfinite(impacts.change + impacts.work)
            panels += int(impacts.panels.sum())
    return ManyImpacts(change, work, solved, panels)


def _round(impacts: Impacts, tolerance: float) -> bool:
    """Take every impact one panel further; return whether any was left."""
    sliding = np.flatnonzero(impacts.regime == GROSS_SLIP)
    if sliding.size:
        impacts.slide_through(sliding)
    sticking = np.flatnonzero(impacts.regime == STUCK)
    for first in range(0, sticking.size, stuck.BLOCK):
        stuck.advance(impacts, sticking[first : first + stuck.BLOCK])
    slipping = np.flatnonzero(impacts.regime == EDGE_SLIP)
    if not slipping.size:
        return bool(np.any(impacts.regime < DONE))
    kind = 2 * impacts.laid(slipping) + impacts.fitted[slipping]
    for who in (slipping[kind == each] for each in range(4)):
        for first in range(0, who.size, BLOCK):
            edge_slip.advance(impacts, who[first : first + BLOCK], tolerance)
    return True
