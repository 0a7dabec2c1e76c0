"""Laws that claim to be rigid, or without friction, and are not quite."""

from __future__ import annotations

from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import WholeImpact, WholeImpactTangentialLaw, no_force, sliding


@attrs.frozen(kw_only=True)
class RigidButCreeps(WholeImpactTangentialLaw):
    """Goes on slipping with a hundredth of its speed where it should roll."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"rigid"})

    def whole_impacts(self, scene, normal):
        mass, slip = scene.pair.tangential_mass, scene.slip_velocity
        most = scene.friction_coefficient * normal.total_load_impulse / mass
        lost = np.minimum(most, 0.99 * np.abs(slip))
        answer = WholeImpact(
            where=True,
            slip_velocity_change=-np.sign(slip) * lost,
            friction_work=mass * lost * (np.abs(slip) - 0.5 * lost),
            reason="a test",
        )
        return (*super().whole_impacts(scene, normal), answer)


@attrs.frozen(kw_only=True)
class FrictionlessButRolls(WholeImpactTangentialLaw):
    """Has friction where the slip is fast."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"no_friction"})

    def whole_impacts(self, scene, normal):
        fast = abs(scene.psi1) > 1.0
        return (
            sliding(scene, normal, where=fast, reason="a test", stops=True),
            no_force(scene, where=True, reason="a test"),
        )


#: Each with the check meant for it, and words of what the check says of it.
BROKEN = [
    (RigidButCreeps, "rigid_body", "psi1 = 0.3, chi = 0.3: psi2 is 0.003 off"),
    (FrictionlessButRolls, "no_friction", "psi1 = 1.2, chi = 0.3: psi2 is 1.2 off"),
]
