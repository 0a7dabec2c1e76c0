"""Checks of an integrator's accuracy: order, resolution, impulse, energy books."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.simulation import Simulation
from contactlab.contracts import ClosedFormNormalLaw, Integrator
from contactlab.testing.bench import scene
from contactlab.testing.check import apply_if, check, hold
from contactlab.testing.integrators import CHI, fitting, marched, marched_impact
from contactlab.testing.laws import DampedHertz, PressedSpring, Slider, SlidingForEver, Yielding

#: Numbers of steps over which the order is regressed.
LADDER = (40, 80, 160, 320)
ORDER_ROOM = 0.3
#: What the impulse of sliding may be off: of an integrator of first order, and of any better.
FIRST_ORDER, BETTER = 1e-3, 1e-6
#: What even steps may leave out of the books, over the energy of psi = 1 or more.
BOOKS = 0.03


@check(Integrator)
def order(integrator: Any) -> None:
    """The error falls with the steps as the declared order says, for a smooth law (4)."""
    apply_if(integrator.order and integrator.resolution, "It declares no order.")
    for simulation in fitting(integrator, (PressedSpring(),), "normal.hertz"):
        exact = _exact(simulation, 2.0)
        errors = []
        for steps in LADDER:
            finer = attrs.evolve(integrator, **{integrator.resolution: steps})
            errors.append(
                abs(
                    marched_impact(_with(simulation, finer), 2.0).slip_velocity_change / exact - 1.0
                )
            )
        found = -float(np.polyfit(np.log(LADDER), np.log(errors), 1)[0])
        hold(
            found >= integrator.order - ORDER_ROOM,
            f"Order {integrator.order} is declared, and {found:.2f} is found.",
        )


@check(Integrator)
def finer_is_better(integrator: Any) -> None:
    """The resolution makes answers finer, and the accuracy stated is kept (Law, 4)."""
    for simulation in fitting(integrator, (PressedSpring(), SlidingForEver()), "normal.hertz"):
        exact = _exact(simulation, 7.0)
        unit = abs(scene(7.0, CHI).slip_velocity)
        off = abs(marched_impact(simulation, 7.0).slip_velocity_change - exact) / unit
        hold(
            off <= (integrator.accuracy or 0.05),
            f"psi2 is {off:.1e} off the exact solution. Bound: {integrator.accuracy or 0.05:.2g}.",
        )
        if integrator.resolution is None or integrator.accuracy is not None:
            continue
        value = getattr(integrator, integrator.resolution)
        better = 4 * value if isinstance(value, int) else value / 16.0
        finer = attrs.evolve(integrator, **{integrator.resolution: better})
        left = (
            abs(marched_impact(_with(simulation, finer), 7.0).slip_velocity_change - exact) / unit
        )
        hold(
            left <= max(0.6 * off, 1e-12),
            f"Made finer, the error goes from {off:.1e} to {left:.1e}."
            f" Bound: {max(0.6 * off, 1e-12):.2g}.",
        )


@check(Integrator)
def sliding_impulse_by(integrator: Any) -> None:
    """Slip throughout takes mu (1 + e) v1 M_n/M_t from v_x, whatever the normal law.

    The law's force is mu times the friction load of the step, so that an integrator which hands
    over the mean load has the impulse to rounding.
    """
    tried = 0
    room = FIRST_ORDER if integrator.order == 1 else BETTER
    for normal_law in ("normal.hertz", DampedHertz()):
        for simulation in fitting(integrator, (Slider(), SlidingForEver()), normal_law):
            for psi1 in (-40.0, 12.0):
                given = scene(psi1, CHI)
                normal = normal_motion(simulation.normal, given)
                bounce = 1.0 - float(normal.final_rate) / float(np.asarray(given.normal_speed))
                exact = -np.sign(psi1) * 2.0 * CHI * bounce
                tried += 1
                off = abs(
                    given.psi(marched_impact(simulation, psi1).slip_velocity_change) / exact - 1.0
                )
                hold(
                    off <= room,
                    f"The impulse of sliding is {off:.2g} off mu (1 + e) v1 M_n under "
                    f"{type(simulation.normal).__name__}."
                    f" Bound: {room:.2g}.",
                )
    apply_if(tried, "It runs neither of the sliding laws of the kit.")


@check(Integrator)
def books_by(integrator: Any) -> None:
    """The energy lost is the friction work that the law adds up, whatever the stages of a step.

    Where steps can be made finer the imbalance falls.
    """
    simulations = list(fitting(integrator, (Yielding(), SlidingForEver()), "normal.hertz"))
    apply_if(simulations, "It runs neither of the laws of the kit whose books close.")
    for simulation in simulations:
        for psi1 in (0.5, 1.2, 2.0, 8.0):
            off = _imbalance(simulation, psi1)
            hold(
                off <= BOOKS,
                f"psi1 = {psi1}: {off:.1%} of the energy is in no book. Bound: {BOOKS:.2g}.",
            )
        if isinstance(getattr(integrator, integrator.resolution or "", None), int):
            worst = max(_imbalance(simulation, psi1) for psi1 in (0.5, 1.2, 2.0))
            many = {integrator.resolution: 8 * getattr(integrator, integrator.resolution)}
            finer = _with(simulation, attrs.evolve(integrator, **many))
            left = max(_imbalance(finer, psi1) for psi1 in (0.5, 1.2, 2.0))
            hold(
                left <= max(0.5 * worst, 1e-9),
                f"With 8 times the steps {left:.2g} of the energy is in no book, not less "
                f"than half the {worst:.2g} before."
                f" Bound: {max(0.5 * worst, 1e-9):.2g}.",
            )


def _imbalance(simulation: Simulation, psi1: float) -> float:
    """Return what is in no book, over the energy of psi1, or of 1."""
    given: Any = scene(psi1, CHI)
    motion = marched(simulation, given)
    change, unit = given.psi(motion.slip_velocity_change), given.pair.tangential_mass
    work = motion.friction_work * given.psi_scale**2 / unit
    return float(abs(change * (psi1 + 0.5 * change) + work) / (0.5 * max(psi1, 1.0) ** 2))


def _exact(simulation: Simulation, psi1: float) -> Any:
    """Return the exact change of slip velocity."""
    given: Any = scene(psi1, CHI)
    if not isinstance(simulation.tangential, PressedSpring):
        return -4.0 * CHI / given.psi_scale  # eq. (45)
    assert isinstance(simulation.normal, ClosedFormNormalLaw)
    motion = simulation.normal.motion(given)
    return given.slip_velocity * (PressedSpring.rebound(motion) - 1.0)


def _with(simulation: Simulation, integrator: Integrator) -> Simulation:
    return Simulation(
        normal=simulation.normal, tangential=simulation.tangential, integrator=integrator
    )
