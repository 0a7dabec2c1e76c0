"""Hard spheres: gross slip, or a constant restitution of the slip velocity."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import NormalMotion, WholeImpact, WholeImpactTangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Rule, quantity
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Real

#: Bound of the imbalance of the energy books, over the energy at the start.
ROUNDING = 1e-9
SHARE = Rule(
    lambda value: (value >= -1.0) & (value <= 1.0),
    "must lie in [-1, 1]: -1 without friction, 0 as rigid bodies, 1 with all of it reversed",
)


@attrs.frozen(kw_only=True)
class Walton(WholeImpactTangentialLaw):
    """The lesser of two tangential impulses: mu times the load impulse, (1 + beta_0) M_t v_x.

    The normal law gives the third parameter of hard spheres, the restitution e. The impulse of
    slip, in N s, is mu times that of the friction load: mu (1 + e) M_n v1 where the normal law
    does not pull, and more under adhesion. The law gives no history of an impact.

    Parameters
    ----------
    beta0 : float
        beta_0: minus the slip velocity after over before, where the contact does not slide
        throughout. Measured values lie near 0.4 for glass and acetate (Foerster et al. 1994).

    References
    ----------
    Walton, in Particulate Two-Phase Flow (ed. Roco, 1993), ch. 25; Foerster, Louge, Chang &
    Allia, Phys. Fluids 6 (1994) 1108-1115, doi:10.1063/1.868282.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"elliptic"})
    expected_failures: ClassVar[Mapping[str, str]] = {
        "impact_reference": "the exact solution is that of bodies which deform tangentially",
    }

    beta0: float = quantity("1", rule=SHARE, default=Taken(0.4))

    def books_bound(self, scene: Scene) -> Real:
        """Return the bound of rounding: the friction work follows from the impulse."""
        return ROUNDING

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the lesser of the two impulses."""
        mass, speed = scene.pair.tangential_mass, np.abs(scene.slip_velocity)
        with np.errstate(all="ignore"):
            slipping = scene.friction_coefficient * normal.total_load_impulse / mass
            loss = np.minimum(slipping, (1.0 + self.beta0) * speed)
            # The impulse acts at the mean of the velocities before and after.
            work = mass * loss * (speed - 0.5 * loss)
        answer = WholeImpact(
            where=True,
            slip_velocity_change=-np.sign(scene.slip_velocity) * loss,
            friction_work=work,
            reason="hard spheres: the lesser of gross slip and a constant slip restitution",
            psi2_error=0.0,
        )
        return (*super().whole_impacts(scene, normal), answer)

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the caution that one slip restitution stands for all tangential elasticity."""
        return (
            "model: one slip restitution at every angle, in place of tangential elasticity. psi2 "
            "of solid spheres is off by up to 0.8.",
        )
