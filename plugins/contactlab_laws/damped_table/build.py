"""Making the table: where it is cut, and psi2 by rings at its nodes."""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.registry import REGISTRY
from contactlab.contracts.motion import NormalMotion
from contactlab.impact.scene import Scene
from contactlab_laws.damped_table import courses
from contactlab_laws.damped_table.coordinates import (
    BORDERS,
    CHI,
    NODES,
    SLIPS,
    coefficients,
    incidence,
    nodes,
    restitution,
    smooth,
)
from contactlab_laws.damped_table.rings import Course, History, march
from contactlab_laws.damped_table.table import Table, write

Array = NDArray[np.float64]

#: Rings with which the cuts are looked for.
RINGS = 96
#: Where they are looked for: psi1 of the first, 2 chi (1 + e) - psi1 of the second; and on so
#: many impacts.
FIRST, SECOND, LOOKED = (0.5, 1.6), (0.3, 1.3), 67
#: The piece between them is no narrower than this.
NARROWEST = 0.05
#: Above this share of Coulomb's limit the centre is taken to slip.
SLIPPING = 0.995


def motion(e: float) -> NormalMotion:
    """Return the normal motion under Tsuji's law, in units of its own that of every impact."""
    law = REGISTRY.create("normal.tsuji", restitution=e)
    return normal_motion(law, Scene.nondimensional(psi1=1.0, chi=1.0))


def solve(psi1: Array, chi: Array, e: float, *, counts: tuple[int, ...] = courses.COUNTS) -> Array:
    """Return psi2 of impacts of one restitution, with Coulomb's law at every point, by rings.

    Parameters
    ----------
    psi1, chi : array
        Broadcast against each other.
    e : float
        Restitution.
    counts : tuple of int
        Numbers of rings.
    """
    shape = np.broadcast_shapes(psi1.shape, chi.shape)
    psi1, chi = (np.broadcast_to(each, shape).ravel() for each in (psi1, chi))
    return courses.solve(psi1, chi, motion(e), counts=counts).reshape(shape)


def cuts_at(e: float, chi: Array, *, rings: int = RINGS) -> tuple[Array, Array]:
    """Return the two values of psi1 at which the table is cut, each of the shape of ``chi``.

    The first: the centre grazes slip before it slips at the end, as the limit vanishes. Its
    traction comes to mu p. The second: the centre slips for good, the slip displacement grows at
    least as fast as that of a hemisphere at its limit all through unloading.
    """
    shape = (LOOKED, len(chi))
    first = np.broadcast_to(np.linspace(*FIRST, LOOKED)[:, None], shape)
    second = 2.0 * chi * (1.0 + e) - np.linspace(SECOND[1], SECOND[0], LOOKED)[:, None]
    psi1 = np.stack([first, second])
    ours = courses.course(motion(e), rings)
    history = march(psi1.ravel(), np.broadcast_to(chi, psi1.shape).ravel(), ours)
    history = History(*(each.reshape(-1, *psi1.shape) for each in history))
    top = int(ours.inside.argmax())
    grazing = np.array([_reaching(first[:, k], _share(history, top, k)) for k in range(len(chi))])
    margin = _margin(history, ours, top)
    lasting = [np.interp(0.0, margin[:, k], second[:, k]) for k in range(len(chi))]
    return grazing, np.maximum(np.array(lasting), grazing + NARROWEST)


def _share(history: History, top: int, column: int) -> Array:
    """Return the largest share of the limit at the centre before the slip of the end.

    At the end the limit vanishes: what counts is the share before it is least in unloading.
    """
    share = np.abs(history.centre[1:-1, 0, :, column])
    least = top + share[top:].argmin(axis=0)
    return np.take_along_axis(np.maximum.accumulate(share), least[None], axis=0)[0]


def _reaching(psi1: Array, share: Array) -> float:
    """Return where ``share`` comes to 1, from the line through the last two values below it."""
    k = max(int((share >= SLIPPING).argmax()), 2)
    rise = (share[k - 1] - share[k - 2]) / (psi1[k - 1] - psi1[k - 2])
    return float(np.clip(psi1[k - 1] + (1.0 - share[k - 1]) / rise, psi1[k - 1], psi1[k]))


def _margin(history: History, ours: Course, top: int) -> Array:
    """Return the least excess of slip over that of the limit at the centre in unloading."""
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
        found = np.array([cuts_at(float(restitution(t)), chi) for t in depths]).swapaxes(0, 1)
        # The cuts are those of the polynomials, in building and evaluating alike.
        cuts.append([coefficients(np.ascontiguousarray(each.T)) for each in found])
        values.append(np.empty((SLIPS + 1, *NODES)))
        for k, t in enumerate(depths):
            e = float(restitution(t))
            for part in range(SLIPS + 1):
                at = nodes(NODES[0], -1.0, 1.0)[:, None]
                psi1 = incidence(part, at, (found[0, k], found[1, k]))
                psi2 = solve(psi1, chi, e)
                values[-1][part, :, :, k] = smooth(part, psi1, psi2, chi, e)
            done = piece * NODES[2] + k + 1
            print(f"{done} of {NODES[2] * (len(BORDERS) - 1)}: e = {e:.4f}", file=sys.stderr)
    terms = np.array([[coefficients(part) for part in each] for each in values])
    write(path, Table.today(np.array(cuts), terms))
