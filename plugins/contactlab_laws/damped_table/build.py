"""Making the table: where it is cut, and psi2 by springs at its nodes."""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contactlab.compose.registry import REGISTRY
from contactlab.compose.simulation import Simulation
from contactlab.impact.scene import Scene
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
from contactlab_laws.damped_table.table import Table, write
from contactlab_laws.dashpot.oscillator import damping_of

Array = NDArray[np.float64]

#: Springs of the impacts at the nodes; four steps to a spring.
SPRINGS = 150
#: Where the cuts are looked for: psi1 of the first, 2 chi (1 + e) - psi1 of the second; and on so
#: many impacts.
FIRST, SECOND, LOOKED = (0.8, 1.6), (0.3, 1.3), 49
#: The piece between them is no narrower than this.
NARROWEST = 0.05


def simulation(e: float, springs: int) -> Simulation:
    """Return Tsuji's law under so many springs."""
    return Simulation(
        normal=REGISTRY.create("normal.tsuji", restitution=e),
        tangential=REGISTRY.create("tangential.springs", springs=springs),
        integrator=REGISTRY.create("integrator.symplectic", steps=4 * springs),
    )


def solve(psi1: Array, chi: Array, e: float, *, springs: int = SPRINGS) -> Array:
    """Return psi2 of impacts of one restitution, by springs.

    Parameters
    ----------
    psi1, chi : array
        Broadcast against each other.
    e : float
        Restitution.
    springs : int
        Four steps are taken to each.
    """
    shape = np.broadcast_shapes(psi1.shape, chi.shape)
    psi1, chi = (np.broadcast_to(each, shape).ravel() for each in (psi1, chi))
    result = simulation(e, springs).sweep(Scene.nondimensional(psi1=psi1, chi=chi)).check()
    return np.asarray(result.psi2).reshape(shape)


def cuts_at(e: float, chi: Array) -> tuple[Array, Array]:
    """Return the two values of psi1 at which the table is cut, each of the shape of ``chi``.

    The first: the centre grazes slip before it slips at the end, as the limit vanishes. Its
    displacement since touch comes to the limit of the spring there, l(0) = P^/zeta^½. The
    second: it slips for good, psi >= dl(0)/dT all through unloading. Extrapolated: both are of
    first order in steps.
    """
    coarse, fine = (_looked_for(e, chi, springs) for springs in (SPRINGS // 2, SPRINGS))
    first, second = 2.0 * fine - coarse
    return first, np.maximum(second, first + NARROWEST)


def _looked_for(e: float, chi: Array, springs: int) -> Array:
    """Return the cuts as springs find them on a grid of psi1, shape (2, chi)."""
    first = np.broadcast_to(np.linspace(*FIRST, LOOKED)[:, None], (LOOKED, len(chi)))
    second = 2.0 * chi * (1.0 + e) - np.linspace(SECOND[1], SECOND[0], LOOKED)[:, None]
    psi1 = np.stack([first, second])
    scene = Scene.nondimensional(psi1=psi1.ravel(), chi=np.broadcast_to(chi, psi1.shape).ravel())
    history = simulation(e, springs).run(scene, history=True).check().history
    assert history is not None
    # In these units zeta is the approach, and Hertz's greatest force 1.25.
    rate, approach = (each[1:-1, 0] for each in (history.normal_velocity, history.approach))
    limit = history.normal_force[1:-1, 0] / 1.25 / approach**0.5
    slip = history.slip_velocity.reshape(-1, *psi1.shape)
    moved = 0.5 * (slip[1:] + slip[:-1]) * np.diff(history.time[:, 0])[:, None, None, None]
    loaded = rate > 0.0
    forth = np.cumsum(moved, axis=0)[:-1, 0] / limit[:, None, None]
    # At the end the limit vanishes: what counts is the ratio before it is least in unloading.
    least = np.count_nonzero(loaded) + forth[~loaded].argmin(axis=0)
    ratio = np.take_along_axis(np.maximum.accumulate(forth), least[None], axis=0)[0]
    x, beta = approach**1.25, damping_of(e)
    pull = x + 2.0 * beta * rate
    falling = 1.25 * (rate - 2.0 * beta * pull - 0.2 * rate * pull / x)
    margin = (slip[1:-1, 1][~loaded] - falling[~loaded, None, None]).min(axis=0)
    return np.array(
        [
            [np.interp(at, measured[:, k], grid[:, k]) for k in range(len(chi))]
            for at, measured, grid in ((1.0, ratio, first), (0.0, margin, second))
        ]
    )


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
