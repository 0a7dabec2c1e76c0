"""Hertz's normal contact, the paper's eqs (2)-(6); ``motion`` has its impact, eqs (7)-(9)."""

from __future__ import annotations

from typing import ClassVar

import attrs

from contactlab.contracts import ClosedFormNormalLaw, NormalContact, NormalMotion
from contactlab.impact.bodies import Pair
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab_laws.hertz.motion import HertzMotion


@attrs.frozen(kw_only=True)
class Hertz(ClosedFormNormalLaw):
    """Elastic, frictionless normal contact of smooth bodies.

    The state is the pair of bodies: the law has no memory.

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5,
    eqs (2)-(6), for a general pair: P = (4/3) E* sqrt(R) u_z^1.5.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset(
        {"radius", "hertzian_pressure", "elastic_hertz", "elliptic"}
    )

    def start(self, scene: Scene) -> Pair:
        """Return the pair; the law has no memory."""
        return scene.pair

    def respond(self, state: Pair, approach: Real, rate: Real) -> tuple[NormalContact, Pair]:
        """Return force (4) and radius (2) at ``approach``; both are 0 out of contact."""
        # A product with the comparison keeps NaN a NaN, for floats and arrays alike.
        compression: Real = approach * (approach > 0.0)  # type: ignore[assignment]  # float64
        radius = (state.radius * compression) ** 0.5
        force = (4.0 / 3.0) * state.effective_modulus * radius * compression
        return NormalContact(force, radius, approach, force), state

    def dissipation(self, motion: NormalMotion) -> Real:
        """Return 0: the force is elastic."""
        return 0.0 * motion.scene.normal_speed

    def motion(self, scene: Scene) -> HertzMotion:
        """Return the motion in closed form."""
        return HertzMotion.of(self, scene)
