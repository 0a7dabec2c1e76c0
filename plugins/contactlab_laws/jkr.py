"""Adhesion within the contact."""

from __future__ import annotations

import math
from typing import ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import NormalContact, NormalLaw, NormalMotion
from contactlab.impact.cautions import tabor_caution
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import POSITIVE, quantity
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Real

#: Tabor's parameter from which the theory holds.
SOFT = 5.0
#: s and s⁴ - s at the least scaled approach of a contact, where the derivative of s⁴ - s is zero.
LAST = 4.0 ** (-1.0 / 3.0)
LEAST = LAST**4 - LAST


class Parts(NamedTuple):
    """Radius of the contact at z = 0 in m, 2 pi Gamma R in N, and the pair's radius in m."""

    size: Real
    pull: Real
    radius: Real


def root_of_size(scaled: Real) -> Real:
    """Return s, the larger solution of s⁴ - s = ``scaled``, where ``scaled`` >= ``LEAST``."""
    # Ferrari: s = ½ (sqrt(2m) + sqrt(2/sqrt(2m) - 2m)), m³ + scaled m = 1/8, with m by Cardano,
    # written so that no digits cancel.
    third = scaled / 3.0
    larger = np.cbrt(0.0625 + np.sqrt(np.maximum(0.00390625 + third * third * third, 0.0)))
    smaller = -third / larger
    m = 0.125 / (larger * larger + third + smaller * smaller)
    base = np.sqrt(2.0 * m)
    return 0.5 * (base + np.sqrt(np.maximum(2.0 / base - 2.0 * m, 0.0)))


@attrs.frozen(kw_only=True)
class JohnsonKendallRoberts(NormalLaw):
    """Soft spheres that stick together over the contact.

    With b1³ = 2 pi Gamma R²/E* and b = b1 s² the contact radius:
    z = (b1²/R)(s⁴ - s), P = 2 pi Gamma R ((4/3) s⁶ - 2 s³), in N, positive in compression.
    Contact is made at z = 0, where P = -(8/9) P_c, P_c = 1.5 pi Gamma R, and breaks at negative z,
    s³ = 1/4, with P = -(5/9) P_c. The energy lost in between is ½ M v_s²
    = 7.0922 (Gamma⁵ R⁴/E*²)^(1/3); bodies slower than v_s do not part. The pressure is a
    hemisphere less that of a flat punch. The friction load is P + 2 P_c. Where the contact breaks
    while it is sheared, the elastic energy of the shear is lost; friction work contains the loss.

    Parameters
    ----------
    work_of_adhesion : float
        Gamma in J/m², the energy that it takes to part the surfaces; twice the surface energy
        of like bodies.

    References
    ----------
    Johnson, Kendall & Roberts, Proc. R. Soc. Lond. A 324 (1971) 301-313,
    doi:10.1098/rspa.1971.0141. Impact: Thornton & Ning, Powder Technol. 99 (1998) 154-162,
    doi:10.1016/S0032-5910(98)00099-0. Friction's load: Thornton, J. Phys. D: Appl. Phys. 24
    (1991) 1942-1946, doi:10.1088/0022-3727/24/11/007.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius"})

    work_of_adhesion: float = quantity("J/m^2", rule=POSITIVE, default=Taken(0.05))

    def start(self, scene: Scene) -> Parts:
        """Return size and pull of the pair; the law has no memory."""
        radius = scene.pair.radius
        pull = 2.0 * math.pi * self.work_of_adhesion * radius
        size = (pull * radius / scene.pair.effective_modulus) ** (1.0 / 3.0)
        return Parts(size, pull, radius)

    def respond(self, state: Parts, approach: Real, rate: Real) -> tuple[NormalContact, Parts]:
        """Return force, radius and the friction load P + 2 P_c; contact lasts into negative z."""
        size, pull, radius = state
        scaled = approach * (radius / (size * size))
        touching = np.logical_not(scaled <= LEAST)
        s = root_of_size(np.maximum(scaled, LEAST))
        cube = s * s * s
        force = pull * (4.0 / 3.0 * cube - 2.0) * cube * touching
        contact = NormalContact(
            force=force,
            radius=size * s * s * touching,
            overlap=(scaled - LEAST) * (size * size / radius),
            friction_load=force + 1.5 * pull * touching,
        )
        return contact, state

    def cautions(self, scene: Scene, motion: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of every law, and one on a contact too stiff."""
        stiff = tabor_caution(scene, self.work_of_adhesion, least=SOFT, other="normal.dmt")
        return (*super().cautions(scene, motion), *stiff)
