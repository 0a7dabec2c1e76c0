"""Impacts on rings and angles: tractions as vectors, with coupling of unlike bodies.

Scaled as in ``instants``: lengths by the largest contact radius a, slip by mu a²/(kappa R), forces
by (4/3) E* a³/R, tangential ones by mu times this, velocities of slip by mu v1/kappa.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from contactlab.numeric.types import Array, Places, Real
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


def join_impacts(parts: Sequence[Followed], order: Places) -> Followed:
    """Return the impacts of all parts in an order; fields are those of the first."""
    columns: list[Any] = [
        np.concatenate(each, axis=-1)[..., order] if isinstance(each[0], np.ndarray) else each[0]
        for each in zip(*parts, strict=True)
    ]
    return Followed(*columns)


def follow(
    pressure: Prescribed, psi1: Array, chi: Array, w1: Array, chi_w: Array, *, fields: bool
) -> Followed:
    """Return impacts with slip velocities ``psi1`` at first touch.

    Parameters
    ----------
    pressure : Prescribed
        Pressure of the impacts, prescribed or answering.
    psi1, chi : array, shape (impacts,)
        Dimensionless angles of incidence, and inertia ratios.
    w1, chi_w : array, shape (impacts,)
        Spins about the normal as the speeds of the rim, and their inertia ratios; the bodies'
        rotation in a step takes the moment of the step before.
    fields : bool
        Whether to keep tractions, slips and pressures; of one impact only.
    """
    # In every step the share of Coulomb's limit that acts is linear in the impulse of the friction
    # load, so that gross slip is exact. The first step has one share throughout. ``early`` and
    # ``late`` are the weights of the shares at its two ends in the displacement of a step.
    table, along = pressure.table, pressure.table.along
    change, shares, impulse = np.zeros((3, len(pressure.course.inside), len(psi1)))
    zero = np.zeros((len(psi1), table.parts, table.angles, table.count))
    slips, traction, memory = begin_slips(zero[:, :2]), zero, zero
    displaced, work, residual, rotation, slowed, moment = np.zeros((6, len(psi1)))
    touched, kept = np.zeros(len(psi1), dtype=bool), []
    for k in range(1, len(change)):
        duration, foreseen = pressure.duration[k - 1], pressure.impulse(k)
        gain = 2.0 * chi * foreseen
        early, late = np.where(touched, 1.0 / 3.0, 0.0), np.where(touched, 1.0 / 6.0, 0.5)
        contact, new = pressure.contact(k), np.zeros(zero.shape)
        fixed = displaced + duration * (psi1 + change[k - 1] - gain * shares[k - 1] * early)
        slowing, share, force = duration * gain * late, shares[k - 1].copy(), np.zeros(len(psi1))
        turning: Real = 0.0
        surface, acted = zero[:, :2], moment
        if table.spins:
            rotation = rotation + duration * (w1 + slowed - chi_w * foreseen * moment)
            turning, moment = _of_each(rotation) * table.turn, np.zeros(len(psi1))
        touching = np.zeros((1, 1, 1, table.count), dtype=bool)
        if contact is not None:
            number, live = contact.rings, contact.touching
            bodies = _of_each(fixed) * along + turning
            target = np.empty((*zero.shape[:3], number))[live]
            resting = rest(slips, _of_each(duration), vectors=True)
            target[:, :2] = (bodies - contact.dragged - resting)[live, :, :, :number]
            target[:, 2:] = contact.depth
            start = np.zeros((*zero.shape[:3], number))
            known = min(number, memory.shape[3])
            start[..., :known] = memory[..., :known]
            memory = start
            solution = settle(table, contact, target, slowing[live], start[live])
            new[live, :, :, :number], memory[live] = solution.traction, solution.memory
            share[live], force[live] = solution.share, solution.force
            residual[live] = np.maximum(residual[live], solution.residual)
            surface = table.displace(new[..., :number])[:, :2] + contact.dragged
            if table.spins:
                moment[live] = table.moment(solution.traction) / solution.force
            begins = live & ~touched
            shares[k - 1, begins], touched = share[begins], touched | live
            touching = (np.arange(table.count) < number) & live[:, None, None, None]
        displaced = fixed - slowing * share
        slip = _of_each(displaced) * along + turning - surface
        work += table.work(0.5 * (traction + new)[:, :2], slip - slips.last)
        if table.parts == 3:
            touching = touching & (new[:, 2:] > 0.0).any(axis=2, keepdims=True)
        slips = move_slips(slips, slip, _of_each(duration), touching)
        passed = pressure.advance(k, force)
        impulse[k] = impulse[k - 1] + passed
        change[k] = change[k - 1] - chi * passed * (shares[k - 1] + share)
        slowed = slowed - chi_w * passed * (acted + moment)
        shares[k], traction = share, new
        if fields:
            pressed = new[0, 2] if table.parts == 3 else np.zeros(table.count)
            if contact is not None and contact.limit is not None:
                pressed[: contact.rings] = contact.limit[0]
            kept.append((new[0], slip[0], pressed))
    departures: Array | None = None
    if isinstance(pressure, Answering):
        departures = np.stack((pressure.approach, pressure.rate, pressure.excess))
    works = 6.0 * chi * pressure.stiffness * work
    spin = slowed if table.spins else None
    return Followed(change, shares, impulse, works, residual, kept, departures, spin)


def _of_each(numbers: Array) -> Array:
    """Return a number of each impact in the shape of its vectors."""
    return numbers[:, None, None, None]
