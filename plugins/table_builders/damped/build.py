"""Building the table: its cuts, and psi2 by the law of the half-space at its nodes."""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from contactlab.contracts import NormalMotion
from contactlab_laws.halfspace.axisymmetric import follow_all, rebound
from contactlab_laws.halfspace.instants import Instants, instants
from contactlab_laws.tables.damped import BORDERS, CHI, SLIPS, STICKS, tsuji
from contactlab_laws.tables.file import Stored, write
from contactlab_laws.tables.patches import Array

#: Nodes in psi1, chi and t.
NODES = (16, 8, 8)
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
    return rebound([motion], np.zeros(len(psi1), int), psi1, chi, rings)


def cuts_at(e: float, chi: Array, *, rings: int = RINGS) -> Array:
    """Return the three values of psi1 at which the table is cut, shape (3, chi)."""
    # At the first the traction at the centre grazes mu p before the end, where the limit vanishes.
    # At the second all of the contact slips, for an instant, before the end. From the third on the
    # centre slips for good: the slip displacement grows at least as fast as that of a hemisphere at
    # its limit all through unloading.
    path, cuts = instants(tsuji(e), rings, 1), np.empty((3, len(chi)))
    top, end = int(path.radius.argmax()), int(np.flatnonzero(path.pressure[:, 0]).max())
    first = np.linspace(*FIRST, LOOKED)
    for k, ratio in enumerate(chi.tolist()):
        last = 2.0 * ratio * (1.0 + e) - np.linspace(LAST[1], LAST[0], LOOKED)
        psi1, ratios = np.concatenate((first, last)), np.full(2 * LOOKED, ratio)
        motion = follow_all(rings, path, psi1, ratios, np.ones(len(psi1)), fields=True)
        at_centre = [
            np.abs(traction[:LOOKED, 0]) / limit[:LOOKED, 0]
            for traction, _, limit in motion.fields[:end]
        ]
        centre = _largest(np.array(at_centre), top)
        whole = np.abs(motion.share[1 : top + 2, :LOOKED]).max(axis=0)
        gains = 2.0 * ratio * np.diff(path.impulse, axis=0)
        passed = gains * (motion.share[:-1] / 3.0 + motion.share[1:] / 6.0)
        rate = (psi1 + motion.change[:-1] - passed)[:, LOOKED:]
        cuts[0, k] = _reaching(first, centre, CENTRE)
        cuts[1, k] = _reaching(first, whole, WHOLE)
        cuts[2, k] = np.interp(0.0, _margin(rate[:end], path, top), last)
    cuts[1:] = np.maximum(cuts[1:], cuts[:1] + NARROWEST)
    cuts[2] = np.maximum(cuts[2], cuts[1] + NARROWEST)
    return cuts


def _largest(share: Array, top: int) -> Array:
    """Return the largest share of the limit before the slip of the end, shape (psi1,)."""
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


def _margin(rate: Array, path: Instants, top: int) -> Array:
    """Return the least excess of the slip rate over the growth of the central limit, unloading."""
    live = slice(len(rate) + 1)
    limit = path.pressure[live, 0] * path.radius[live] ** 2
    growth = np.diff(limit) / np.diff(path.time[live, 0])
    return np.asarray((rate - growth[:, None])[top:].min(axis=0))


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


def restitution(depth: Any) -> Any:
    """Return e = 1 - t³."""
    return 1.0 - depth**3


def nodes(count: int, low: float, high: float) -> Array:
    """Return Chebyshev's nodes between ``low`` and ``high``, ends excluded."""
    return np.asarray(0.5 * (low + high) + 0.5 * (high - low) * chebyshev.chebpts1(count))


def coefficients(values: Array) -> Array:
    """Return Chebyshev coefficients of values at the nodes along every axis."""
    for axis, count in enumerate(values.shape):
        inverse = np.linalg.inv(chebyshev.chebvander(chebyshev.chebpts1(count), count - 1))
        values = np.moveaxis(np.tensordot(inverse, values, (1, axis)), 0, axis)
    return values


def incidence(piece: int, at: Any, cuts: Any) -> Any:
    """Return psi1 at a coordinate in [-1, 1] of a piece: the inverse of ``place``."""
    share = 0.5 * (at + 1.0)
    if piece == STICKS:
        return cuts[0] * share
    if piece == SLIPS:
        return 1.0 + (cuts[-1] - 1.0) / share
    low, high = cuts[piece - 1], cuts[piece]
    return low + (high - low) * share**2


def smooth(piece: int, psi1: Any, psi2: Any, chi: Any, e: Any) -> Any:
    """Return the tabulated quantity: psi2/psi1, psi2, or psi2 less that of gross slip."""
    if piece == STICKS:
        return psi2 / psi1
    return psi2 if piece != SLIPS else psi2 - (psi1 - 2.0 * chi * (1.0 + e))
