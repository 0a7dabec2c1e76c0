"""Checks of an integrator under sound laws: its answers, observers, purity, batches."""

from __future__ import annotations

import math

import numpy as np

from contactlab.contracts import Integrator, Observer, TangentialMotion
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab.outcome.history import Recorder
from contactlab.runs.simulation import Simulation
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing import limits
from contactlab.testing.check import check, hold, hold_success
from contactlab.testing.compare import same
from contactlab.testing.impacts import ENTRIES
from contactlab.testing.load_paths import scene
from contactlab.testing.ways import sound

CHI = 1.4411764706


def march_impact(
    simulation: Simulation, psi1: Real, recorder: Observer | None = None
) -> TangentialMotion:
    """Return the motion of an impact by the integrator alone, without whole-impact answers."""
    return march_alone(simulation, scene(psi1, CHI), recorder)


def march_alone(
    simulation: Simulation, impact: Scene, recorder: Observer | None = None
) -> TangentialMotion:
    """Return the motion of a scene by the integrator alone, without whole-impact answers."""
    limits.begin(f"an impact under {type(simulation.tangential).__name__}")
    normal = normal_motion(simulation.normal, impact)
    return simulation.integrator.integrate(impact, normal, simulation.tangential, recorder)


@check(Integrator)
def ends_well(integrator: Integrator) -> None:
    """An impact under a sound law ends with success and finite numbers (Integrator, 2)."""
    for simulation in sound(integrator):
        motion = march_impact(simulation, 2.0)
        hold(
            isinstance(motion, TangentialMotion),
            f"The integrator returns a {type(motion).__name__}, not a TangentialMotion.",
        )
        hold_success(motion)
        hold(motion.detail == "", f"A success says {motion.detail!r}.")
        for name in TangentialMotion.numbers():
            value = getattr(motion, name)
            hold(isinstance(value, float) and math.isfinite(value), f"{name} = {value!r}.")
        hold(
            motion.slip_velocity_change < 0.0,
            f"v_x = {slip_velocity(2.0):.3g} m/s changes by {motion.slip_velocity_change:.3g}.",
        )
        counted = all(isinstance(value, int) for value in motion.counters.values())
        hold(counted, f"counters = {motion.counters!r}: must be whole numbers.")


def slip_velocity(psi1: float) -> float:
    """Return v_x of a scene of the kit, in m/s."""
    return float(np.asarray(scene(psi1, CHI).slip_velocity))


@check(Integrator)
def observer_changes_nothing(integrator: Integrator) -> None:
    """An observer is called at increasing times, and changes no result (Integrator, 2)."""
    for simulation in sound(integrator):
        recorder = Recorder((), with_fields=True)
        alone = march_impact(simulation, 2.0)
        watched = march_impact(simulation, 2.0, recorder=recorder)
        for name in ENTRIES:
            hold(
                same(getattr(alone, name), getattr(watched, name)),
                f"Watched, the {name} is {getattr(watched, name)!r}, not {getattr(alone, name)!r}.",
            )
        times = recorder.history().time
        duration = normal_motion(simulation.normal, scene(2.0, CHI)).duration
        hold(len(times) > 1, "The observer was not called.")
        hold(np.all(np.diff(times) > 0.0), "The observer was called at times that do not increase.")
        reach = times[-1] / duration if len(times) else 0.0
        hold(
            0.8 <= reach <= 1.0 + 1e-9, f"The last instant seen is at {reach:.3g} of the duration."
        )
