"""Checks of an integrator under laws that fail, and under laws without end."""

from __future__ import annotations

from contactlab.contracts import Integrator
from contactlab.runs.simulation import Simulation
from contactlab.testing.check import CheckFailedError, apply_if, check, hold
from contactlab.testing.faulty_laws import (
    Endless,
    FailingSpring,
    SpoiledHertz,
    TooManyCallsError,
    UnsettledSpring,
    Unyielding,
)
from contactlab.testing.integrators import CHI, march_impact
from contactlab.testing.laws import PressedSpring, Slider, SlidingForEver
from contactlab.testing.load_paths import scene
from contactlab.testing.ways import fitting

NONE_FIT = "None of the faulty laws of the kit fits it."


@check(Integrator)
def faults_reported(integrator: Integrator) -> None:
    """A law that answers NaN, does not settle or raises gives a status and the partial history."""
    faulty = (
        FailingSpring(),
        FailingSpring(raises=True),
        UnsettledSpring(),
        SlidingForEver(fails=True),
    )
    _hold_reports([*fitting(integrator, faulty, "normal.hertz")], least=1)


@check(Integrator)
def faults_named(integrator: Integrator) -> None:
    """The detail names a law that raises, at the start or later (Integrator, 2)."""
    faulty = (
        FailingSpring(raises=True),
        FailingSpring(raises=True, at=0),
        SlidingForEver(at_once=True),
    )
    simulations = [*fitting(integrator, faulty, "normal.hertz")]
    apply_if(simulations, NONE_FIT)
    for simulation in simulations:
        detail = simulation.run(scene(2.0, CHI)).motion.detail
        name = type(simulation.tangential).__name__
        hold(name in detail, f"{name} raised, and is not named: {detail!r}.")


@check(Integrator)
def normal_faults_reported(integrator: Integrator) -> None:
    """A normal motion that becomes NaN gives a status, never an answer."""
    laws = (PressedSpring(), Slider(), SlidingForEver())
    _hold_reports([*fitting(integrator, laws, SpoiledHertz())], least=0)


@check(Integrator)
def bounded(integrator: Integrator) -> None:
    """A run ends, under a law of any stiffness and under endless events (Integrator, 2)."""
    simulations = list(fitting(integrator, (Unyielding(), Endless()), "normal.hertz"))
    apply_if(simulations, NONE_FIT)
    for simulation in simulations:
        name = type(simulation.tangential).__name__
        endless = f"{name} is called without end."
        try:
            motion = march_impact(simulation, 2.0)
        except TooManyCallsError:
            raise CheckFailedError(endless) from None
        hold(TooManyCallsError.__name__ not in motion.detail, endless)
        if isinstance(simulation.tangential, Endless):
            hold(not motion.status, "A run with endless events is reported as a success.")


def _hold_reports(simulations: list[Simulation], *, least: int) -> None:
    """Hold that each run ends with a status, a detail, and ``least`` instants of history."""
    apply_if(simulations, NONE_FIT)
    for simulation in simulations:
        result = simulation.run(scene(2.0, CHI), history=True)
        who = f"{type(simulation.normal).__name__} and {type(simulation.tangential).__name__}"
        hold(not result.status, f"A fault in {who} reads as success.")
        hold(result.motion.detail, f"{result.status.name} says nothing of what and where: {who}.")
        instants = len(result.history.time) if result.history else 0
        hold(instants >= least, f"{instants} instants of the history are left ({who}).")
