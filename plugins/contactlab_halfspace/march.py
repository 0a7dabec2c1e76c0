"""One impact on rings and angles: tractions as vectors, with coupling of unlike bodies.

Scaled as in ``instants``: lengths by the largest contact radius a, slip by mu a²/(kappa R), forces
by (4/3) E* a³/R, tangential ones by mu times this, velocities of slip by mu v1/kappa.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from contactlab.numeric.types import Array, Real
from contactlab_halfspace.pressure import Answering, Prescribed
from contactlab_halfspace.slips import begin_slips, move_slips, rest
from contactlab_halfspace.splitting import settle


class Followed(NamedTuple):
    """Impacts followed to their end, at first touch and at K instants after it, dimensionless.

    Attributes
    ----------
    change, share, impulse : array, shape (K + 1, impacts)
        Change of slip velocity; F over mu times the friction load; integral of the friction load
        over M_n v1.
    work : array, shape (impacts,)
        Friction work over M_t times the square of the unit of velocity.
    residual : array, shape (impacts,)
        Largest residual of all steps, over the largest pressure; 0 where none is left.
    fields : list of (array, array, array)
        Tractions, slips and pressures at the K instants, empty unless asked for: shapes
        (impacts, rings) along one direction, else (parts, angles, rings) of one impact.
    departures : array, shape (3, K + 1, impacts), or None
        Departures of approach, rate and force from the normal motion without friction; None unless
        traction changes the pressure.
    spin : array, shape (impacts,), or None
        Change of the spin about the normal, in w; None unless bodies spin.
    """

    change: Array
    share: Array
    impulse: Array
    work: Array
    residual: Array
    fields: list[tuple[Array, Array, Array]]
    departures: Array | None = None
    spin: Array | None = None


def join_impacts(parts: Sequence[Followed]) -> Followed:
    """Return impacts one behind the other; fields are those of the first."""
    columns: list[Any] = [
        None if column[0] is None else np.concatenate(column, axis=-1)
        for column in zip(*(part._replace(fields=[]) for part in parts), strict=True)
    ]
    return Followed(*columns)._replace(fields=parts[0].fields)


def follow(
    pressure: Prescribed, psi1: float, chi: float, w1: float, chi_w: float, *, fields: bool = False
) -> Followed:
    """Return one impact with slip velocity ``psi1`` at first touch.

    Parameters
    ----------
    pressure : Prescribed
        Pressure of the impact, prescribed or answering.
    psi1, chi : float
        Dimensionless angle of incidence, and inertia ratio.
    w1, chi_w : float
        Spin about the normal as the speed of the rim, and its inertia ratio; the bodies' rotation
        in a step takes the moment of the step before.
    fields : bool
        Whether to keep tractions, slips and pressures.
    """
    # In every step the share of Coulomb's limit that acts is linear in the impulse of the friction
    # load, so that gross slip is exact. The first step has one share throughout. ``early`` and
    # ``late`` are the weights of the shares at its two ends in the displacement of a step.
    table, along = pressure.table, pressure.table.along
    change, shares, impulse = columns = np.zeros((3, len(pressure.course.inside)))
    zero = np.zeros((table.parts, table.angles, table.count))
    slips, traction, memory = begin_slips(zero[:2]), zero, zero
    displaced, work, residual = 0.0, 0.0, 0.0
    rotation, slowed, moment = 0.0, 0.0, 0.0
    touched, kept = False, []
    for k in range(1, len(change)):
        duration, gain = float(pressure.duration[k - 1]), 2.0 * chi * pressure.impulse(k)
        early, late = (1.0 / 3.0, 1.0 / 6.0) if touched else (0.0, 0.5)
        contact, new = pressure.contact(k), np.zeros(zero.shape)
        fixed = displaced + duration * (psi1 + change[k - 1] - gain * shares[k - 1] * early)
        slowing, share, force, surface = duration * gain * late, shares[k - 1], 0.0, zero[:2]
        turning: Real = 0.0
        acted = moment
        if table.spins:
            rotation += duration * (w1 + slowed - chi_w * pressure.impulse(k) * moment)
            turning, moment = table.turn * rotation, 0.0
        if contact is not None:
            number = contact.rings
            resting = rest(slips, duration, vectors=True)
            target = np.empty((*zero.shape[:2], number))
            bodies = along * fixed + turning
            target[:2] = (bodies - contact.dragged - resting)[:, :, :number]
            target[2:] = contact.depth
            start = np.zeros(target.shape)
            known = min(number, memory.shape[2])
            start[:, :, :known] = memory[:, :, :known]
            solution = settle(table, contact, target, slowing, start)
            new[:, :, :number], memory = solution.traction, solution.memory
            share, force = solution.share, solution.force
            residual = max(residual, solution.residual)
            surface = table.displace(solution.traction)[:2] + contact.dragged
            if table.spins:
                moment = table.moment(solution.traction) / force
            if not touched:
                shares[k - 1], touched = share, True
        displaced = fixed - slowing * share
        slip = along * displaced + turning - surface
        work += table.work(0.5 * (traction + new)[:2], slip - slips.last)
        touching = np.arange(table.count) < (0 if contact is None else contact.rings)
        if table.parts == 3:
            touching &= (new[2] > 0.0).any(axis=0)
        slips = move_slips(slips, slip, duration, touching)
        passed = pressure.advance(k, force)
        impulse[k] = impulse[k - 1] + passed
        change[k] = change[k - 1] - chi * passed * (shares[k - 1] + share)
        slowed -= chi_w * passed * (acted + moment)
        shares[k], traction = share, new
        if fields:
            pressed = new[2] if table.parts == 3 else np.zeros(table.count)
            if contact is not None and contact.limit is not None:
                pressed[: contact.rings] = contact.limit
            kept.append((new, slip, pressed))
    departures: Array | None = None
    if isinstance(pressure, Answering):
        departures = np.stack((pressure.approach, pressure.rate, pressure.excess))[..., None]
    works = np.array([6.0 * chi * pressure.stiffness * work])
    change, shares, impulse = (column[:, None] for column in columns)
    spin = np.array([slowed]) if table.spins else None
    return Followed(change, shares, impulse, works, np.array([residual]), kept, departures, spin)
