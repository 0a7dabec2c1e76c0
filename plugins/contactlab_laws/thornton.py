"""Spheres that are elastic until they yield, then perfectly plastic."""

from __future__ import annotations

import math
from typing import ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import NormalContact, NormalLaw
from contactlab.impact.hertz import hertz_stiffness
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import POSITIVE, quantity
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Real
from contactlab_laws.calibrated import one_of_two

#: v_y in m/s if none is given, that of a ball of hard steel.
TAKEN_VELOCITY = Taken(0.1)


class State(NamedTuple):
    """Hertz's k in N/m^1.5, the pair's R in m, approach at yield and deepest so far, in m."""

    stiffness: Real
    radius: Real
    yielding: Real
    deepest: Real


@attrs.frozen(kw_only=True)
class Thornton(NormalLaw):
    """Hertz contact whose pressure is cut at p_y; unloading is Hertz's with a flatter sphere.

    P is in N, positive in compression, with k = (4/3) E* sqrt(R):
    P = k z^1.5 up to z_y, then P = k z_y^1.5 + pi p_y R (z - z_y), p_y = (2 E*/pi) sqrt(z_y/R).
    Unloading from z_max is that of a Hertz contact of radius R_p, which carries P(z_max) over the
    same area, b² = R z_max = R_p (z_max - z_p).

    Parameters
    ----------
    yield_velocity : float, optional
        v_y in m/s, the speed of the slowest impact that yields; 0.1 m/s if neither v_y nor the
        pressure is given. Faster impacts have e = sqrt(6 sqrt(3)/5) sqrt(1 - r²/6)
        (r/(r + 2 sqrt(6/5 - r²/5)))^¼, r = v_y/v1.
    yield_pressure : float, optional
        p_y in Pa, the contact pressure at which the material yields, 1.6 times the yield stress
        at first.

    References
    ----------
    Thornton, J. Appl. Mech. 64 (1997) 383-386, doi:10.1115/1.2787319.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "plastic"})

    yield_velocity: float | None = quantity("m/s", rule=POSITIVE, default=None)
    yield_pressure: float | None = quantity("Pa", rule=POSITIVE, default=None)

    def __attrs_post_init__(self) -> None:
        one_of_two(self, "yield_velocity", "yield_pressure", default=TAKEN_VELOCITY)

    def start(self, scene: Scene) -> State:
        """Return the state of a pair that was never pressed."""
        pair, stiffness = scene.pair, hertz_stiffness(scene)
        if self.yield_velocity is not None:
            twice_energy = pair.normal_mass * self.yield_velocity * self.yield_velocity
            yielding = (1.25 * twice_energy / stiffness) ** 0.4
        else:
            assert self.yield_pressure is not None
            strain = math.pi * self.yield_pressure / (2.0 * pair.effective_modulus)
            yielding = pair.radius * strain * strain
        return State(stiffness, pair.radius, yielding, 0.0)

    def respond(self, state: State, approach: Real, rate: Real) -> tuple[NormalContact, State]:
        """Return force and radius, and the state with the deepest approach."""
        stiffness, radius, yielding, deepest_before = state
        deepest: Real = np.maximum(deepest_before, approach)
        # While elastic, the greatest force is Hertz's and ``flatter`` is 1.
        plastic = np.maximum(deepest, yielding)
        greatest = yielding**1.5 + 1.5 * yielding**0.5 * (plastic - yielding)
        flatter = plastic**1.5 / greatest  # R_p/R, the forces over k
        compression: Real = deepest / flatter - (deepest - approach)  # z - z_p
        inside = compression * np.logical_not(compression <= 0.0)
        contact = NormalContact(
            force=stiffness * flatter**0.5 * inside**1.5,
            radius=(radius * flatter * inside) ** 0.5,
            overlap=compression,
        )
        return contact, state._replace(deepest=deepest)
