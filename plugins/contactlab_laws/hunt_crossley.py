"""Hertz's force with damping in proportion to it."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import ClassVar, NamedTuple

import attrs

from contactlab.contracts import NormalContact, NormalLaw, without_tension
from contactlab.contracts.restitution import TAKEN_RESTITUTION, restitution
from contactlab.impact.hertz import hertz_stiffness
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import NON_NEGATIVE, quantity
from contactlab.numeric.types import Real
from contactlab_laws.calibrated import OF_LOSS, one_of_two, root, waives_of_loss


@lru_cache(maxsize=256)
def damping_number(coefficient: float) -> float:
    """Return d = lambda v1 at a coefficient of restitution: d (1 + e) = ln((1 + d)/(1 - e d))."""
    # The work of the force, (v - ln(1 + lambda v)/lambda)/lambda at the rate v, is equal at both
    # ends of contact. d lies between (1 - e)/e and 1/e.
    e = coefficient
    if e == 1.0:
        return 0.0
    return root(
        lambda d: math.log1p(d) - math.log1p(-e * d) - d * (1.0 + e), (1.0 - e) / e, 1.0 / e
    )


class Parts(NamedTuple):
    """Stiffness k in N/m^1.5, damping lambda in s/m, and the pair's radius in m."""

    stiffness: Real
    damping: Real
    radius: Real


@attrs.frozen(kw_only=True)
class HuntCrossley(NormalLaw):
    """Hertz's force times 1 + lambda z': no jump at first touch, no tension in an impact.

    P = k z^1.5 (1 + lambda z'), k = (4/3) E* sqrt(R), in N, positive in compression, z' positive
    while the bodies approach. The pressure is a hemisphere over Hertz's radius, b² = R z.

    Parameters
    ----------
    restitution : float, optional
        e, rebound over approach velocity, the same at any speed; 0.9 if neither e nor lambda is
        given.
    damping : float, optional
        lambda in s/m, a constant of the material: e falls with the speed, about as 1 - (2/3)
        lambda v1.

    References
    ----------
    Hunt & Crossley, J. Appl. Mech. 42 (1975) 440-445, doi:10.1115/1.3423596.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = OF_LOSS | {"radius", "hertzian_pressure", "elliptic"}

    restitution: float | None = restitution(default=None)
    damping: float | None = quantity("s/m", rule=NON_NEGATIVE, default=None)

    def __attrs_post_init__(self) -> None:
        one_of_two(self, "restitution", "damping", default=TAKEN_RESTITUTION)

    def waives(self) -> frozenset[str]:
        """Return the words of a loss that does not hold."""
        loses = self.restitution not in (None, 1.0) or bool(self.damping)
        return waives_of_loss(self.restitution, loses)

    def start(self, scene: Scene) -> Parts:
        """Return stiffness and damping of the pair; the law has no memory."""
        damping: Real = self.damping or 0.0
        if self.restitution is not None:
            damping = damping_number(self.restitution) / scene.normal_speed
        return Parts(hertz_stiffness(scene), damping, scene.pair.radius)

    def respond(self, state: Parts, approach: Real, rate: Real) -> tuple[NormalContact, Parts]:
        """Return force and Hertz's radius (2)."""
        inside: Real = approach * (approach > 0.0)  # type: ignore[assignment]  # float64
        force = state.stiffness * inside**1.5 * (1.0 + state.damping * rate)
        return without_tension(force, (state.radius * inside) ** 0.5, approach), state
