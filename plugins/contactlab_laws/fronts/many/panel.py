"""One collocation panel of edge slip for many impacts: fixed-point iteration in the velocity.

d(velocity)/dT = -inertia F(zeta, D), dD/dT = velocity. Twice integrated, an error shrinks like that
of a power series, by (omega h)²ⁿ/(2n)! in n iterations: a few do, and cost less than Newton's
systems.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab.contracts import PhaseSample, ScaledContact
from contactlab.numeric.lobatto import Array, lobatto
from contactlab_laws.fronts.many.crossing import NEVER, first_crossing
from contactlab_laws.fronts.many.impacts import Impacts
from contactlab_laws.fronts.many.pieces import Rows
from contactlab_laws.fronts.phases import EdgeSlip

NO_EVENT, STOPS, LEAVES, CAUGHT = range(4)
NODES = 8
ITERATIONS = 12
FEWEST_ITERATIONS = 4
#: Moves of a fitted end in one iteration, in parts of the panel.
LARGEST_MOVE = 0.3
SHORTEST = 1e-9


class Panel(NamedTuple):
    """Values at the nodes, shape (nodes, impacts), or for each panel, shape (impacts,)."""

    who: Rows  # of the impacts
    start: Array
    length: Array
    sample: PhaseSample
    change: Array  # of velocity in this panel
    work: Array  # in this panel
    depth: Array  # of the slip zone, zeta - q at the front
    tau: Array  # panel coordinate of the first event, or ``NEVER``
    event: Rows  # which it is
    leaves: Array  # panel coordinate at which the front leaves its piece, or ``NEVER``
    update: Array  # last move of the velocity, (impacts,)
    tail: Array  # what the nodes cannot resolve of the velocity, (impacts,)
    fitted: bool


def solve(
    impacts: Impacts, who: Rows, slipping: EdgeSlip, length: Array, settled: Array, *, fitted: bool
) -> Panel:
    """Solve panels.

    Parameters
    ----------
    impacts : Impacts
    who : ndarray of int
    slipping : EdgeSlip
        Their phase.
    length : ndarray
        In x; with ``fitted`` the first guess of it.
    settled : ndarray
        Move of the velocity at which iteration stops.
    fitted : bool
        End panels where the front leaves its piece, which it reaches like a square root of x:
        nodes are crowded as (1 - tau)² there, in which all is smooth, and the length is found
        along with the velocity.
    """
    nodes, motion = lobatto(NODES), impacts.motion
    spot, spread = (part[:, None] for part in (nodes.rooted if fitted else nodes.plain))
    start, inertia = impacts.phase[who], impacts.inertia[who]
    first, before = impacts.velocity(who), impacts.slip[who]

    contact = motion.scaled(start + length * spot)
    time = contact.time_rate * (length * spread)
    change = nodes.integral @ time
    change *= -inertia * impacts.force[who]
    memo: tuple[Array, ...] = ()
    for iteration in range(ITERATIONS):
        slip = nodes.integral @ (time * (first + change))
        slip += before
        response = slipping.respond(contact, slip, memo)
        memo = response.memo
        rate = time * response.force
        new = nodes.integral @ rate
        new *= -inertia
        update = np.abs(new - change).max(axis=0)
        change = new
        last = iteration == ITERATIONS - 1
        if fitted and iteration and not last and not _settled(iteration, update, settled):
            move = _move(slipping, PhaseSample(contact, slip, first + change, response), length)
            lost = ~np.isfinite(move)
            length = np.where(lost, length, np.clip(length + move, SHORTEST, np.pi - start))
            contact = motion.scaled(start + length * spot)
            time = contact.time_rate * (length * spread)
            # an end that still moves is not settled, whatever the velocity does
            update = np.where(lost, 1.0, np.maximum(update, np.abs(move)))
        if _settled(iteration, update, settled):
            break
    tail = np.abs(nodes.tail @ rate).sum(axis=0)
    tail *= inertia
    sample = PhaseSample(contact, slip, first + change, response)
    work = nodes.integral @ (time * slipping.friction_power(sample))
    margins = [slipping.margin(event, sample) for event in range(3)]
    events = _events(margins, fitted=fitted)
    known = sample, change, work, margins[2], *events
    return Panel(who, start, length, *known, update, tail, fitted)


def _events(margins: list[Array], *, fitted: bool) -> tuple[Array, Rows, Array]:
    """Return ``Panel.tau``, ``event`` and ``leaves``; a fitted panel ends where its piece does."""
    nodes = lobatto(NODES)
    stops, caught = (first_crossing(nodes, margins[event]) for event in (0, 2))
    leaves = np.full(stops.shape, NEVER) if fitted else first_crossing(nodes, margins[1])
    tau = np.minimum(np.minimum(stops, caught), leaves)
    event = np.where(tau == stops, STOPS, np.where(tau == caught, CAUGHT, LEAVES))
    return tau, np.where(tau > 1.0, LEAVES if fitted else NO_EVENT, event), leaves


def _settled(iteration: int, update: Array, settled: Array) -> bool:
    return iteration + 1 >= FEWEST_ITERATIONS and bool(np.all(update < settled))


def _move(slipping: EdgeSlip, sample: PhaseSample, length: Array) -> Array:
    """Return Newton's move of the end of each panel towards where the piece is left."""
    end = ScaledContact(*(column[-1] for column in sample.contact))
    excess = slipping.profile[-1].inner_margin(slipping.sign, end, sample.slip[-1])
    slope = (end.rate - slipping.sign * sample.velocity[-1]) * end.time_rate
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.clip(-excess / slope, -LARGEST_MOVE * length, LARGEST_MOVE * length))
