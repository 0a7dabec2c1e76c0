"""Two springs: a softer one in loading, a stiffer one in unloading."""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import NormalContact, NormalLaw, NormalMotion
from contactlab.contracts.restitution import restitution
from contactlab.impact.hertz import linear_stiffness
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import POSITIVE, Real, quantity
from contactlab_laws.differences.table import choice


class Memory(NamedTuple):
    """Loading stiffness k1 in N/m, the pair's radius in m, and the deepest approach so far."""

    stiffness: Real
    radius: Real
    deepest: Real


@attrs.frozen(kw_only=True)
class WaltonBraun(NormalLaw):
    """Plastic loading P = k1 z and elastic unloading P = k2 (z - z_p), with e = sqrt(k1/k2).

    In N, positive in compression; z_p = (1 - e²) z_max is left over. The contact is that of a
    sphere as it is pressed, b² = R z, then that of its flattened cap, b² = (R/e²)(z - z_p): in
    both b² = R P/k1. The law knows no pressure.

    Parameters
    ----------
    restitution : float
        e, rebound over approach velocity, at most 1; the same at any speed.
    stiffness : float, optional
        k1 in N/m. By default each impact has that with which its loading spring would give way
        as far as Hertz's, were it elastic: k1 = M (v1/z_max)².

    References
    ----------
    Walton & Braun, J. Rheol. 30 (1986) 949-980, doi:10.1122/1.549893.
    """

    api_version: ClassVar[int] = 2
    plastic: ClassVar[bool] = True
    offers: ClassVar[frozenset[str]] = frozenset({"radius"})

    restitution: float = restitution(default=0.9)
    stiffness: float | None = quantity("N/m", rule=POSITIVE, default=None)

    def start(self, scene: Scene) -> Memory:
        """Return stiffness and radius of the pair, never pressed yet."""
        stiffness = linear_stiffness(scene) if self.stiffness is None else self.stiffness
        return Memory(stiffness, scene.pair.radius, 0.0)

    def respond(self, state: Memory, approach: Real, rate: Real) -> tuple[NormalContact, Memory]:
        """Return force and radius, and the memory of this approach."""
        deepest = np.maximum(state.deepest, approach)
        share = self.restitution * self.restitution
        # The unloading line of the deepest approach; while loading it ends just there.
        given_way: Any = deepest - (deepest - approach) / share
        pressing = np.logical_not(given_way <= 0.0)
        spring = given_way * pressing
        contact = NormalContact(
            force=state.stiffness * spring,
            radius=(state.radius * spring) ** 0.5,
            overlap=given_way,
        )
        return contact, state._replace(deepest=deepest)

    def cautions(self, scene: Scene, motion: NormalMotion) -> tuple[str, ...]:
        """Return those of every law, and how far others of the same restitution move psi2."""
        return (*super().cautions(scene, motion), *choice(scene, motion))
