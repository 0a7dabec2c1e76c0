"""Building the table: its cuts, and psi2 by the law of the half-space at its nodes."""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import NormalMotion
from contactlab_laws.halfspace.axisymmetric import follow_all
from contactlab_laws.halfspace.course import course as halfspace_course
from contactlab_laws.halfspace.impacts import ALONG
from contactlab_laws.rings.courses import course, tsuji
from contactlab_laws.rings.rings import Course, History, march
from contactlab_laws.tables.damped import BORDERS, CHI, SLIPS
from contactlab_laws.tables.file import Stored, write
from table_builders.damped.coordinates import (
    NODES,
    coefficients,
    incidence,
    nodes,
    restitution,
    smooth,
)

Array = NDArray[np.float64]

#: Rings of the impacts at the nodes, which psi2 is extrapolated from with half as many, and rings
#: in the search of the cuts.
FINE, RINGS = 96, 72
#: Range of the search in psi1 for the first two cuts, in 2 chi (1 + e) - psi1 for the last, and its
#: number of impacts.
FIRST, LAST, LOOKED = (0.5, 1.9), (0.3, 1.3), 57
#: Least width of a piece between two cuts, in psi1.
NARROWEST = 0.02
#: Shares of Coulomb's limit above which the centre, and all of the contact, count as slipping.
CENTRE, WHOLE = 0.995, 0.9999


def solve(psi1: Array, chi: Array, e: float) -> Array:
    """Return psi2 of impacts of one restitution, with Coulomb's law at every point."""
    shape = np.broadcast_shapes(psi1.shape, chi.shape)
    psi1, chi = (np.broadcast_to(each, shape).ravel() for each in (psi1, chi))
    return by_half_space(tsuji(e), psi1, chi).reshape(shape)


def by_half_space(motion: NormalMotion, psi1: Array, chi: Array, *, rings: int = FINE) -> Array:
    """Return psi2 of impacts, shape (impacts,), that have a normal motion in units of their own."""
    fine, coarse = (
        follow_all(
            count, halfspace_course(motion, count, ALONG), psi1, chi, np.ones(psi1.shape)
        ).change[-1]
        for count in (rings, rings // 2)
    )
    return np.asarray(psi1 + fine + (fine - coarse) / 3.0)


def cuts_at(e: float, chi: Array, *, rings: int = RINGS) -> Array:
    """Return the three values of psi1 at which the table is cut, shape (3, chi)."""
    # At the first the traction at the centre grazes mu p before the end, where the limit vanishes.
    # At the second all of the contact slips, for an instant, before the end. From the third on the
    # centre slips for good: the slip displacement grows at least as fast as that of a hemisphere at
    # its limit all through unloading.
    shape = (LOOKED, len(chi))
    first = np.broadcast_to(np.linspace(*FIRST, LOOKED)[:, None], shape)
    last = 2.0 * chi * (1.0 + e) - np.linspace(LAST[1], LAST[0], LOOKED)[:, None]
    psi1 = np.stack([first, last])
    ours = course(tsuji(e), rings)
    impacts = march(psi1.ravel(), np.broadcast_to(chi, psi1.shape).ravel(), ours)
    history = History(*(each.reshape(-1, *psi1.shape) for each in impacts))
    top = int(ours.inside.argmax())
    centre = _largest(np.abs(history.centre[1:-1, 0]), top)
    whole = np.abs(history.share[1 : top + 2, 0]).max(axis=0)
    margin = _margin(history, ours, top)
    cuts = np.empty((3, len(chi)))
    for k in range(len(chi)):
        cuts[0, k] = _reaching(first[:, k], centre[:, k], CENTRE)
        cuts[1, k] = _reaching(first[:, k], whole[:, k], WHOLE)
        cuts[2, k] = np.interp(0.0, margin[:, k], last[:, k])
    cuts[1:] = np.maximum(cuts[1:], cuts[:1] + NARROWEST)
    cuts[2] = np.maximum(cuts[2], cuts[1] + NARROWEST)
    return cuts


def _largest(share: Array, top: int) -> Array:
    """Return the largest share of the limit before the slip of the end, shape (psi1, chi)."""
    # At the end the limit vanishes: the largest is taken up to the least share in unloading.
    least = top + share[top:].argmin(axis=0)
    before = np.take_along_axis(np.maximum.accumulate(share), least[None], axis=0)
    return np.asarray(before[0])


def _reaching(psi1: Array, share: Array, slipping: float) -> float:
    """Return psi1 where ``share`` comes to 1 for good, by the line through two values before."""
    k = int(np.flatnonzero(share < slipping).max(initial=1)) + 1
    if k == len(psi1):
        return float(psi1[-1])
    rise = max((share[k - 1] - share[k - 2]) / (psi1[k - 1] - psi1[k - 2]), 1e-3)
    return float(np.clip(psi1[k - 1] + (1.0 - share[k - 1]) / rise, psi1[k - 1], psi1[k]))


def _margin(history: History, ours: Course, top: int) -> Array:
    """Return the least excess of the slip over the growth of the central limit in unloading."""
    ends = ours.edges[ours.inside]
    limit = ours.load / np.where(ends > 0.0, ends, 1.0)
    excess = history.moved[:, 1] - np.diff(limit)[:, None, None]
    return np.asarray((excess / np.diff(ours.time)[:, None, None])[top:].min(axis=0))


def build(path: Path) -> None:
    """Build the table and write it; progress goes to stderr."""
    chi = nodes(NODES[1], *CHI)
    cuts, values = [], []
    for piece, (low, high) in enumerate(pairwise(BORDERS)):
        depths = nodes(NODES[2], low, high)
        borders = np.array([cuts_at(float(restitution(t)), chi) for t in depths]).swapaxes(0, 1)
        print(f"cuts of piece {piece + 1} of {len(BORDERS) - 1}", file=sys.stderr)
        # Building and evaluating take the cuts from the same polynomials.
        cuts.append([coefficients(np.ascontiguousarray(each.T)) for each in borders])
        values.append(np.empty((SLIPS + 1, *NODES)))
        for k, t in enumerate(depths):
            e = float(restitution(t))
            at = nodes(NODES[0], -1.0, 1.0)[:, None]
            psi1 = np.stack([incidence(part, at, borders[:, k]) for part in range(SLIPS + 1)])
            psi2 = solve(psi1, chi, e)
            for part in range(SLIPS + 1):
                values[-1][part, :, :, k] = smooth(part, psi1[part], psi2[part], chi, e)
            done = piece * NODES[2] + k + 1
            print(f"{done} of {NODES[2] * (len(BORDERS) - 1)}: e = {e:.4f}", file=sys.stderr)
    terms = np.array([[coefficients(part) for part in each] for each in values])
    write(path, Stored.today(cuts=np.array(cuts), terms=terms))
