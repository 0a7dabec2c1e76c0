"""Checks of an integrator under sound laws: its answers, observers, purity, batches."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from contactlab.compose import composition
from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.registry import REGISTRY
from contactlab.compose.simulation import Simulation
from contactlab.contracts import Integrator, TangentialMotion
from contactlab.outcome.history import Recorder
from contactlab.testing import limits
from contactlab.testing.check import check, hold, hold_success
from contactlab.testing.compare import same
from contactlab.testing.laws import PressedSpring, Slider, SlidingForEver, Yielding
from contactlab.testing.load_paths import bodies, scene

ENTRIES = (*TangentialMotion.numbers(), "status", "detail")
CHI = 1.4411764706


def fitting(integrator: Any, tangential: tuple[Any, ...], normal: Any) -> Iterator[Simulation]:
    """Iterate over simulations with the tangential laws that the integrator can run."""
    normal_law = REGISTRY.create(normal) if isinstance(normal, str) else normal
    for law in tangential:
        if composition.misfit(normal_law, law, integrator) is None:
            yield Simulation(normal=normal_law, tangential=law, integrator=integrator)


def sound(integrator: Any) -> list[Simulation]:
    """Return at least one simulation with laws of the kit that do not fail."""
    laws = (PressedSpring(), Yielding(), Slider(), SlidingForEver())
    simulations = list(fitting(integrator, laws, "normal.hertz"))
    hold(simulations, "It fits none of the laws of the kit: see the contracts that it states.")
    return simulations


def marched_impact(
    simulation: Simulation, psi1: Any, chi: Any = CHI, recorder: Any = None
) -> TangentialMotion:
    """Return the motion of an impact by the integrator alone, without whole-impact answers.

    Parameters
    ----------
    simulation : Simulation
    psi1, chi : float or array
    recorder : callable, optional
        Observer of the run.
    """
    return marched(simulation, scene(psi1, chi), recorder)


def marched(simulation: Simulation, impact: Any, recorder: Any = None) -> TangentialMotion:
    """Return the motion of a scene by the integrator alone, without whole-impact answers."""
    limits.begin(f"an impact under {type(simulation.tangential).__name__}")
    normal = normal_motion(simulation.normal, impact)
    return simulation.integrator.integrate(normal, simulation.tangential, impact, recorder)


@check(Integrator)
def ends_well(integrator: Any) -> None:
    """An impact under a sound law ends with success and finite numbers (Integrator, 1)."""
    for simulation in sound(integrator):
        motion = marched_impact(simulation, 2.0)
        hold(
            isinstance(motion, TangentialMotion),
            f"It returns a {type(motion).__name__}, not a TangentialMotion.",
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
def observer_changes_nothing(integrator: Any) -> None:
    """An observer is called at increasing times, and changes no result (Integrator, 3)."""
    for simulation in sound(integrator):
        recorder = Recorder((), with_fields=True)
        alone = marched_impact(simulation, 2.0)
        watched = marched_impact(simulation, 2.0, recorder=recorder)
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


@check(Integrator)
def integrator_pure(integrator: Any) -> None:
    """A run is repeatable after other runs, and does not change the integrator."""
    for simulation in sound(integrator):
        kept = copy.deepcopy(integrator)
        first = marched_impact(simulation, 2.0)
        marched_impact(simulation, 0.3, 3.0)
        hold(
            same(first, marched_impact(simulation, 2.0)),
            "The same impact, run twice, ends differently.",
        )
        hold(same(kept, integrator), "A run changed the integrator.")


@check(Integrator)
def mirror_images(integrator: Any) -> None:
    """An impact from the other side is the mirror image (TangentialLaw, 2)."""
    for simulation in sound(integrator):
        for psi1 in (0.3, 2.0, 12.0):
            motion, mirrored = (marched_impact(simulation, sense * psi1) for sense in (1.0, -1.0))
            change, mirrored_change = (
                float(np.asarray(each_motion.slip_velocity_change))
                for each_motion in (motion, mirrored)
            )
            work_gap = float(np.asarray(mirrored.friction_work)) - float(
                np.asarray(motion.friction_work)
            )
            gap = max(abs(mirrored_change / change + 1.0), abs(work_gap) / _energy(psi1))
            name = type(simulation.tangential).__name__
            hold(
                gap <= 1e-9,
                f"psi1 = -{psi1}: the motion is {gap:.1e} off the mirror image of that of {psi1} "
                f"({name})."
                " Bound: 1e-9.",
            )


def _energy(psi1: float) -> float:
    """Return the kinetic energy of slip of a scene of the kit, in J."""
    impact: Any = scene(psi1, CHI)
    return float(0.5 * impact.pair.tangential_mass * impact.slip_velocity**2)


@check(Integrator)
def impacts_batch(integrator: Any) -> None:
    """A batch of unlike bodies gives the same as each impact alone (Integrator, 5)."""
    psi1 = np.array([[-2.0, 0.0, 0.3], [1.2, 5.0, 40.0]])
    chi = np.array([[0.4, 1.0, 1.5], [1.5, 3.0, 3.0]])
    impacts = scene(psi1, chi, bodies=bodies(*psi1.shape))
    for simulation in sound(integrator):
        together = marched(simulation, impacts)
        for name in ENTRIES:
            hold(
                np.shape(getattr(together, name)) == psi1.shape,
                f"{name} has not the batch's shape.",
            )
        for place in np.ndindex(psi1.shape):
            impact = impacts.take(place)
            alone = marched(simulation, impact)
            hold(together.status[place] is alone.status, "An impact of a batch ends otherwise.")
            speed = float(np.asarray(impact.normal_speed))
            mass = float(np.asarray(impact.pair.tangential_mass))
            for name, least in (
                ("slip_velocity_change", 1e-6 * speed),
                ("friction_work", 1e-6 * mass * speed**2),
            ):
                expected, value = getattr(alone, name), float(getattr(together, name)[place])
                gap = abs(expected - value) / max(abs(expected), least)
                hold(
                    gap <= 1e-9,
                    f"The {name} of an impact of a batch is off by {gap:.1e}. Bound: 1e-9.",
                )
