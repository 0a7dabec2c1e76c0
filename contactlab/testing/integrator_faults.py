"""Checks of an integrator under laws that fail, and contact that never ends."""

from __future__ import annotations

from typing import Any

from contactlab.contracts import Integrator
from contactlab.registry import REGISTRY
from contactlab.simulation import Simulation
from contactlab.testing.bench import scene
from contactlab.testing.check import apply_if, check, hold
from contactlab.testing.integrators import CHI, fitting, run
from contactlab.testing.laws import FailingSpring, LinearPress, PressedSpring, SlidingForEver

NEVER_ASKED = "It takes only motions in closed form: it asks no normal law step by step."


@check(Integrator)
def faults_reported(integrator: Any) -> None:
    """A law that answers NaN or raises gives a status, with the history so far (Integrator, 1)."""
    faulty = (FailingSpring(), FailingSpring(raises=True), SlidingForEver(fails=True))
    _reported([*fitting(integrator, faulty, "normal.hertz")], least=1)


@check(Integrator)
def faults_named(integrator: Any) -> None:
    """A law that raises, at the start or later, is named in the detail (Integrator, 1)."""
    faulty = (
        FailingSpring(raises=True),
        FailingSpring(raises=True, at=0),
        SlidingForEver(at_once=True),
    )
    ways = [*fitting(integrator, faulty, "normal.hertz")]
    apply_if(ways, NEVER_ASKED)
    for way in ways:
        detail, name = run(way, 2.0).detail, type(way.tangential).__name__
        hold(name in detail, f"{name} raised, and is not named: {detail!r}.")


@check(Integrator)
def normal_faults_reported(integrator: Any) -> None:
    """A normal law that answers NaN gives a status, never "no contact" (Integrator, 1)."""
    laws = (REGISTRY.create("tangential.coulomb"), PressedSpring(), SlidingForEver())
    for at in (1, 2, 9):
        _reported([*fitting(integrator, laws, LinearPress(answers="nan", at=at))], least=0)


@check(Integrator)
def bounded(integrator: Any) -> None:
    """A contact that never ends is given up, with a status (Integrator, 2)."""
    laws = (REGISTRY.create("tangential.coulomb"), SlidingForEver())
    ways = list(fitting(integrator, laws, LinearPress(answers="nothing")))
    apply_if(ways, NEVER_ASKED)
    for way in ways:
        motion = run(way, 2.0)
        hold(not motion.status, "A contact that never ends is said to have ended.")


def _reported(ways: list[Simulation], *, least: int) -> None:
    """Hold that each of these runs ends with a status, what and where, and its history so far."""
    apply_if(ways, NEVER_ASKED)
    for way in ways:
        result = way.run(scene(2.0, CHI), history=True)
        who = f"{type(way.normal).__name__} and {type(way.tangential).__name__}"
        hold(not result.status, f"A fault in {who} reads as success.")
        hold(result.motion.detail, f"{result.status.name} says nothing of what and where: {who}.")
        hold(result.history is not None, "There is no history.")
        instants = len(result.history.time) if result.history is not None else 0
        hold(instants >= least, f"{instants} instants of the history are left ({who}).")
