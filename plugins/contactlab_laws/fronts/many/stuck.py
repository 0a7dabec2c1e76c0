"""Sticking while the contact grows: a linear equation, one panel of high order.

d(psi)/dT = -inertia F, dF/dT = 1.5 u psi (theory §5), so that psi at the nodes solves one small
system.
"""

from __future__ import annotations

import numpy as np

from contactlab.contracts import ScaledContact
from contactlab.numeric.lobatto import Array, lobatto, rows
from contactlab_laws.fronts.laid import Laid
from contactlab_laws.fronts.many.crossing import first_crossing, value
from contactlab_laws.fronts.many.impacts import Impacts
from contactlab_laws.fronts.many.pieces import Rows

#: With 20 nodes a panel holds 4 radians of the fastest oscillation to 1e-12.
NODES = 20
#: Impacts in one call, so few that products with 61 finer points are left to one thread: see
#: ``march.BLOCK``.
BLOCK = 200
LONGEST_SWING = 4.0
LONGEST = 1.2
#: (dT/dx)² u is at most 1.6; this times inertia is the square of the fastest oscillation in x.
FASTEST = 1.5 * 1.6
#: Pieces thinner than this, in q, hold no force worth knowing, only rounding.
THINNEST = 1e-9


def advance(impacts: Impacts, who: Rows) -> None:
    """Take one panel, up to the moment at which the edge begins to slip if that comes first."""
    nodes = lobatto(NODES)
    start, inertia = impacts.phase[who], impacts.inertia[who]
    left = 0.5 * np.pi - start
    length = np.minimum(np.minimum(left, LONGEST), LONGEST_SWING / np.sqrt(FASTEST * inertia))
    now, velocity, slip, force = _solve(impacts, who, length)

    forward = first_crossing(nodes, now.rate - velocity)
    backward = first_crossing(nodes, now.rate + velocity)
    sign = np.where(forward <= backward, 1.0, -1.0)
    tau = np.minimum(forward, backward)
    # at maximum compression V = 0, and the edge must slip if only by rounding
    late = (tau > 1.0) & (length >= left)
    sign = np.where(late, np.where(velocity[-1] < 0.0, -1.0, 1.0), sign)
    slips = late | (tau <= 1.0)
    weights = rows(nodes, np.minimum(tau, 1.0))

    end = start + length * np.minimum(tau, 1.0)
    thick = np.sin(end) ** 2 - np.sin(start) ** 2 > THINNEST
    laid, first, last = who[thick], start[thick], end[thick]
    output = impacts.pieces.output(first, length[thick], (slip[:, thick], force[:, thick]))
    ended = np.where(slips, sign, 0.0)[thick]
    piece = Laid.along(output, first, last, impacts.began[laid], ended)
    impacts.outermost[laid] = impacts.pieces.add(impacts.outermost[laid], piece)
    impacts.phase[who] = end
    impacts.panels[who] += 1
    impacts.change[who] += value(weights, velocity - impacts.velocity(who))
    impacts.slip[who] = value(weights, slip)
    impacts.force[who] = value(weights, force)
    impacts.began[who] = 0.0
    impacts.sign[who] = np.where(slips, sign, impacts.sign[who])
    impacts.slip_on(who[slips])


def _solve(impacts: Impacts, who: Rows, length: Array) -> tuple[ScaledContact, Array, Array, Array]:
    """Return contact, psi, D and F at the nodes of panels of some length in x."""
    nodes = lobatto(NODES)
    integral = nodes.integral
    first, force = impacts.velocity(who), impacts.force[who]
    now = impacts.motion.scaled(impacts.phase[who] + length * nodes.points[:, None])
    time, radius = now.time_rate * length, now.radius
    growth = 1.5 * radius * time
    slowing = np.ascontiguousarray((impacts.inertia[who] * time).T)[:, None, :] * integral
    matrix = (slowing @ integral) * np.ascontiguousarray(growth.T)[:, None, :]
    known = -slowing.sum(axis=2) * force[:, None] - matrix.sum(axis=2) * first[:, None]
    matrix += np.eye(NODES)
    velocity = first + np.linalg.solve(matrix, known[:, :, None])[:, :, 0].T
    slip = impacts.slip[who] + integral @ (time * velocity)
    return now, velocity, slip, force + integral @ (growth * velocity)
