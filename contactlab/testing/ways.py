"""The ways in which a tangential law can be run, each of which is tried."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.registry import REGISTRY
from contactlab.compose.simulation import Simulation
from contactlab.contracts import (
    Integrator,
    NormalLaw,
    NormalMotion,
    Observer,
    PhasedTangentialLaw,
    SteppedTangentialLaw,
    TangentialLaw,
    TangentialMotion,
    WholeImpactTangentialLaw,
)
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.outcome.history import History, Recorder
from contactlab.testing import limits
from contactlab.testing.bench import scene, slack
from contactlab.testing.check import apply_if, hold
from contactlab.testing.units import Units

#: Steps of an impact; more if the law says that it needs more.
STEPS = 200
#: Steps of an impact beyond which a law is not followed: 200 become 700 at the most of ours.
MOST_STEPS = 20_000
#: What the integration may add to an error in psi: second order at 200 steps.
INTEGRATION = 2e-3
#: What rounding may add to an answer for a whole impact.
ROUNDING = 1e-9


class Answer(NamedTuple):
    """What a way gives: the change of psi, the motion, and friction work over unit energy."""

    change: Any
    motion: TangentialMotion
    work: Any


class Way(NamedTuple):
    """One way of running a law: by an integrator, or as whole impacts, under a normal law."""

    law: TangentialLaw
    normal: NormalLaw
    integrator: Integrator | None

    def __str__(self) -> str:
        """Return what the law is run by."""
        return f"by {type(self.integrator).__name__}" if self.integrator else "as whole impacts"

    @property
    def exact(self) -> bool:
        """Whether nothing is added by steps."""
        return self.integrator is None or bool(self.integrator.accuracy)

    def run(self, given: Scene, recorder: Observer | None = None) -> Answer:
        """Return what it gives for the impacts of a scene.

        An integrator is called itself, as a simulation would take short cuts; whole impacts are
        those of a simulation.
        """
        motion: TangentialMotion
        limits.begin(f"an impact, {_which(given)} ({self})")
        if self.integrator is None:
            motion = Simulation(normal=self.normal, tangential=self.law).run(given).motion
        else:
            normal = normal_motion(self.normal, given)
            _followed(self, normal, given)
            motion = self.integrator.integrate(normal, self.law, given, recorder)
        if not np.all(np.asarray(motion.status) == Status.SUCCESS):
            hold(False, f"{_which(given)}: {_detail(motion)} ({self})")
        unit = given.pair.tangential_mass / np.square(given.psi_scale)
        change = given.psi(motion.slip_velocity_change)
        return Answer(change, motion, motion.friction_work / unit)


def _followed(way: Way, normal: NormalMotion, given: Scene) -> None:
    """Hold that the law asks for no more steps than ``MOST_STEPS``."""
    assert way.integrator is not None
    if not isinstance(way.law, SteppedTangentialLaw):
        return
    asked = float(np.max(way.integrator.resolution_for(normal, way.law, given)))
    if asked > MOST_STEPS:
        stiffness = float(np.max(way.law.stiffness(given, normal)))
        hold(
            False,
            f"{_which(given)}: the stiffness that it states, {stiffness:.3g} N/m, asks for "
            f"{asked:.3g} steps; {MOST_STEPS} are the limit of a check.",
        )


def _which(given: Scene) -> str:
    """Return which impact a scene is."""
    if given.shape:
        return f"A batch of shape {given.shape}"
    return f"psi1 = {float(given.psi1):.6g}, chi = {float(given.chi):.4g}"


def _detail(motion: TangentialMotion) -> str:
    """Return status and detail of the first impact that failed."""
    statuses = np.ravel(np.asarray(motion.status, dtype=object))
    first = int(np.argmax(statuses != Status.SUCCESS))
    detail = np.ravel(np.asarray(motion.detail, dtype=object))
    return f"{statuses[first].name} {detail[min(first, detail.size - 1)]}"


def ways(law: TangentialLaw, normal: NormalLaw | None = None) -> list[Way]:
    """Return the ways in which the law can be run: by steps, by events, as whole impacts.

    Raises
    ------
    NotApplicableError
        If there is none under this normal law, Hertz's by default.
    """
    normal_law = REGISTRY.create("normal.hertz") if normal is None else normal
    found = []
    if isinstance(law, SteppedTangentialLaw):
        found.append(Way(law, normal_law, REGISTRY.create("integrator.symplectic", steps=STEPS)))
    if isinstance(law, PhasedTangentialLaw):
        events: Integrator = REGISTRY.create("integrator.events")
        if isinstance(normal_law, events.normal_contract):
            found.append(Way(law, normal_law, events))
    if isinstance(law, WholeImpactTangentialLaw):
        found.append(Way(law, normal_law, None))
    if not law.needs <= normal_law.offers:
        found = []
    apply_if(found, f"There is no way to run it under {type(normal_law).__name__}.")
    return found


def meet(
    way: Way, psi1: Any, chi: Any, *, units: Units | None = None, recorder: Observer | None = None
) -> Answer:
    """Return what a way gives for an impact of given psi1 and chi.

    Parameters
    ----------
    way : Way
    psi1, chi : float or array
    units : Units, optional
        In which the scene is given, for laws in the same.
    recorder : callable, optional
        An observer.
    """
    return way.run(scene(psi1, chi, units=units), recorder)


def course(way: Way, psi1: float, chi: float) -> tuple[History, TangentialMotion]:
    """Return the history of an impact, and the motion."""
    if way.integrator is None:
        simulation = Simulation(normal=way.normal, tangential=way.law)
        result = simulation.run(scene(psi1, chi), history=True)
        assert result.history is not None
        return result.history, result.motion
    recorder = Recorder((), with_fields=False)
    motion = meet(way, psi1, chi, recorder=recorder).motion
    return recorder.history(), motion


def allowed(way: Way) -> float:
    """Return the error allowed in psi: the law's, and the integrator's."""
    if way.integrator is None:
        return ROUNDING
    return slack(way.law, 0.0) + (way.integrator.accuracy or INTEGRATION)
