"""Whole-impact answers of the half-space, from impacts followed over rings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts import NormalMotion, Status, WholeImpact, sliding
from contactlab.impact.scene import Scene
from contactlab_laws.halfspace.hemispheres import Array
from contactlab_laws.halfspace.impacts import Impacts, Matter, Options, followed
from contactlab_laws.halfspace.own_motion import own_motion
from contactlab_laws.halfspace.picture import Pictures

#: Residual above which a step counts as unsolved.
LARGEST_RESIDUAL = 1e-6
#: Slip velocity, in psi over max(1, Lam, 4 chi), from which the answer is gross slip: all that it
#: leaves out is smaller by this squared.
GRAZING = 1e6
#: Least declared error times rings² over chi and 3 psi1 (up to 1), for numbers of rings whose
#: answers agree by chance: this times chi², from ``LEAST`` to 1. Beyond chi = 2.5 slip comes and
#: goes more often.
GROWTH, LEAST = 0.07, 0.1
#: Largest error by eight angles: eight and sixteen differ by less, for Lam up to 2.
ANGLES_ERROR = 3e-4


class Answered(NamedTuple):
    """Answers to impacts, arrays of shape (impacts,) in dimensionless units.

    ``impulse`` and ``share`` are lists of the histories of each impact, ``impulse`` from 0 to that
    of the whole impact. ``departing`` are the impacts whose normal motion changes, by index, and
    their places among those followed together.
    """

    change: Array
    work: Array
    error: Array
    residual: Array
    impulse: list[Array]
    share: list[Array]
    departing: dict[int, tuple[Impacts, int]]


def own_answers(
    options: Options, scene: Scene, normal: NormalMotion, known: Sequence[WholeImpact]
) -> tuple[WholeImpact, ...]:
    """Return the answers for the impacts that ``known`` leaves over."""
    shape = scene.shape
    left = np.broadcast_to(np.asarray(normal.status, dtype=object) == Status.SUCCESS, shape)
    for each in known:
        left = left & ~np.broadcast_to(each.where, shape)
    with np.errstate(all="ignore"):
        grazing = left & (np.abs(scene.psi1) >= GRAZING * np.maximum(1.0, 4.0 * scene.chi))
    answers = []
    if grazing.any():
        reason = "the impact slips throughout: it grazes"
        where = grazing if shape else True
        answers.append(sliding(scene, normal, where=where, reason=reason, stops=False))
    left = left & ~grazing
    if left.any():
        mine = normal.take(left) if shape else normal
        answers.append(_whole_impact(options, normal, mine, left))
    return tuple(answers)


def answered(options: Options, normal: NormalMotion) -> Answered:
    """Return the answers to the impacts of a normal motion of shape () or (impacts,)."""
    matter = Matter.of(normal)
    count = len(matter.psi1)
    change, work, error, residual = np.empty((4, count))
    impulse: list[Array] = [np.empty(0)] * count
    share: list[Array] = [np.empty(0)] * count
    departing: dict[int, tuple[Impacts, int]] = {}
    for items, fine, coarse, coupled in followed(options, normal, matter):
        change[items], work[items], residual[items] = fine.change, fine.work, fine.residual
        error[items], shares = math.nan, fine.share
        if coarse is not None:
            off = fine.change - coarse.change
            chi, slow = matter.chi[items], np.minimum(3.0 * np.abs(matter.psi1[items]), 1.0)
            by_chance = slow * chi * np.clip(GROWTH * chi**2, LEAST, 1.0)
            error[items] = np.abs(off) + by_chance / options.rings**2
            residual[items] = np.maximum(fine.residual, coarse.residual)
            if coupled:
                error[items] += ANGLES_ERROR
            else:
                work[items] += (fine.work - coarse.work) / 3.0
                shares = _extrapolated(fine, coarse)
                passed = np.diff(fine.impulse, axis=0) * (shares[1:] + shares[:-1])
                change[items] = -matter.chi[items] * passed.sum(axis=0)
        for place, item in enumerate(items.tolist()):
            impulse[item], share[item] = fine.impulse[:, place], shares[:, place]
            if fine.departures is not None:
                departing[item] = fine, place
    return Answered(change, np.maximum(work, 0.0), error, residual, impulse, share, departing)


def _extrapolated(fine: Impacts, coarse: Impacts) -> Array:
    """Return the extrapolated shares of Coulomb's limit, at the instants of ``fine``."""
    # Instants of half the rings are every other instant of all: their share is linear between.
    between = coarse.share.repeat(2, axis=0)[:-1]
    middle = coarse.impulse[:-1], fine.impulse[1::2], coarse.impulse[1:]
    with np.errstate(invalid="ignore", divide="ignore"):
        part = (middle[1] - middle[0]) / (middle[2] - middle[0])
    part = np.where(np.isfinite(part), part, 0.5)
    between[1::2] = coarse.share[:-1] + part * (coarse.share[1:] - coarse.share[:-1])
    return np.clip(fine.share + (fine.share - between) / 3.0, -1.0, 1.0)


def _whole_impact(
    options: Options, every: NormalMotion, normal: NormalMotion, left: Any
) -> WholeImpact:
    """Return the answer in SI units, with numbers of the batch shape."""
    # ``normal`` is the motion of the impacts that ``left`` marks in the batch of ``every``.
    solved, shape, scene = answered(options, normal), every.scene.shape, normal.scene
    numbers = np.flatnonzero(left).tolist()
    departing = {numbers[item]: each for item, each in solved.departing.items()}
    own = own_motion(every, departing) if departing else None
    unit: Any = 1.0 / np.atleast_1d(scene.psi_scale)
    mass: Any = np.atleast_1d(scene.pair.tangential_mass)
    momentum: Any = np.atleast_1d(scene.pair.normal_mass * scene.normal_speed)
    # Under huge friction unit² may exceed what a float holds, and the work is as small.
    change, work = unit * solved.change, mass * (unit * (unit * solved.work))
    friction = np.broadcast_to(scene.friction_coefficient, change.shape)
    units = np.broadcast_to(unit, change.shape), np.broadcast_to(momentum, change.shape)
    chi = np.broadcast_to(scene.chi, change.shape)

    def spread(values: Array) -> Any:
        if not shape:
            return float(values[0])
        whole = np.zeros(shape)
        whole[left] = values
        return whole

    def course(load_impulse: Any, load: Any) -> tuple[Any, Any]:
        outer = np.broadcast_shapes(np.shape(load_impulse), np.shape(load), shape)
        passed, acting = (np.broadcast_to(each, outer) for each in (load_impulse, load))
        gained, force = np.zeros(outer), np.zeros(outer)
        places = [()] if not shape else list(zip(*np.nonzero(left), strict=True))
        for item, place in enumerate(places):
            at = (..., *place)
            knots, shares = solved.impulse[item], solved.share[item]
            wanted = passed[at] / units[1][item]
            if own is not None and item in solved.departing:
                # The samples carry another impulse than the steps, for force is linear between.
                wanted = np.interp(passed[at], own.impulses[numbers[item]], knots)
            gained[at], share = _along(wanted, knots, shares)
            gained[at] *= -2.0 * chi[item] * units[0][item]
            force[at] = friction[item] * share * acting[at]
        return (gained, force) if outer else (float(gained), float(force))

    worst = float(solved.residual.max())
    bad = solved.residual > LARGEST_RESIDUAL
    detail = f"A step is solved to a residual of {worst:.2g} only, from HalfSpace."
    status: Any = Status.UNSETTLED if bad.any() else Status.SUCCESS
    if shape:
        status = np.full(shape, Status.SUCCESS, dtype=object)
        status[left] = [Status.UNSETTLED if each else Status.SUCCESS for each in bad.tolist()]
    most = "at most " if shape else ""
    return WholeImpact(
        where=left if shape else True,
        slip_velocity_change=spread(change),
        friction_work=spread(work),
        reason=f"followed by the law over {options.rings} rings, residual {most}{worst:.1e}",
        course=course,
        fields=Pictures(options, every, left).at,
        psi2_error=spread(solved.error),
        normal=None if own is None else own.motion,
        status=status,
        detail=detail if bad.any() else "",
    )


def _along(impulse: Any, knots: Array, shares: Array) -> tuple[Any, Any]:
    """Return the integral of the share over the impulse, and the share, at ``impulse``."""
    # The share is linear in the impulse between the knots.
    share = np.interp(impulse, knots, shares)
    at = np.clip(np.searchsorted(knots, impulse, side="right") - 1, 0, len(knots) - 1)
    before = np.concatenate(([0.0], np.cumsum(0.5 * (shares[1:] + shares[:-1]) * np.diff(knots))))
    return before[at] + 0.5 * (shares[at] + share) * (impulse - knots[at]), share
