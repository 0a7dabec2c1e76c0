"""Between SI units and the scaled ones in which phases are written (theory §1)."""

from __future__ import annotations

import math
from typing import NamedTuple

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
    slip_velocity_change: float
    friction_work: float
    status: Status
    failure: str


class Impact(NamedTuple):
    """One impact in scaled units, and what leads back to SI.

    ``velocity_unit`` is mu v1/kappa (29), ``force_unit`` mu P_max; both 0 without friction.
    """

    motion: ClosedFormMotion
    velocity: float
    inertia: float
    slip_velocity: float
    velocity_unit: float
    force_unit: float
    time_unit: float

    def run(self, law: PhasedTangentialLaw, tolerance: float) -> Run:
        """Follow the impact; a law is odd, so the velocity goes in without its sign."""
        speed = abs(self.velocity)
        factor = -1.0 if self.velocity < 0.0 else 1.0
        if 0.0 < speed < law.linear_below and self.inertia > LEAST_INERTIA:
            speed, factor = law.linear_below, factor * (speed / law.linear_below)
        if not (math.isfinite(speed) and math.isfinite(self.inertia) and self.inertia > 0.0):
            ended = PhaseState(0.0, 0.0, math.nan, math.nan, math.nan, math.nan, math.nan)
            followed = Followed("", ended, (), 0)
            status, failure = Status.NON_FINITE, "psi1 or chi is not finite and positive."
        elif speed == 0.0 or self.force_unit == 0.0:  # nothing moves, or nothing resists
            ended = PhaseState(math.pi, 0.0, 0.0, speed, 0.0, 0.0, 0.0)
            followed = Followed("", ended, (), 0)
            status, failure = Status.SUCCESS, ""
        else:
            followed = follow(law, self.motion, self.inertia, speed, tolerance)
            status, failure = followed.status, followed.failure
        state = followed.state
        usable = math.nan if status is not Status.SUCCESS else 1.0
        # A tiny factor stands for a huge friction coefficient: each unit takes its own.
        velocity_unit, force_unit = factor * self.velocity_unit, factor * self.force_unit
        # Without work there is none, however large its unit.
        work_unit = velocity_unit * self.time_unit * force_unit if state.work != 0.0 else 0.0
        return Run(
            impact=self,
            followed=followed,
            factor=factor,
            slip_velocity_change=usable * factor * state.change * self.velocity_unit,
            friction_work=usable * state.work * work_unit,
            status=status,
            failure=failure,
        )


def scaled(motion: ClosedFormMotion) -> Impact:
    """Return one impact in scaled units."""
    scene = motion.scene
    speed, kappa = float(scene.normal_speed), float(scene.pair.stiffness_ratio)
    friction, slip_velocity = float(scene.friction_coefficient), float(scene.slip_velocity)
    force, approach = float(motion.maximum_force), float(motion.maximum_approach)
    unit = friction * speed / kappa
    return Impact(
        motion=motion,
        velocity=slip_velocity / unit if unit else 0.0,
        inertia=kappa * (force / speed) * (approach / speed) / float(scene.pair.tangential_mass),
        slip_velocity=slip_velocity,
        velocity_unit=unit,
        force_unit=friction * force,
        time_unit=approach / speed,
    )
