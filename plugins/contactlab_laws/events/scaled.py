"""Impacts in the scaled units of theory §1, and their answers in SI."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    ClosedFormMotion,
    ManyPhasedTangentialLaw,
    PhasedTangentialLaw,
    PhaseState,
    TangentialMotion,
)
from contactlab.contracts.status import Status
from contactlab.numeric.arrays import chosen
from contactlab.numeric.checks import Real
from contactlab_laws.events.trajectory import Trajectory, books_miss, trajectory

#: Below this friction may stop no slip at all, however slow, and nothing is scaled.
LEAST_INERTIA = 1e-99
#: Fewer impacts take longer together than one by one: a call of some hundred panels costs what it
#: costs, however many impacts are in it.
FEWEST = 64
#: Books that miss by more, over the tangential energy, are not taken: an event was misplaced, or
#: the law is not as exact here as it is one by one.
BOOKS = 3e-7


class SolvedImpact(NamedTuple):
    """One impact, its scaled trajectory, and its motion in SI.

    ``factor`` is what the trajectory is multiplied with, see ``ScaledImpact.posed``.
    """

    impact: ScaledImpact
    law: PhasedTangentialLaw
    trajectory: Trajectory
    factor: float
    motion: TangentialMotion


class ScaledImpact(NamedTuple):
    """One impact in scaled units, or a batch, and what leads back to SI.

    ``velocity_unit`` is mu v1/kappa (29), ``force_unit`` mu P_max; both 0 without friction.
    """

    motion: ClosedFormMotion
    velocity: Any
    inertia: Any
    slip_velocity: Any
    velocity_unit: Any
    force_unit: Any
    time_unit: Any

    def posed(self, law: PhasedTangentialLaw) -> tuple[Real, Real]:
        """Return the velocity >= 0 to solve for, and the factor that leads back from it.

        A law is odd, and linear for small velocities.
        """
        speed, factor = abs(self.velocity), chosen(self.velocity < 0.0, -1.0, 1.0)
        slow = (speed > 0.0) & (speed < law.linear_below) & (self.inertia > LEAST_INERTIA)
        part = chosen(slow, speed / (law.linear_below or 1.0), 1.0)
        return chosen(slow, law.linear_below, speed), factor * part

    def answer(self, factor: Real, change: Real, work: Real) -> tuple[Real, Real]:
        """Return change of slip velocity and friction work in SI."""
        # A tiny factor stands for a huge friction coefficient: each unit takes its own.
        velocity_unit, force_unit = factor * self.velocity_unit, factor * self.force_unit
        with np.errstate(invalid="ignore", over="ignore"):
            done = velocity_unit * self.time_unit * force_unit * work
        # Without work there is none, however large its unit.
        return velocity_unit * change, chosen(work == 0.0, 0.0, done)

    def solve(self, law: PhasedTangentialLaw, tolerance: float) -> SolvedImpact:
        """Return one impact solved; its motion is NaN where that failed."""
        speed, factor = map(float, self.posed(law))
        found = Trajectory(PhaseState(math.pi, 0.0, 0.0, speed, 0.0, 0.0, 0.0))
        if not (math.isfinite(speed) and math.isfinite(self.inertia) and self.inertia > 0.0):
            nowhere = found.state._replace(x=0.0, change=math.nan)
            failure = "psi1 or chi is not finite and positive."
            found = Trajectory(nowhere, failure, status=Status.NON_FINITE)
        elif speed != 0.0 and self.force_unit != 0.0:  # something moves, and something resists
            found = trajectory(law, self.motion, self.inertia, speed, tolerance)
        usable = 1.0 if found.status is Status.SUCCESS else math.nan
        change, work = self.answer(factor, found.state.change, found.state.work)
        motion = TangentialMotion(
            slip_velocity_change=usable * change,
            friction_work=usable * work,
            status=found.status,
            detail=found.failure,
            counters={"panels": len(found.segments), "solves": found.solves},
        )
        return SolvedImpact(self, law, found, factor, motion)


def scaled(motion: ClosedFormMotion) -> ScaledImpact:
    """Return one impact in scaled units, or a batch of them."""
    scene = motion.scene
    speed, kappa = scene.normal_speed, scene.pair.stiffness_ratio
    friction, slip_velocity = scene.friction_coefficient, scene.slip_velocity
    force, approach = motion.maximum_force, motion.maximum_approach
    unit = friction * speed / kappa
    none = unit == 0.0
    return ScaledImpact(
        motion=motion,
        velocity=slip_velocity / (unit + none) * (1.0 - none),
        inertia=kappa * (force / speed) * (approach / speed) / scene.pair.tangential_mass,
        slip_velocity=slip_velocity,
        velocity_unit=unit,
        force_unit=friction * force,
        time_unit=approach / speed,
    )


def together(
    law: ManyPhasedTangentialLaw, normal: ClosedFormMotion, tolerance: float
) -> tuple[NDArray[np.bool_], TangentialMotion]:
    """Return which impacts of a batch were solved in one call, and the motion of those."""
    shape = normal.scene.shape
    with np.errstate(all="ignore"):
        impact = scaled(normal)
        speed, factor = (np.broadcast_to(part, shape) for part in impact.posed(law))
        inertia = np.broadcast_to(impact.inertia, shape)
        known = (speed > 0.0) & np.isfinite(speed) & (inertia > 0.0) & np.isfinite(inertia)
        known &= np.greater(impact.force_unit, 0.0)
        change, work = np.zeros(shape), np.zeros(shape)
        found = law.impacts_together(speed[known], inertia[known], normal, tolerance)
        change[known], work[known] = found.change, found.work
        known[known] = found.solved
        known &= books_miss(speed, inertia, change, work) < BOOKS
        gained, lost = np.broadcast_arrays(*impact.answer(factor, change, work))
    return known, TangentialMotion(
        slip_velocity_change=gained[known],
        friction_work=lost[known],
        status=np.full(np.count_nonzero(known), Status.SUCCESS, dtype=object),
        counters={"panels": found.panels, "solves": found.panels},
    )
