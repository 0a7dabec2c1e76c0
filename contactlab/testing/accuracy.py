"""Checks of an integrator's accuracy: order, resolution."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from contactlab.contracts import ClosedFormNormalLaw, Integrator
from contactlab.simulation import Simulation
from contactlab.testing.bench import scene
from contactlab.testing.check import apply_if, check, hold
from contactlab.testing.integrators import CHI, fitting, run
from contactlab.testing.laws import PressedSpring, SlidingForEver

#: Numbers of steps over which the order is regressed.
LADDER = (40, 80, 160, 320)
ORDER_ROOM = 0.3


@check(Integrator)
def order(integrator: Any) -> None:
    """The error falls with the steps as the declared order says, for a smooth law (4)."""
    apply_if(integrator.order and integrator.resolution, "It declares no order.")
    for way in fitting(integrator, (PressedSpring(),), "normal.hertz"):
        exact = _exact(way, 2.0)
        errors = []
        for steps in LADDER:
            finer = attrs.evolve(integrator, **{integrator.resolution: steps})
            errors.append(abs(run(_with(way, finer), 2.0).slip_velocity_change / exact - 1.0))
        found = -float(np.polyfit(np.log(LADDER), np.log(errors), 1)[0])
        hold(
            found >= integrator.order - ORDER_ROOM,
            f"Order {integrator.order} is declared, and {found:.2f} is found.",
        )


@check(Integrator)
def finer_is_better(integrator: Any) -> None:
    """The resolution makes answers finer, and the accuracy stated is kept (Law, 4)."""
    for way in fitting(integrator, (PressedSpring(), SlidingForEver()), "normal.hertz"):
        exact = _exact(way, 7.0)
        unit = abs(scene(7.0, CHI).slip_velocity)
        off = abs(run(way, 7.0).slip_velocity_change - exact) / unit
        hold(off <= (integrator.accuracy or 0.05), f"psi2 is {off:.1e} off the exact solution.")
        if integrator.resolution is None or integrator.accuracy is not None:
            continue
        value = getattr(integrator, integrator.resolution)
        better = 4 * value if isinstance(value, int) else value / 16.0
        finer = attrs.evolve(integrator, **{integrator.resolution: better})
        left = abs(run(_with(way, finer), 7.0).slip_velocity_change - exact) / unit
        hold(
            left <= max(0.6 * off, 1e-12),
            f"Made finer, the error goes from {off:.1e} to {left:.1e}.",
        )


def _exact(way: Simulation, psi1: float) -> Any:
    """Return the exact change of slip velocity."""
    given: Any = scene(psi1, CHI)
    if not isinstance(way.tangential, PressedSpring):
        return -4.0 * CHI / given.psi_scale  # eq. (45)
    assert isinstance(way.normal, ClosedFormNormalLaw)
    motion = way.normal.motion(given.pair, given.normal_speed)
    return given.slip_velocity * (PressedSpring.rebound(motion) - 1.0)


def _with(way: Simulation, integrator: Integrator) -> Simulation:
    return Simulation(normal=way.normal, tangential=way.tangential, integrator=integrator)
