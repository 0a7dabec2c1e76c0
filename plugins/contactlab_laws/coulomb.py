"""Rigid-body friction: slip, then rolling with no force."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import (
    CoupledTangentialLaw,
    Ends,
    NormalMotion,
    Observer,
    TangentialMotion,
    WholeImpact,
    WholeImpactTangentialLaw,
    no_force,
    sliding,
)
from contactlab.contracts.status import Status
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import spread, spread_object
from contactlab.numeric.types import Real

#: Bound of the imbalance of the energy books, over the energy at the start.
ROUNDING = 1e-9


@attrs.frozen(kw_only=True)
class Coulomb(WholeImpactTangentialLaw, CoupledTangentialLaw):
    """Coulomb friction between bodies that do not deform tangentially.

    While the contact slips the force is mu times the friction load; once slip has stopped the
    bodies roll and the force is zero. Under any normal law the change of slip
    velocity is the lesser of mu J/M_t, J the load impulse, and the slip velocity itself.

    Between bodies for which friction changes the approach, friction is followed over the normal
    impulse: by Routh's construction in the plane, by Keller's equations in space. The restitution
    is energetic, with the e of the approach without friction.

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, the rigid body theory of §§1 and 4.3; Keller,
    J. Appl. Mech. 53 (1986) 1-4, doi:10.1115/1.3171712; Wang & Mason, J. Appl. Mech. 59 (1992)
    635-642, for Routh's construction.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"rigid", "elliptic", "vectors"})
    expected_failures: ClassVar[Mapping[str, str]] = {
        "impact_reference": "the exact solution is that of bodies which deform tangentially",
    }

    def books_bound(self, scene: Scene) -> Real:
        """Return the bound of rounding: the friction work follows from the force."""
        return ROUNDING

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the motion of every impact: slip until the slip velocity is zero, then rolling."""
        reason = "rigid bodies: slip until it stops, if it does, then rolling"
        return (
            *super().whole_impacts(scene, normal),
            sliding(scene, normal, where=True, reason=reason, stops=True),
        )

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the caution that the elasticity of the surfaces is left out."""
        return ("model: rigid contact. Where a solid sphere sticks, psi2 is off by up to 1.5.",)

    def solve_coupled(
        self,
        scene: Scene,
        normal: NormalMotion,
        accuracy: float | None,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion of rigid bodies, without a course, as rigid impacts take no time."""
        from contactlab_laws.rigid_impact import rigid_impacts

        return rigid_impacts(scene, normal)


@attrs.frozen(kw_only=True)
class Frictionless(WholeImpactTangentialLaw, CoupledTangentialLaw):
    """No tangential force; the reference for the cost of a run.

    Between any two bodies pressure alone drags the surfaces: psi2 = psi1 - 2 eta if e is 1.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"no_friction", "elliptic", "vectors"})
    expected_failures: ClassVar[Mapping[str, str]] = {
        "impact_reference": "the exact solution is that of bodies with friction",
        "sliding_impulse": "there is no friction, however large the slip",
    }

    def books_bound(self, scene: Scene) -> Real:
        """Return the bound of rounding: there is no friction work."""
        return ROUNDING

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return impacts without tangential force."""
        return (no_force(scene, where=True, reason="the law makes no force"),)

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return no caution: without traction there is no coupling."""
        return ()

    def solve_coupled(
        self,
        scene: Scene,
        normal: NormalMotion,
        accuracy: float | None,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the velocities that the impulse of the frictionless approach gives."""
        W = scene.inverse_mass
        assert W is not None
        speed: Real = scene.normal_speed
        rate: Real = normal.final_rate
        impulse = scene.pair.normal_mass * (speed - rate)
        drag = -np.asarray(impulse)[..., None] * W[..., 0, 1:]
        entries = (
            normal.duration, rate, normal.maximum_radius, normal.maximum_approach,
            normal.maximum_force, 0.5 * impulse * (speed + rate),
        )  # fmt: skip
        return TangentialMotion(
            slip_velocity_change=kinetics.tangent(scene, drag),
            friction_work=spread(0.0, scene.shape),
            normal=Ends(*entries),
            status=spread_object(Status.SUCCESS, scene.shape),
        )
