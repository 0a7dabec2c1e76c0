"""Between SI units and the scaled ones in which phases are written (theory §1)."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlab.checks import Real
from contactlab.contracts import ClosedFormMotion, PhasedTangentialLaw, PhaseState
from contactlab.status import Status
from contactlab_events.follow import Followed, follow

#: Below this friction may stop no slip at all, however slow, and nothing is scaled.
LEAST_INERTIA = 1e-99


class Run(NamedTuple):
    """One impact followed, with its outcome in SI."""

    impact: Impact
    followed: Followed
    factor: float
    slip_velocity_change: Real
    friction_work: Real
    status: Status
    failure: str


class Impact(NamedTuple):
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
        speed, factor = abs(self.velocity), np.where(np.less(self.velocity, 0.0), -1.0, 1.0)
        slow = (speed > 0.0) & (speed < law.linear_below) & (self.inertia > LEAST_INERTIA)
        part = np.where(slow, speed / (law.linear_below or 1.0), 1.0)
        return np.where(slow, law.linear_below, speed), factor * part

    def answer(self, factor: Real, change: Real, work: Real) -> tuple[Real, Real]:
        """Return change of slip velocity and friction work in SI."""
        # A tiny factor stands for a huge friction coefficient: each unit takes its own.
        velocity_unit, force_unit = factor * self.velocity_unit, factor * self.force_unit
        with np.errstate(invalid="ignore", over="ignore"):
            done = velocity_unit * self.time_unit * force_unit * work
        # Without work there is none, however large its unit.
        return velocity_unit * change, np.where(np.equal(work, 0.0), 0.0, done)

    def run(self, law: PhasedTangentialLaw, tolerance: float) -> Run:
        """Follow one impact."""
        speed, factor = map(float, self.posed(law))
        status, failure = Status.SUCCESS, ""
        followed = Followed("", PhaseState(math.pi, 0.0, 0.0, speed, 0.0, 0.0, 0.0), (), 0)
        if not (math.isfinite(speed) and math.isfinite(self.inertia) and self.inertia > 0.0):
            ended = PhaseState(0.0, 0.0, math.nan, math.nan, math.nan, math.nan, math.nan)
            followed = Followed("", ended, (), 0)
            status, failure = Status.NON_FINITE, "psi1 or chi is not finite and positive."
        elif speed != 0.0 and self.force_unit != 0.0:  # something moves, and something resists
            followed = follow(law, self.motion, self.inertia, speed, tolerance)
            status, failure = followed.status, followed.failure
        usable = 1.0 if status is Status.SUCCESS else math.nan
        change, work = self.answer(factor, followed.state.change, followed.state.work)
        return Run(self, followed, factor, usable * change, usable * work, status, failure)


def scaled(motion: ClosedFormMotion) -> Impact:
    """Return one impact in scaled units, or a batch of them."""
    scene = motion.scene
    speed, kappa = scene.normal_speed, scene.pair.stiffness_ratio
    friction, slip_velocity = scene.friction_coefficient, scene.slip_velocity
    force, approach = motion.maximum_force, motion.maximum_approach
    unit = friction * speed / kappa
    none = unit == 0.0
    return Impact(
        motion=motion,
        velocity=slip_velocity / (unit + none) * (1.0 - none),
        inertia=kappa * (force / speed) * (approach / speed) / scene.pair.tangential_mass,
        slip_velocity=slip_velocity,
        velocity_unit=unit,
        force_unit=friction * force,
        time_unit=approach / speed,
    )
