"""Two springs: a softer one in loading, a stiffer one in unloading."""

from __future__ import annotations

from typing import ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import NormalContact, NormalLaw
from contactlab.contracts.restitution import TAKEN_RESTITUTION, restitution
from contactlab.impact.hertz import linear_stiffness
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import POSITIVE, quantity
from contactlab.numeric.types import Real


class State(NamedTuple):
    """Loading stiffness k1 in N/m, the pair's radius in m, and the deepest approach so far in m."""

    stiffness: Real
    radius: Real
    deepest: Real


@attrs.frozen(kw_only=True)
class WaltonBraun(NormalLaw):
    """Plastic loading P = k1 z and elastic unloading P = k2 (z - z_p), with e = sqrt(k1/k2).

    P is in N, positive in compression; the remaining indentation is z_p = (1 - e²) z_max. In
    loading the contact is that of a sphere, b² = R z; in unloading that of its flattened cap,
    b² = (R/e²)(z - z_p). In both b² = R P/k1. The law gives no pressure.

    Parameters
    ----------
    restitution : float
        e, rebound over approach velocity, at most 1; the same at any speed.
    stiffness : float, optional
        k1 in N/m. By default k1 = M (v1/z_max)² for each impact: an elastic spring of this
        stiffness reaches the largest approach of Hertz's contact, z_max.

    References
    ----------
    Walton & Braun, J. Rheol. 30 (1986) 949-980, doi:10.1122/1.549893.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "elliptic", "plastic"})

    restitution: float = restitution(default=TAKEN_RESTITUTION)
    stiffness: float | None = quantity("N/m", rule=POSITIVE, default=None)

    def start(self, scene: Scene) -> State:
        """Return the state of a pair that was never pressed."""
        stiffness = linear_stiffness(scene) if self.stiffness is None else self.stiffness
        return State(stiffness, scene.pair.radius, 0.0)

    def respond(self, state: State, approach: Real, rate: Real) -> tuple[NormalContact, State]:
        """Return force and radius, and the state with the deepest approach."""
        deepest = np.maximum(state.deepest, approach)
        share = self.restitution * self.restitution
        # (z - z_p)/e², which is z while loading.
        compression: Real = deepest - (deepest - approach) / share
        pressing = np.logical_not(compression <= 0.0)
        spring = compression * pressing
        contact = NormalContact(
            force=state.stiffness * spring,
            radius=(state.radius * spring) ** 0.5,
            overlap=compression,
        )
        return contact, state._replace(deepest=deepest)
