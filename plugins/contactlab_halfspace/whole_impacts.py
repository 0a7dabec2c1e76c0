"""Whole-impact answers of the half-space, from impacts followed over rings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from contactlab.contracts import NormalMotion, Status, WholeImpact, sliding
from contactlab.contracts.status import Statuses
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Index, Mask, Real
from contactlab_halfspace.changed_motion import change_motion
from contactlab_halfspace.fields import Fields
from contactlab_halfspace.groups import Options, groups
from contactlab_halfspace.instants import units
from contactlab_halfspace.march import Followed

#: Residual above which a step counts as unsolved.
LARGEST_RESIDUAL = 1e-6
#: Slip velocity, in psi over max(1, Lam, 4 chi, w), from which the answer is gross slip: all that
#: it leaves out of psi2 is smaller by this squared, and the loss of spin by this.
GRAZING = 1e6
#: Least declared error times rings² over chi and 3 psi1 (up to 1), for numbers of rings whose
#: answers agree by chance: this times chi², from ``LEAST`` to 1. Beyond chi = 2.5 slip comes and
#: goes more often.
GROWTH, LEAST = 0.07, 0.1
#: Largest error by eight angles: eight and sixteen differ by less, for Lam up to 2.
ANGLES_ERROR = 3e-4
#: The same with spin about the normal: up to a w, and beyond.
LITTLE_SPIN, ANGLES_OF_SPIN = 0.5, (1e-3, 5e-3)
#: The error falls as 1/rings to these powers. Tractions of slip are sums of hemispheres; those of
#: spin are not, and a sum of roots that meets them at points is off between by 1/rings^1.5.
ORDER, ORDER_OF_SPIN = 2.0, 1.5
#: w over max(1, psi1) from which spin turns all slip: psi2 then errs by the square again.
FAST = 50.0


def own_answers(
    options: Options, scene: Scene, normal: NormalMotion, known: Sequence[WholeImpact]
) -> tuple[WholeImpact, ...]:
    """Return the answers for the impacts that ``known`` leaves over."""
    shape = scene.shape
    left = np.broadcast_to(np.asarray(normal.status, dtype=object) == Status.SUCCESS, shape)
    for each in known:
        left = left & ~np.broadcast_to(each.where, shape)
    with np.errstate(all="ignore"):
        far = np.maximum(1.0, 4.0 * scene.chi)
        if options.spins and kinetics.turns(scene):
            far = np.maximum(far, np.abs(scene.w1))
        grazing = left & (np.abs(scene.psi1) >= GRAZING * far)
    answers = []
    if grazing.any():
        reason = "the impact slips throughout: it grazes"
        where = grazing if shape else True
        answers.append(sliding(scene, normal, where=where, reason=reason, stops=False))
    left = left & ~grazing
    if left.any():
        answers.append(_whole_impact(options, normal, left))
    return tuple(answers)


class _Solved(NamedTuple):
    """One impact in dimensionless units; change, work and share may be extrapolated."""

    # change of slip velocity, friction work, error of psi2, residual, change of w, its error
    numbers: list[float]
    impulse: Array
    share: Array
    changed: tuple[Array, Array] | None  # phases and departures of its normal motion


def _solve(options: Options, normal: NormalMotion) -> list[_Solved]:
    """Return the impacts of a normal motion of shape () or (impacts,)."""
    solved: dict[int, _Solved] = {}
    rings, angles = options.rings, options.angles
    for group in groups(options, normal):
        fine, matter = group.follow(rings, angles), group.matter
        change, work, share = fine.change[-1], fine.work, fine.share
        residual, error = fine.residual, np.full(work.shape, math.nan)
        spin = 0.0 * work if fine.spin is None else fine.spin
        spin_error = 0.0 * work
        if options.extrapolate:
            coarse = group.follow(rings // 2, angles)
            off = change - coarse.change[-1]
            slow = np.minimum(3.0 * np.abs(matter.psi1), 1.0)
            by_chance = slow * matter.chi * np.clip(GROWTH * matter.chi**2, LEAST, 1.0)
            error = np.abs(off) + by_chance / rings**2
            residual = np.maximum(residual, coarse.residual)
            if group.coupling != "none":
                error += ANGLES_ERROR
            else:
                further = 1.0 / (2.0 ** (ORDER_OF_SPIN if group.spins else ORDER) - 1.0)
                work = work + (work - coarse.work) * further
                fast = np.abs(matter.rim) >= FAST * np.maximum(1.0, np.abs(matter.psi1))
                of_slip = np.where(fast, 1.0 / (2.0**ORDER - 1.0), further)
                share = _extrapolate(fine, coarse, of_slip)
                if coarse.spin is not None:
                    little = np.abs(matter.rim) <= LITTLE_SPIN
                    error += np.where(little, *ANGLES_OF_SPIN) * slow
                    spin_error = np.abs(spin - coarse.spin)
                    spin = spin + (spin - coarse.spin) * further
                passed = np.diff(fine.impulse, axis=0) * (share[1:] + share[:-1])
                change = -matter.chi * passed.sum(axis=0)
                if group.spins:  # friction mostly against spin must not speed up slip
                    opposes = change * matter.psi1 <= 0.0
                    change, share = change * opposes, share * opposes
        if group.spins:  # by symmetry there is no force without slip
            change = np.where(matter.psi1 == 0.0, 0.0, change)
        columns = change, np.maximum(work, 0.0), error, residual, spin, spin_error
        numbers: list[list[float]] = np.stack(columns, axis=1).tolist()
        phase = None if fine.departures is None else group.path(rings).phase[:, 0]
        for place, item in enumerate(group.items.tolist()):
            changed = None
            if phase is not None and fine.departures is not None:
                changed = phase, fine.departures[:, :, place]
            solved[item] = _Solved(numbers[place], fine.impulse[:, place], share[:, place], changed)
    return [solved[item] for item in range(len(solved))]


def _extrapolate(fine: Followed, coarse: Followed, further: Real) -> Array:
    """Return the extrapolated shares of Coulomb's limit, at the instants of ``fine``."""
    # Instants of half the rings are every other instant of all: their share is linear between.
    between = coarse.share.repeat(2, axis=0)[:-1]
    middle = coarse.impulse[:-1], fine.impulse[1::2], coarse.impulse[1:]
    with np.errstate(invalid="ignore", divide="ignore"):
        part = (middle[1] - middle[0]) / (middle[2] - middle[0])
    part = np.where(np.isfinite(part), part, 0.5)
    between[1::2] = coarse.share[:-1] + part * (coarse.share[1:] - coarse.share[:-1])
    return np.clip(fine.share + (fine.share - between) * further, -1.0, 1.0)


def _whole_impact(options: Options, every: NormalMotion, left: Mask) -> WholeImpact:
    """Return the answer in SI units of the impacts ``left``, with numbers of the batch shape."""
    shape = every.scene.shape
    normal = every.take(np.asarray(left)) if shape else every
    solved, scene, numbers = _solve(options, normal), normal.scene, np.flatnonzero(left).tolist()
    own, own_impulses = None, dict[int, Array]()
    changed = {n: each.changed for n, each in zip(numbers, solved, strict=True) if each.changed}
    if changed:
        own, own_impulses = change_motion(every, changed)
    change, work, error, residual, spin, off = np.array([each.numbers for each in solved]).T
    unit = 1.0 / np.atleast_1d(scene.psi_scale)
    mass = np.atleast_1d(scene.pair.tangential_mass)
    # Under huge friction unit² may exceed what a float holds, and the work is as small.
    change, work = unit * change, mass * (unit * (unit * work))
    momentum = scene.pair.normal_mass * scene.normal_speed
    each_of = unit, momentum, scene.friction_coefficient, scene.chi
    scales = np.broadcast_arrays(*map(np.atleast_1d, each_of), change)[:4]

    def spread(values: Array) -> Real:
        if not shape:
            return float(values[0])
        whole = np.zeros(shape)
        whole[left] = values
        return whole

    def course(load_impulse: Real, load: Real) -> tuple[Real, Real]:
        outer = np.broadcast_shapes(np.shape(load_impulse), np.shape(load), shape)
        passed, acting = (np.broadcast_to(each, outer) for each in (load_impulse, load))
        gained, force = np.zeros(outer), np.zeros(outer)
        places = np.argwhere(left).tolist() if shape else [()]
        for number, place, each, scale in zip(
            numbers, places, solved, np.transpose(scales).tolist(), strict=True
        ):
            velocity, impulse, friction, chi = scale
            at: Index = (..., *place)
            wanted = passed[at] / impulse
            if number in own_impulses:
                # The samples carry another impulse than the steps, for force is linear between.
                wanted = np.interp(passed[at], own_impulses[number], each.impulse)
            gained[at], share = _integrate_share(wanted, each.impulse, each.share)
            gained[at] *= -2.0 * chi * velocity
            force[at] = friction * share * acting[at]
        return (gained, force) if outer else (float(gained), float(force))

    worst, bad = float(residual.max()), residual > LARGEST_RESIDUAL
    detail = f"A step is solved to a residual of {worst:.2g} only, from HalfSpace."
    status: Statuses = Status.UNSETTLED if bad.any() else Status.SUCCESS
    if shape:
        status = np.full(shape, Status.SUCCESS, dtype=object)
        status[left] = [Status.UNSETTLED if each else Status.SUCCESS for each in bad.tolist()]
    most = "at most " if shape else ""
    reason = f"followed by the law over {options.rings} rings, residual {most}{worst:.1e}"
    if off.any():
        reason += f", numerical error of w2 {most}{off.max():.1e}"
    return WholeImpact(
        where=left if shape else True,
        slip_velocity_change=spread(change),
        friction_work=spread(work),
        reason=reason,
        course=course,
        fields=Fields(options, every, left).at,
        psi2_error=spread(error),
        normal=own,
        normal_spin_change=spread(spin * (unit / units(normal).length)),
        status=status,
        detail=detail if bad.any() else "",
    )


def _integrate_share(impulse: Real, knots: Array, shares: Array) -> tuple[Real, Real]:
    """Return the integral of the share over the impulse, and the share, at ``impulse``."""
    # The share is linear in the impulse between the knots.
    share = np.interp(impulse, knots, shares)
    at = np.clip(np.searchsorted(knots, impulse, side="right") - 1, 0, len(knots) - 1)
    before = np.concatenate(([0.0], np.cumsum(0.5 * (shares[1:] + shares[:-1]) * np.diff(knots))))
    return before[at] + 0.5 * (shares[at] + share) * (impulse - knots[at]), share
