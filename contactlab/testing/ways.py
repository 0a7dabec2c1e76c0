"""The ways in which a tangential law can be run; checks try each."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, TypeVar

import numpy as np

from contactlab.contracts import (
    CausalTangentialLaw,
    CoupledIntegrator,
    CoupledTangentialLaw,
    Integrator,
    Law,
    NormalLaw,
    NormalMotion,
    Observer,
    PathTangentialLaw,
    SteppedTangentialLaw,
    TangentialLaw,
    TangentialMotion,
    WholeImpact,
    WholeImpactTangentialLaw,
    accuracy_of,
)
from contactlab.contracts.integrator import resolution_for
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab.outcome.history import History, Recorder
from contactlab.registry import composition
from contactlab.registry.registry import REGISTRY
from contactlab.runs.simulation import Simulation
from contactlab.solve.answers import answers
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing import limits
from contactlab.testing.check import apply_if, hold, hold_success
from contactlab.testing.laws import PressedSpring, Slider, SlidingForEver, Yielding
from contactlab.testing.load_paths import scene, slack
from contactlab.testing.units import Units, with_parameters

#: Steps of an impact; the integrator takes more if the stiffness of the law needs more.
STEPS = 200
#: Largest number of steps of an impact in a check; contactlab's own laws need up to 700.
MOST_STEPS = 20_000
#: Bound of the error of psi by the integration: second order at 200 steps.
INTEGRATION = 2e-3
#: Bound of the error of a whole-impact answer by rounding.
ROUNDING = 1e-9
#: W_nt over sqrt(W_nn W_tt) of impacts that are solved as those of bodies.
COUPLING = 1e-10


class Solved(NamedTuple):
    """Change of psi, motion, and friction work over the unit of energy, of one way."""

    change: Real
    motion: TangentialMotion
    work: Real


class Met(NamedTuple):
    """Change of psi, motion, and friction work over the unit of energy, of one impact."""

    change: float
    motion: TangentialMotion
    work: float


class Way(NamedTuple):
    """One way of running a law: by an integrator, or as whole impacts, under a normal law.

    In a way of ``bodies`` normal and tangential motion are solved together, as where friction
    changes the approach; by ``COUPLING`` it hardly does, so that the answer is the spheres'.
    """

    law: TangentialLaw
    normal: NormalLaw
    integrator: Integrator | None
    bodies: bool = False

    def __str__(self) -> str:
        """Return the way in words."""
        by = f"{type(self.law).__name__} by {type(self.integrator).__name__}"
        by = by if self.integrator else "as whole impacts"
        return f"{by}, with the normal motion" if self.bodies else by

    @property
    def exact(self) -> bool:
        """Whether the way adds no error of steps; a law with a resolution has steps of its own."""
        if self.integrator is None:
            return self.law.resolution is None
        return bool(accuracy_of(self.integrator))

    def run(self, impact: Scene, recorder: Observer | None = None) -> Solved:
        """Return the answer for the impacts of a scene.

        An integrator is called directly, because a simulation would use whole-impact answers.
        """
        motion: TangentialMotion
        limits.begin(f"an impact, {_which(impact)} ({self})")
        if self.bodies:
            motion = _solve_together(self, _couple(impact), recorder)
        elif self.integrator is None:
            motion = Simulation(normal=self.normal, tangential=self.law).run(impact).motion
        else:
            normal = normal_motion(self.normal, impact)
            _bound_steps(self, normal, impact)
            motion = self.integrator.integrate(impact, normal, self.law, recorder)
        hold_success(motion, f"{_which(impact)}: {{}} ({self})")
        unit = impact.pair.tangential_mass / np.square(impact.psi_scale)
        change = impact.psi(motion.slip_velocity_change)
        return Solved(change, motion, motion.friction_work / unit)


def _couple(impact: Scene) -> Scene:
    """Return an impact with an inverse mass that hardly couples; the mirror image of its mirror."""
    pair, shape = impact.pair, impact.shape
    W = np.zeros((*shape, 3, 3))
    W[..., 0, 0] = 1.0 / np.asarray(pair.normal_mass)
    W[..., 1, 1] = W[..., 2, 2] = 1.0 / np.asarray(pair.tangential_mass)
    coupling = COUPLING * np.sign(impact.slip_velocity)
    W[..., 0, 1] = W[..., 1, 0] = coupling * np.sqrt(W[..., 0, 0] * W[..., 1, 1])
    numbers = impact.friction_coefficient, impact.normal_speed, impact.slip_velocity
    return Scene(None, None, *numbers, pair=pair, inverse_mass=W)


def _solve_together(way: Way, impact: Scene, recorder: Observer | None) -> TangentialMotion:
    """Return the motion of an impact in which friction changes the approach."""
    normal = normal_motion(way.normal, impact.central)
    if way.integrator is None or isinstance(way.law, CoupledTangentialLaw):
        assert isinstance(way.law, CoupledTangentialLaw)
        return way.law.solve_coupled(impact, normal, None, recorder)
    assert isinstance(way.integrator, CoupledIntegrator)
    return way.integrator.integrate_coupled(impact, normal, way.law, recorder)


def _bound_steps(way: Way, normal: NormalMotion, impact: Scene) -> None:
    """Hold that the stiffness of the law needs at most ``MOST_STEPS`` steps."""
    assert way.integrator is not None
    if not isinstance(way.law, SteppedTangentialLaw):
        return
    steps = float(np.max(resolution_for(way.integrator, impact, normal, way.law)))
    if steps > MOST_STEPS:
        stiffness = float(np.max(way.law.stiffness(impact, normal)))
        hold(
            False,
            f"{_which(impact)}: the stiffness that it states, {stiffness:.3g} N/m, asks for "
            f"{steps:.3g} steps; {MOST_STEPS} are the limit of a check.",
        )


def _which(impact: Scene) -> str:
    """Return the impact of a scene in words."""
    if impact.shape:
        return f"A batch of shape {impact.shape}"
    return f"psi1 = {float(impact.psi1):.6g}, chi = {float(impact.chi):.4g}"


def fitting(
    integrator: Integrator, tangential: tuple[TangentialLaw, ...], normal: NormalLaw | str
) -> Iterator[Simulation]:
    """Iterate over simulations with the tangential laws that the integrator can run."""
    normal_law = composition.law("normal", normal)
    for law in tangential:
        if composition.misfit(normal_law, law, integrator) is None:
            yield Simulation(normal=normal_law, tangential=law, integrator=integrator)


def sound(integrator: Integrator) -> list[Simulation]:
    """Return at least one simulation with laws of the kit that do not fail."""
    laws = (PressedSpring(), Yielding(), Slider(), SlidingForEver())
    simulations = list(fitting(integrator, laws, "normal.hertz"))
    hold(simulations, "The law fits none of the laws of the kit: see the contracts that it states.")
    return simulations


SameLaw = TypeVar("SameLaw", bound=Law)


def at_resolution(law: SameLaw, value: float) -> SameLaw:
    """Return a law with another value of its resolution; ValueError if the law refuses it."""
    assert law.resolution is not None
    return with_parameters(law, {law.resolution: value})


def ways(law: TangentialLaw | Integrator, normal: NormalLaw | None = None) -> list[Way]:
    """Return the ways in which a law can be run: by steps, by events, as whole impacts.

    An integrator runs the laws of the kit that fit it.

    Raises
    ------
    NotApplicableError
        If there is no way under ``normal``, by default Hertz's law.
    """
    if isinstance(law, Integrator):
        return [Way(each.tangential, each.normal, law) for each in sound(law)]
    normal_law = REGISTRY.create("normal.hertz") if normal is None else normal
    listed = []
    if isinstance(law, SteppedTangentialLaw):
        listed.append(Way(law, normal_law, REGISTRY.create("integrator.symplectic", steps=STEPS)))
    if isinstance(law, PathTangentialLaw):
        events: Integrator = REGISTRY.create("integrator.events")
        if composition.misfit(normal_law, law, events) is None:
            listed.append(Way(law, normal_law, events))
    if isinstance(law, WholeImpactTangentialLaw):
        listed.append(Way(law, normal_law, None))
    if composition.misfit(normal_law, law) is not None:
        listed = []
    apply_if(listed, f"There is no way to run it under {type(normal_law).__name__}.")
    return listed


def whole_answers(law: TangentialLaw, normal: NormalMotion) -> list[WholeImpact]:
    """Return the whole-impact answers of a law that hold."""
    always = isinstance(law, WholeImpactTangentialLaw)
    return [answer for _, answer in answers(normal, law, always=always, history=False)]


def ways_of_bodies(law: TangentialLaw | Integrator) -> list[Way]:
    """Return the ways of ``ways``, and those in which bodies of any shape are run.

    Raises
    ------
    NotApplicableError
        If there is no way.
    """
    listed = ways(law)
    together = [
        Way(
            each.law,
            each.normal,
            None if isinstance(each.law, CoupledTangentialLaw) else each.integrator,
            bodies=True,
        )
        for each in listed
        if isinstance(each.law, CoupledTangentialLaw)
        or (each.integrator is not None and _marches(each))
    ]
    return listed + together[:1]


def _marches(way: Way) -> bool:
    """Return whether the integrator of a way marches the law and the normal motion together."""
    return isinstance(way.integrator, CoupledIntegrator) and isinstance(
        way.law, CausalTangentialLaw
    )


def meet(
    way: Way,
    psi1: float,
    chi: float,
    *,
    units: Units | None = None,
    recorder: Observer | None = None,
) -> Met:
    """Return the answer of one way for an impact, by psi1 and chi.

    Parameters
    ----------
    way : Way
    psi1, chi : float
    units : Units, optional
        System of units of scene and law; SI by default.
    recorder : callable, optional
        Observer of the run.
    """
    change, motion, work = way.run(scene(psi1, chi, units=units), recorder)
    return Met(float(np.asarray(change)), motion, float(np.asarray(work)))


def course(way: Way, psi1: float, chi: float) -> tuple[History, TangentialMotion]:
    """Return history and motion of an impact, marched step by step."""
    if way.integrator is None and not way.bodies:
        simulation = Simulation(normal=way.normal, tangential=way.law)
        result = simulation.run(scene(psi1, chi), history=True)
        assert result.history
        return result.history, result.motion
    recorder = Recorder((), with_fields=False, stepwise=True)
    motion = meet(way, psi1, chi, recorder=recorder).motion
    return recorder.history(), motion


def bound_error(way: Way) -> float:
    """Return the bound of the error of psi, by the law and by the integrator."""
    if way.integrator is None:
        return ROUNDING
    return slack(way.law, 0.0) + (accuracy_of(way.integrator) or INTEGRATION)
