"""Checks of declared errors: psi2_error of laws, accuracy of motions, resolution_for."""

from __future__ import annotations

import itertools
import math
from typing import Any

import attrs
import numpy as np

from contactlab.compose.answers import answers
from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.simulation import Simulation
from contactlab.contracts import ClosedFormNormalLaw, Integrator, TangentialLaw
from contactlab.contracts.error_model import psi_magnitude
from contactlab.impact.scene import Scene
from contactlab.testing.bench import scene
from contactlab.testing.check import apply_if, check, hold
from contactlab.testing.impacts import CHI
from contactlab.testing.integrators import CHI as SOLID
from contactlab.testing.integrators import marched_impact, sound
from contactlab.testing.ways import Way, ways

#: Impacts that stick, slip in part, and slip nearly throughout.
ANGLES = (0.3, 0.9, 1.2, 2.0, 3.5)
#: A declared error is far below the error found if it is less than a third of it.
FAR = 3.0
#: Errors of psi2 over max(1, psi1) that are rounding, whatever is declared.
ROUNDING = 1e-11
#: How much finer a law is made to find its error: a count grows, a tolerance shrinks.
FINER, TIGHTER = 4, 1e3
#: Nodes of the quadrature of a motion in closed form, and what it may be off.
NODES, QUADRATURE = 200, 1e-12


@check(TangentialLaw)
def declared_error(law: Any) -> None:
    """A declared psi2_error is not far below the error that exact or finer answers show.

    NaN is no declaration. A law that claims partial slip is compared with the exact solution;
    any other with itself at four times its resolution and that of the integrator.
    """
    tried = 0
    for way in ways(law):
        for chi, psi1 in itertools.product(CHI, ANGLES):
            given = scene(psi1, chi)
            declared = _declared(way, given)
            if math.isnan(declared):
                continue
            better, by = _better(way, given)
            if better is None:
                continue
            tried += 1
            found = abs(float(np.asarray(way.run(given).change)) - better)
            hold(
                found <= FAR * declared + ROUNDING * max(1.0, psi1),
                f"psi1 = {psi1}, chi = {chi:.3g}: psi2_error = {declared:.2g} is declared, and "
                f"psi2 is {found:.2g} off {by} ({way}).",
            )
    apply_if(tried, "It declares no psi2_error, or nothing is finer to compare it with.")


def _declared(way: Way, given: Scene) -> float:
    """Return the declared error of psi2; NaN if there is none."""
    normal = normal_motion(way.normal, given)
    if way.integrator is None:
        known = [answer for _, answer in answers(given, normal, way.law, history=False)]
        return float(np.asarray(known[0].psi2_error)) if known else math.nan
    steps = way.integrator.resolution_for(normal, way.law, given)
    if way.integrator.accuracy is None:
        return float(np.asarray(way.law.psi2_error(given, normal, steps)))
    own = float(np.asarray(way.law.psi2_error(given, normal, math.inf)))
    return own + way.integrator.accuracy * float(np.asarray(psi_magnitude(given)))


def _better(way: Way, given: Scene) -> tuple[float | None, str]:
    """Return a change of psi that is closer to the truth, and by what; None if nothing is."""
    if "partial_slip" in way.law.offers:
        motion = Simulation(normal=way.normal).run(given).motion
        return float(given.psi(motion.slip_velocity_change)), "the exact solution"
    law, integrator = _finer(way.law), way.integrator
    if integrator is not None:
        integrator = _finer(integrator)
    if law == way.law and integrator == way.integrator:
        return None, ""
    change = way._replace(law=law, integrator=integrator).run(given).change
    return float(np.asarray(change)), f"the same with {FINER} times the resolution"


def _finer(law: Any) -> Any:
    """Return a law or integrator of finer resolution; the same if it has none."""
    if law.resolution is None:
        return law
    value = getattr(law, law.resolution)
    finer = FINER * value if isinstance(value, int) else value / TIGHTER
    try:
        return attrs.evolve(law, **{law.resolution: finer})
    except ValueError:  # beyond what the law allows
        return law


@check(ClosedFormNormalLaw)
def motion_accuracy(law: Any) -> None:
    """A declared accuracy of the motion is not far below the error of its load impulse.

    NaN is no declaration. The impulse is compared with the integral of the friction load along
    the phase, in which every quantity is analytic.
    """
    given: Any = scene(0.0, 1.0)
    motion = law.motion(given)
    apply_if(not math.isnan(motion.accuracy), "Its motion declares no accuracy.")
    points, weights = np.polynomial.legendre.leggauss(NODES)
    phases = 0.5 * np.pi * (points + 1.0)
    rate = np.asarray(motion.scaled(phases).time_rate) * (
        float(motion.maximum_approach) / float(given.normal_speed)
    )
    load = np.asarray(motion.at(phases).contact.friction_load)
    exact = 0.5 * np.pi * float(np.sum(weights * load * rate))
    for name, impulse in (
        ("total_load_impulse", motion.total_load_impulse),
        ("load_impulse at separation", motion.at(np.asarray(np.pi)).load_impulse),
    ):
        off = abs(float(np.asarray(impulse)) / exact - 1.0)
        hold(
            off <= FAR * motion.accuracy + QUADRATURE,
            f"accuracy = {motion.accuracy:.2g} is declared for the load impulse, and the {name} is "
            f"{off:.2g} off the integral of the friction load.",
        )


@check(Integrator)
def resolution_told(integrator: Any) -> None:
    """``resolution_for`` is what an impact gets: asked for, it changes nothing (Integrator, 8)."""
    apply_if(integrator.resolution, "It has no resolution.")
    for simulation in sound(integrator):
        given = scene(2.0, SOLID)
        normal = normal_motion(simulation.normal, given)
        told = float(np.max(integrator.resolution_for(normal, simulation.tangential, given)))
        value = type(getattr(integrator, integrator.resolution))(told)
        asked = attrs.evolve(integrator, **{integrator.resolution: value})
        one = marched_impact(simulation, 2.0).slip_velocity_change
        other = marched_impact(attrs.evolve(simulation, integrator=asked), 2.0).slip_velocity_change
        off = abs(float(np.asarray(other)) / float(np.asarray(one)) - 1.0)
        hold(
            off <= ROUNDING,
            f"resolution_for says {integrator.resolution} = {told:g}, and with "
            f"{integrator.resolution} = {told:g} an impact ends {off:.2g} off: it gets another "
            f"number by itself ({type(simulation.tangential).__name__})."
            f" Bound: {ROUNDING:.2g}.",
        )
