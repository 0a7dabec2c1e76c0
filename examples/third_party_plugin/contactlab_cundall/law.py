"""A linear spring in series with a slider."""

from __future__ import annotations

from typing import ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    POSITIVE,
    Increment,
    NormalContact,
    NormalMotion,
    Real,
    Scene,
    SteppedTangentialLaw,
    TangentialResponse,
    quantity,
)


class Spring(NamedTuple):
    """The state: stiffness in N/m, friction coefficient, and the force in N."""

    stiffness: Real
    friction_coefficient: Real
    force: Real


@attrs.frozen(kw_only=True)
class CundallStrack(SteppedTangentialLaw):
    """F = k D, cut off at mu P, with one stiffness for the whole impact.

    Parameters
    ----------
    stiffness_ratio : float
        k over 2 G* a, Mindlin's stiffness of the largest contact.

    References
    ----------
    Cundall & Strack, Géotechnique 29 (1979) 47-65, doi:10.1680/geot.1979.29.1.47.
    """

    api_version: ClassVar[int] = 2
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})

    stiffness_ratio: float = quantity("1", rule=POSITIVE, default=0.7)

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return k."""
        return self.stiffness_ratio * scene.pair.tangential_stiffness(normal.maximum_radius)

    def start(self, scene: Scene, normal: NormalMotion) -> Spring:
        """Return the spring unloaded."""
        return Spring(self.stiffness(scene, normal), scene.friction_coefficient, 0.0)

    def advance(
        self,
        state: Spring,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, Spring]:
        """Stretch the spring; what is beyond mu P is slip."""
        trial = state.force + state.stiffness * increment.displacement
        limit = state.friction_coefficient * increment.friction_load
        force = np.minimum(np.maximum(trial, -limit), limit)
        slip = (trial - force) / state.stiffness
        # The mean of both forces: as contact ends a spring loses all that it holds.
        work = np.maximum(0.5 * (state.force + force) * slip, 0.0)
        return TangentialResponse(force, work), state._replace(force=force)
