"""Checks of an integrator under sound laws: its answers, observers, purity, batches."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from contactlab import composition
from contactlab.contracts import Integrator
from contactlab.contracts.integrator import MOTION_ENTRIES, MOTION_NUMBERS
from contactlab.history import Recorder
from contactlab.registry import REGISTRY
from contactlab.simulation import Simulation
from contactlab.status import Status
from contactlab.testing.bench import scene
from contactlab.testing.check import check, hold
from contactlab.testing.compare import same
from contactlab.testing.laws import PressedSpring, SlidingForEver

CHI = 1.4411764706


def fitting(integrator: Any, tangential: tuple[Any, ...], normal: Any) -> Iterator[Simulation]:
    """Iterate over simulations with those of the tangential laws that it can run."""
    pressing = REGISTRY.create(normal) if isinstance(normal, str) else normal
    for law in tangential:
        try:
            composition.check_fit(pressing, law, integrator)
        except ValueError:
            continue
        yield Simulation(normal=pressing, tangential=law, integrator=integrator)


def sound(integrator: Any) -> list[Simulation]:
    """Return simulations with laws that do not fail; at least one."""
    laws = (REGISTRY.create("tangential.coulomb"), PressedSpring(), SlidingForEver())
    found = list(fitting(integrator, laws, "normal.hertz"))
    hold(found, "It fits none of the laws of the kit: see what it needs.")
    return found


def run(way: Simulation, psi1: Any, chi: Any = CHI, recorder: Any = None) -> Any:
    """Run an impact past the plan, which might take a short cut."""
    return way.integrator.integrate(way.problem(scene(psi1, chi)), recorder)


@check(Integrator)
def ends_well(integrator: Any) -> None:
    """Sound laws are followed from first touch to separation (Integrator, 1)."""
    given: Any = scene(2.0, CHI)
    for way in sound(integrator):
        motion = run(way, 2.0)
        hold(motion.status is Status.SUCCESS, f"{motion.status} {motion.detail}")
        bounce = abs(motion.normal_velocity / given.normal_speed + 1.0)
        hold(bounce <= 0.02, f"An elastic impact ends at {-motion.normal_velocity:.4g} m/s, from "
             f"{given.normal_speed:.4g}.")  # fmt: skip
        late = abs(motion.duration / given.duration - 1.0)
        hold(late <= 0.05, f"A Hertz impact takes {motion.duration:.4g} s, not eq. (7).")
        for name in ("slip_velocity_change", "friction_work"):
            value = getattr(motion, name)
            hold(isinstance(value, float) and math.isfinite(value), f"{name} = {value!r}.")


@check(Integrator)
def observer_changes_nothing(integrator: Any) -> None:
    """An observer sees increasing times, and having one changes no result (Integrator, 3)."""
    for way in sound(integrator):
        recorder = Recorder((), with_fields=True)
        plain, watched = run(way, 2.0), run(way, 2.0, recorder=recorder)
        for name in MOTION_ENTRIES:
            hold(
                same(getattr(plain, name), getattr(watched, name)),
                f"Watched, the {name} is {getattr(watched, name)!r}, not {getattr(plain, name)!r}.",
            )
        times = recorder.history().time
        hold(len(times) > 1, "The observer was not called.")
        hold(np.all(np.diff(times) > 0.0), "The observer was called at times that do not increase.")
        reach = times[-1] / plain.duration
        hold(
            0.8 <= reach <= 1.0 + 1e-9, f"The last instant seen is at {reach:.3g} of the duration."
        )


@check(Integrator)
def integrator_pure(integrator: Any) -> None:
    """Two runs are alike, whatever was run between them, and leave the integrator as it was."""
    for way in sound(integrator):
        kept = copy.deepcopy(integrator)
        first = run(way, 2.0)
        run(way, 0.3, 3.0)
        hold(same(first, run(way, 2.0)), "The same impact, run twice, ends differently.")
        hold(same(kept, integrator), "A run changed the integrator.")


@check(Integrator)
def impacts_batch(integrator: Any) -> None:
    """A batch gives what its impacts give one by one (Integrator, 5)."""
    psi1 = np.array([[-2.0, 0.0, 0.3], [1.2, 5.0, 40.0]])
    chi = np.array([[0.4, 1.0, 1.5], [1.5, 3.0, 3.0]])
    for way in sound(integrator):
        together = run(way, psi1, chi)
        for name in MOTION_ENTRIES:
            hold(
                np.shape(getattr(together, name)) == psi1.shape,
                f"{name} has not the batch's shape.",
            )
        for place in np.ndindex(psi1.shape):
            alone = run(way, float(psi1[place]), float(chi[place]))
            hold(together.status[place] is alone.status, "An impact of a batch ends otherwise.")
            for name in MOTION_NUMBERS:
                one, other = getattr(alone, name), float(getattr(together, name)[place])
                gap = abs(one - other) / max(abs(one), 1e-6 * scene(1.0, 1.0).normal_speed ** 2)
                hold(gap <= 1e-9, f"The {name} of an impact of a batch is off by {gap:.1e}.")
