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
from contactlab.contracts.status import Status
from contactlab.outcome.history import Recorder
from contactlab.testing import limits
from contactlab.testing.bench import bodies, scene
from contactlab.testing.check import check, hold
from contactlab.testing.compare import same
from contactlab.testing.laws import PressedSpring, Slider, SlidingForEver, Yielding

ENTRIES = (*TangentialMotion.numbers(), "status", "detail")
CHI = 1.4411764706


def fitting(integrator: Any, tangential: tuple[Any, ...], normal: Any) -> Iterator[Simulation]:
    """Iterate over simulations with those of the tangential laws that it can run."""
    normal_law = REGISTRY.create(normal) if isinstance(normal, str) else normal
    for law in tangential:
        if composition.misfit(normal_law, law, integrator) is None:
            yield Simulation(normal=normal_law, tangential=law, integrator=integrator)


def sound(integrator: Any) -> list[Simulation]:
    """Return simulations with laws that do not fail; at least one."""
    laws = (PressedSpring(), Yielding(), Slider(), SlidingForEver())
    found = list(fitting(integrator, laws, "normal.hertz"))
    hold(found, "It fits none of the laws of the kit: see the contracts that it states.")
    return found


def marched_impact(
    simulation: Simulation, psi1: Any, chi: Any = CHI, recorder: Any = None
) -> TangentialMotion:
    """Return the motion of an impact by the integrator alone: a plan might take a short cut.

    Parameters
    ----------
    simulation : Simulation
    psi1, chi : float or array
    recorder : callable, optional
        An observer.
    """
    return marched(simulation, scene(psi1, chi), recorder)


def marched(simulation: Simulation, given: Any, recorder: Any = None) -> TangentialMotion:
    """Return the motion of a scene by the integrator alone."""
    limits.begin(f"an impact under {type(simulation.tangential).__name__}")
    normal = normal_motion(simulation.normal, given)
    return simulation.integrator.integrate(normal, simulation.tangential, given, recorder)


@check(Integrator)
def ends_well(integrator: Any) -> None:
    """Sound laws are followed from first touch to separation, to plain numbers (Integrator, 1)."""
    for simulation in sound(integrator):
        motion = marched_impact(simulation, 2.0)
        hold(
            isinstance(motion, TangentialMotion),
            f"It returns a {type(motion).__name__}, not a TangentialMotion.",
        )
        hold(motion.status is Status.SUCCESS, f"{motion.status} {motion.detail}")
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
    """An observer sees increasing times, and having one changes no result (Integrator, 3)."""
    for simulation in sound(integrator):
        recorder = Recorder((), with_fields=True)
        alone, watched = (
            marched_impact(simulation, 2.0),
            marched_impact(simulation, 2.0, recorder=recorder),
        )
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
    """Two runs are alike, whatever was run between them, and leave the integrator as it was."""
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
    """An impact from the other side is followed as the mirror image (TangentialLaw, 2)."""
    for simulation in sound(integrator):
        for psi1 in (0.3, 2.0, 12.0):
            there, back = (marched_impact(simulation, sense * psi1) for sense in (1.0, -1.0))
            change, other = (float(np.asarray(one.slip_velocity_change)) for one in (there, back))
            lost = float(np.asarray(back.friction_work)) - float(np.asarray(there.friction_work))
            gap = max(abs(other / change + 1.0), abs(lost) / _energy(psi1))
            name = type(simulation.tangential).__name__
            hold(
                gap <= 1e-9,
                f"psi1 = -{psi1}: the motion is {gap:.1e} off the mirror image of that of {psi1} "
                f"({name})."
                " Bound: 1e-9.",
            )


def _energy(psi1: float) -> float:
    """Return the kinetic energy of slip of a scene of the kit, in J."""
    given: Any = scene(psi1, CHI)
    return float(0.5 * given.pair.tangential_mass * given.slip_velocity**2)


@check(Integrator)
def impacts_batch(integrator: Any) -> None:
    """A batch of unlike bodies gives what its impacts give one by one (Integrator, 5)."""
    psi1 = np.array([[-2.0, 0.0, 0.3], [1.2, 5.0, 40.0]])
    chi = np.array([[0.4, 1.0, 1.5], [1.5, 3.0, 3.0]])
    given = scene(psi1, chi, bodies=bodies(*psi1.shape))
    for simulation in sound(integrator):
        together = marched(simulation, given)
        for name in ENTRIES:
            hold(
                np.shape(getattr(together, name)) == psi1.shape,
                f"{name} has not the batch's shape.",
            )
        for place in np.ndindex(psi1.shape):
            one = given.take(place)
            alone = marched(simulation, one)
            hold(together.status[place] is alone.status, "An impact of a batch ends otherwise.")
            speed = float(np.asarray(one.normal_speed))
            mass = float(np.asarray(one.pair.tangential_mass))
            for name, least in (
                ("slip_velocity_change", 1e-6 * speed),
                ("friction_work", 1e-6 * mass * speed**2),
            ):
                here, there = getattr(alone, name), float(getattr(together, name)[place])
                gap = abs(here - there) / max(abs(here), least)
                hold(
                    gap <= 1e-9,
                    f"The {name} of an impact of a batch is off by {gap:.1e}. Bound: 1e-9.",
                )
