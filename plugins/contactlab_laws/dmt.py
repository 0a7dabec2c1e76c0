"""Hertz contact with a pull from around it."""

from __future__ import annotations

import math
from typing import Any, ClassVar, NamedTuple

import attrs

from contactlab.contracts import NormalContact, NormalLaw, NormalMotion
from contactlab.contracts.contact import TOUCH
from contactlab.impact.cautions import tabor_caution
from contactlab.impact.hertz import hertz_stiffness
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import NON_NEGATIVE, quantity
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Real

#: Tabor's parameter up to which the theory holds.
STIFF = 0.1


class Parts(NamedTuple):
    """Stiffness k in N/m^1.5, pull in N, and the pair's radius in m."""

    stiffness: Real
    pull: Real
    radius: Real


@attrs.frozen(kw_only=True)
class DerjaguinMullerToporov(NormalLaw):
    """Small, stiff spheres that attract each other around the contact: Hertz's force less a pull.

    P = k z^1.5 - 2 pi Gamma R in contact, k = (4/3) E* sqrt(R), in N, positive in compression.
    Contact begins and ends at z = 0: nothing is lost, e = 1. The contact is Hertz's. The
    friction load is Hertz's force, P + 2 pi Gamma R, which presses the surfaces together.

    Parameters
    ----------
    work_of_adhesion : float
        Gamma in J/m², the energy that it takes to part the surfaces; twice the surface energy
        of like bodies.

    References
    ----------
    Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975) 314-326,
    doi:10.1016/0021-9797(75)90018-1. Friction of load and adhesion together: Derjaguin, Z. Phys.
    88 (1934) 661-675, doi:10.1007/BF01333114.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "hertzian_pressure"})

    work_of_adhesion: float = quantity("J/m^2", rule=NON_NEGATIVE, default=Taken(0.05))

    def start(self, scene: Scene) -> Parts:
        """Return stiffness and pull of the pair; the law has no memory."""
        radius = scene.pair.radius
        pull = 2.0 * math.pi * self.work_of_adhesion * radius
        return Parts(hertz_stiffness(scene), pull, radius)

    def respond(self, state: Parts, approach: Real, rate: Real) -> tuple[NormalContact, Parts]:
        """Return force, Hertz's radius (2) and Hertz's force as friction load."""
        touching: Any = approach >= 0.0
        inside: Real = approach * touching  # NaN stays NaN
        load = state.stiffness * inside**1.5
        contact = NormalContact(
            force=load - state.pull * touching,
            radius=(state.radius * inside) ** 0.5,
            overlap=approach + TOUCH * touching,
            friction_load=load,
        )
        return contact, state

    def dissipation(self, motion: NormalMotion) -> Real:
        """Return 0: the force is elastic."""
        return 0.0 * motion.scene.normal_speed

    def cautions(self, scene: Scene, motion: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of every law, and one if the contact is too soft for this theory."""
        soft = tabor_caution(scene, self.work_of_adhesion, most=STIFF, other="normal.jkr")
        return (*super().cautions(scene, motion), *soft)
