"""One collocation panel of edge slip for many impacts: fixed-point iteration in psi.

psi' = -2.5 chi F(zeta, D), D' = psi. Twice integrated, an error shrinks like that of a power
series, by (omega h)²ⁿ/(2n)! in n iterations: a few do, and cost less than Newton's systems.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab_fronts.many.hertz import Contact, contact
from contactlab_fronts.many.impacts import Impacts
from contactlab_fronts.many.nodes import lobatto

Array = NDArray[np.float64]
Rows = NDArray[np.intp]
Front = Callable[[Contact, Array], tuple[Array, Array]]

NODES = 8
ITERATIONS = 12
FEWEST_ITERATIONS = 4
#: Moves of a fitted end in one iteration, in parts of the panel.
LARGEST_MOVE = 0.3
SHORTEST = 1e-9


class Panel(NamedTuple):
    """Values at the nodes, shape (nodes, impacts), or for each panel, shape (impacts,)."""

    start: Array
    length: Array
    now: Contact
    sign: Array
    velocity: Array
    change: Array  # of psi in this panel
    slip: Array
    force: Array
    front: Array  # q
    update: Array  # last move of psi, (impacts,)
    tail: Array  # what the nodes cannot resolve of 2.5 chi F dT/dtau, (impacts,)
    fitted: bool

    def phase(self, columns: Rows, tau: Array) -> Array:
        """Return the phase of some of the panels at their coordinates ``tau``."""
        spot = tau * (2.0 - tau) if self.fitted else tau
        return np.asarray(self.start[columns] + self.length[columns] * spot)


def solve(
    impacts: Impacts,
    who: Rows,
    front: Front,
    length: Array,
    goal: Array,
    settled: Array,
    *,
    fitted: bool,
) -> Panel:
    """Solve panels of ``length``; with ``fitted``, up to where zeta - s D falls to ``goal``.

    A fitted end is one to which the front rushes like a square root: there nodes are crowded
    as (1 - tau)², in which all is smooth, and the length is found along with psi. ``settled``
    is the move of psi at which iteration stops.
    """
    nodes = lobatto(NODES)
    tau = nodes.points[:, None]
    spot, spread = (tau * (2.0 - tau), 2.0 - 2.0 * tau) if fitted else (tau, np.ones_like(tau))
    start, sign, gain = impacts.phase[who], impacts.sign[who], 2.5 * impacts.chi[who]
    first, before = impacts.velocity(who), impacts.slip[who]
    left = np.pi - start

    now = contact(start + length * spot)
    time = now.pace * (length * spread)
    change = nodes.integral @ time
    change *= -gain * impacts.force[who]
    for iteration in range(ITERATIONS):
        velocity = first + change
        slip = nodes.integral @ (time * velocity)
        slip += before
        q, force = front(now, slip)
        rate = time * force
        new = nodes.integral @ rate
        new *= -gain
        update = np.abs(new - change).max(axis=0)
        change = new
        enough = iteration + 1 >= FEWEST_ITERATIONS and bool(np.all(update < settled))
        if fitted and not enough and 0 < iteration < ITERATIONS - 1:
            move = _move(now, sign, slip, first + change, goal, length)
            lost = ~np.isfinite(move)
            length = np.where(lost, length, np.clip(length + move, SHORTEST, left))
            now = contact(start + length * spot)
            time = now.pace * (length * spread)
            # an end that still moves is not settled, whatever psi does
            update = np.where(lost, 1.0, np.maximum(update, np.abs(move)))
            enough = iteration + 1 >= FEWEST_ITERATIONS and bool(np.all(update < settled))
        if enough:
            break
    tail = np.abs(nodes.tail @ rate).sum(axis=0)
    tail *= gain
    return Panel(
        start, length, now, sign, first + change, change, slip, force, q, update, tail, fitted
    )


def _move(
    now: Contact, sign: Array, slip: Array, velocity: Array, goal: Array, length: Array
) -> Array:
    """Return Newton's move of the end of each panel towards its goal."""
    excess = now.approach[-1] - sign * slip[-1] - goal
    slope = (now.rate[-1] - sign * velocity[-1]) * now.pace[-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.clip(-excess / slope, -LARGEST_MOVE * length, LARGEST_MOVE * length))
