"""Checks of an integrator's accuracy: order, resolution, impulse, energy books."""

from __future__ import annotations

import attrs
import numpy as np

from contactlab.contracts import ClosedFormNormalLaw, Integrator, accuracy_of, resolution_of
from contactlab.numeric.arrays import magnitude
from contactlab.numeric.types import Real
from contactlab.runs.simulation import Simulation
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.check import apply_if, check, hold, within
from contactlab.testing.integrators import CHI, march_alone, march_impact
from contactlab.testing.laws import DampedHertz, PressedSpring, Slider, SlidingForEver, Yielding
from contactlab.testing.load_paths import scene
from contactlab.testing.ways import at_resolution, fitting

#: Numbers of steps over which the order is regressed.
LADDER = (40, 80, 160, 320)
#: By so much the observed order may lie below the declared one.
ORDER_ROOM = 0.3
#: Bound of the relative error of the sliding impulse: for integrators of first and of higher order.
FIRST_ORDER, BETTER = 1e-3, 1e-6
#: Order of the error in the step.
ORDER = 2
#: Bound of the imbalance of the energy books with even steps, over the energy of psi = 1 or more.
BOOKS = 0.03


@check(Integrator)
def order(integrator: Integrator) -> None:
    """The error of a smooth law falls with the steps at the declared order (Integrator, 4)."""
    steps = resolution_of(integrator)
    apply_if(isinstance(steps, int), "The integrator has no count of steps.")
    for simulation in fitting(integrator, (PressedSpring(),), "normal.hertz"):
        exact = _exact(simulation, 2.0)
        errors = []
        for steps in LADDER:
            finer = at_resolution(integrator, steps)
            change = march_impact(
                attrs.evolve(simulation, integrator=finer), 2.0
            ).slip_velocity_change
            errors.append(float(magnitude(change / exact - 1.0)))
        observed = -float(np.polyfit(np.log(LADDER), np.log(errors), 1)[0])
        hold(
            observed >= ORDER - ORDER_ROOM,
            f"Order {ORDER} is promised by a count of steps, and {observed:.2f} is found.",
        )


@check(Integrator, claim="controls_error")
def controls_error(integrator: Integrator) -> None:
    """The error of psi2 is at most the tolerance times max(1, abs(psi1))."""
    bound = accuracy_of(integrator) or 0.0
    apply_if(bound, "The integrator controls no error.")
    for simulation in fitting(integrator, (PressedSpring(), SlidingForEver()), "normal.hertz"):
        error = _error(simulation)
        within(error, bound, f"psi2 is {error:.1e} off the exact solution.")


@check(Integrator)
def finer_is_better(integrator: Integrator) -> None:
    """A finer resolution reduces the error (contract of Law, 5)."""
    for simulation in fitting(integrator, (PressedSpring(), SlidingForEver()), "normal.hertz"):
        error = _error(simulation)
        within(error, 0.05, f"psi2 is {error:.1e} off the exact solution.")
        if integrator.resolution is None or accuracy_of(integrator) is not None:
            continue
        value = resolution_of(integrator)
        better = 4 * value if isinstance(value, int) else value / 16.0
        finer = at_resolution(integrator, better)
        finer_error = _error(attrs.evolve(simulation, integrator=finer))
        within(
            finer_error,
            max(0.6 * error, 1e-12),
            f"Made finer, the error goes from {error:.1e} to {finer_error:.1e}.",
        )


@check(Integrator)
def sliding_impulse_by(integrator: Integrator) -> None:
    """Slip throughout takes mu (1 + e) v1 M_n/M_t from v_x under any normal law.

    The law's force is mu times the friction load of the step. An integrator that passes the mean
    load therefore has the impulse to rounding.
    """
    tried = 0
    room = FIRST_ORDER if "order" in integrator.expected_failures else BETTER
    for normal_law in ("normal.hertz", DampedHertz()):
        for simulation in fitting(integrator, (Slider(), SlidingForEver()), normal_law):
            for psi1 in (-40.0, 12.0):
                impact = scene(psi1, CHI)
                normal = normal_motion(simulation.normal, impact)
                bounce = 1.0 - float(normal.final_rate) / float(np.asarray(impact.normal_speed))
                exact = -np.sign(psi1) * 2.0 * CHI * bounce
                tried += 1
                error = abs(
                    impact.psi(march_impact(simulation, psi1).slip_velocity_change) / exact - 1.0
                )
                within(
                    error,
                    room,
                    f"The impulse of sliding is {error:.2g} off mu (1 + e) v1 M_n under "
                    f"{type(simulation.normal).__name__}.",
                )
    apply_if(tried, "The integrator runs neither of the sliding laws of the kit.")


@check(Integrator)
def books_by(integrator: Integrator) -> None:
    """The energy lost is the sum of the law's friction work, and finer steps reduce the difference.

    If ``resolution`` is a number of steps, eight times as many at least halve the imbalance.
    """
    simulations = list(fitting(integrator, (Yielding(), SlidingForEver()), "normal.hertz"))
    apply_if(simulations, "The integrator runs neither of the laws of the kit whose books close.")
    for simulation in simulations:
        for psi1 in (0.5, 1.2, 2.0, 8.0):
            imbalance = _imbalance(simulation, psi1)
            within(
                imbalance, BOOKS, f"psi1 = {psi1}: {imbalance:.1%} of the energy is unaccounted."
            )
        steps = resolution_of(integrator)
        if isinstance(steps, int):
            worst = max(_imbalance(simulation, psi1) for psi1 in (0.5, 1.2, 2.0))
            finer = attrs.evolve(simulation, integrator=at_resolution(integrator, 8 * steps))
            finer_worst = max(_imbalance(finer, psi1) for psi1 in (0.5, 1.2, 2.0))
            within(
                finer_worst,
                max(0.5 * worst, 1e-9),
                f"With 8 times the steps {finer_worst:.2g} of the energy is unaccounted, not "
                f"less than half the {worst:.2g} before.",
            )


def _imbalance(simulation: Simulation, psi1: float) -> float:
    """Return the imbalance of the energy books, over the energy of psi1 or of psi = 1."""
    impact = scene(psi1, CHI)
    motion = march_alone(simulation, impact)
    change, unit = impact.psi(motion.slip_velocity_change), impact.pair.tangential_mass
    work = motion.friction_work * impact.psi_scale**2 / unit
    return float(abs(change * (psi1 + 0.5 * change) + work) / (0.5 * max(psi1, 1.0) ** 2))


def _error(simulation: Simulation) -> float:
    """Return the error of psi2 over psi1 where psi1 is 7."""
    off = march_impact(simulation, 7.0).slip_velocity_change - _exact(simulation, 7.0)
    return abs(float(off)) / abs(float(scene(7.0, CHI).slip_velocity))


def _exact(simulation: Simulation, psi1: float) -> Real:
    """Return the exact change of slip velocity, in m/s."""
    impact = scene(psi1, CHI)
    if not isinstance(simulation.tangential, PressedSpring):
        return -4.0 * CHI / impact.psi_scale  # eq. (45)
    assert isinstance(simulation.normal, ClosedFormNormalLaw)
    motion = simulation.normal.motion(impact)
    return impact.slip_velocity * (PressedSpring.rebound(motion) - 1.0)
