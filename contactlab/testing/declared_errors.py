"""Checks of declared errors: psi2_error of laws, accuracy of motions, the resolution taken."""

from __future__ import annotations

import itertools
import math
from typing import TypeVar

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormNormalLaw,
    Integrator,
    Law,
    TangentialLaw,
    accuracy_of,
    claims,
    resolution_of,
)
from contactlab.contracts.integrator import resolution_for
from contactlab.impact.error_model import psi_magnitude
from contactlab.impact.scene import Scene
from contactlab.runs.simulation import Simulation
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.check import NotApplicableError, apply_if, check, hold, within
from contactlab.testing.impacts import CHI
from contactlab.testing.integrators import CHI as SOLID
from contactlab.testing.integrators import march_impact
from contactlab.testing.load_paths import scene
from contactlab.testing.ways import Way, at_resolution, sound, ways, whole_answers

#: Impacts that stick, slip in part, and slip nearly throughout.
ANGLES = (0.3, 0.9, 1.2, 2.0, 3.5)
#: Largest ratio of the observed to the declared error.
FAR = 3.0
#: Errors of psi2 over max(1, psi1) below this are rounding.
ROUNDING = 1e-11
#: Factors of a finer resolution: a number is multiplied by FINER, or by 2 if the law accepts no
#: more; a tolerance is divided by TIGHTER.
FINER, TIGHTER = 4, 1e3
#: Nodes of the quadrature of a motion in closed form, and the bound of the error of the quadrature.
NODES, QUADRATURE = 200, 1e-12


@check(TangentialLaw)
def declared_error(law: TangentialLaw) -> None:
    """The error is at most three times the declared psi2_error.

    NaN declares nothing. A law that claims partial slip is compared with the exact solution, any
    other law with itself at a finer resolution of both law and integrator.
    """
    tried = 0
    for way in ways(law):
        for chi, psi1 in itertools.product(CHI, ANGLES):
            impact = scene(psi1, chi)
            declared = _declare(way, impact)
            if math.isnan(declared):
                continue
            better, source = _better(way, impact)
            if better is None:
                continue
            tried += 1
            error = abs(float(np.asarray(way.run(impact).change)) - better)
            hold(
                error <= FAR * declared + ROUNDING * max(1.0, psi1),
                f"psi1 = {psi1}, chi = {chi:.3g}: psi2_error = {declared:.2g} is declared, and "
                f"psi2 is {error:.2g} off {source} ({way}).",
            )
    apply_if(tried, "The law declares no psi2_error, or nothing is finer to compare it with.")


def _declare(way: Way, impact: Scene) -> float:
    """Return the declared error of psi2; NaN if none is declared."""
    normal = normal_motion(way.normal, impact)
    if way.integrator is None:
        whole = whole_answers(way.law, normal)
        return float(np.asarray(whole[0].psi2_error)) if whole else math.nan
    steps = resolution_for(way.integrator, impact, normal, way.law)
    if (controlled := accuracy_of(way.integrator)) is None:
        return float(np.asarray(way.law.errors(impact, normal, steps).psi2))
    own = float(np.asarray(way.law.errors(impact, normal, math.inf).psi2))
    return own + controlled * float(np.asarray(psi_magnitude(impact)))


def _better(way: Way, impact: Scene) -> tuple[float | None, str]:
    """Return a change of psi that is closer to the truth, and by what; None if nothing is."""
    if "partial_slip" in claims(way.law):
        motion = Simulation(normal=way.normal).run(impact).motion
        return float(impact.psi(motion.slip_velocity_change)), "the exact solution"
    law, integrator = _finer(way.law), way.integrator
    if integrator is not None:
        integrator = _finer(integrator)
    if law == way.law and integrator == way.integrator:
        return None, ""
    change = way._replace(law=law, integrator=integrator).run(impact).change
    return float(np.asarray(change)), "the same with a finer resolution"


SameLaw = TypeVar("SameLaw", bound=Law)


def _finer(law: SameLaw) -> SameLaw:
    """Return a law or integrator of finer resolution; the same if it has none."""
    if law.resolution is None:
        return law
    value = resolution_of(law)
    for factor in (FINER, 2):
        finer = factor * value if isinstance(value, int) else value / TIGHTER
        try:
            return at_resolution(law, finer)
        except ValueError:  # the law does not accept the finer value
            continue
    return law


@check(ClosedFormNormalLaw)
def motion_accuracy(law: ClosedFormNormalLaw) -> None:
    """The error of the load impulse is at most three times the declared accuracy of the motion.

    NaN declares nothing. The impulse is compared with the integral of the friction load over the
    phase, of which every quantity is an analytic function.
    """
    impact = scene(0.0, 1.0)
    motion = law.motion(impact)
    apply_if(not math.isnan(motion.accuracy), "Its motion declares no accuracy.")
    points, weights = np.polynomial.legendre.leggauss(NODES)
    phases = 0.5 * np.pi * (points + 1.0)
    rate = np.asarray(motion.scaled(phases).time_rate) * (
        float(motion.maximum_approach) / float(impact.normal_speed)
    )
    load = np.asarray(motion.at(phases).contact.friction_load)
    exact = 0.5 * np.pi * float(np.sum(weights * load * rate))
    for name, impulse in (
        ("total_load_impulse", motion.total_load_impulse),
        ("load_impulse at separation", motion.at(np.asarray(np.pi)).load_impulse),
    ):
        error = abs(float(np.asarray(impulse)) / exact - 1.0)
        hold(
            error <= FAR * motion.accuracy + QUADRATURE,
            f"accuracy = {motion.accuracy:.2g} is declared for the load impulse, and the {name} is "
            f"{error:.2g} off the integral of the friction load.",
        )


@check(Integrator)
def resolution_told(integrator: Integrator) -> None:
    """An impact run at the resolution that ``errors`` tells, or the option's, ends the same."""
    if not integrator.resolution:
        raise NotApplicableError("The integrator has no resolution.")
    for simulation in sound(integrator):
        impact = scene(2.0, SOLID)
        normal = normal_motion(simulation.normal, impact)
        taken = resolution_for(integrator, impact, normal, simulation.tangential)
        stated = float(np.max(taken))
        value = type(resolution_of(integrator))(stated)
        asked = at_resolution(integrator, value)
        change = march_impact(simulation, 2.0).slip_velocity_change
        as_stated = attrs.evolve(simulation, integrator=asked)
        asked_change = march_impact(as_stated, 2.0).slip_velocity_change
        difference = abs(float(np.asarray(asked_change)) / float(np.asarray(change)) - 1.0)
        within(
            difference,
            ROUNDING,
            f"errors tells {integrator.resolution} = {stated:g}, and with "
            f"{integrator.resolution} = {stated:g} an impact ends {difference:.2g} off: by default "
            f"the integrator uses another value ({type(simulation.tangential).__name__}).",
        )
