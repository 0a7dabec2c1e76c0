"""Laws of a friction coefficient that depends on the slip speed: a sound one, and faulty ones."""

from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import POSITIVE, SteppedTangentialLaw, TangentialResponse, quantity


@attrs.frozen(kw_only=True)
class Stribeck(SteppedTangentialLaw):
    """One spring, cut to a share of mu that falls from 1 to a half over a slip speed."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"slip_speed"})
    needs: ClassVar[frozenset[str]] = frozenset({"radius"})

    speed: float = quantity("m/s", rule=POSITIVE, default=0.5)

    def start(self, scene, normal):
        return scene.friction_coefficient, self.stiffness(scene, normal), 0.0

    def share(self, increment, after):
        return 0.5 + 0.5 * np.exp(-np.abs(increment.velocity) / self.speed)

    def advance(self, state, increment, before, after):
        friction, stiffness, old = state
        limit = friction * self.share(increment, after) * after.friction_load / stiffness
        trial = old + increment.displacement
        new = np.minimum(np.maximum(trial, -limit), limit)
        work = np.maximum(0.5 * stiffness * (old + new) * (trial - new), 0.0)
        return TangentialResponse(stiffness * new, work), (friction, stiffness, new)

    def stiffness(self, scene, normal):
        return scene.pair.tangential_stiffness(normal.maximum_radius)


class Untold(Stribeck):
    """The same law, which does not offer the word."""

    offers: ClassVar[frozenset[str]] = frozenset()


class OfLoad(Stribeck):
    """The share falls with the load too."""

    def share(self, increment, after):
        return super().share(increment, after) / (1.0 + 1e-4 * after.force)


class Twice(Stribeck):
    """More than the scene's mu."""

    def share(self, increment, after):
        return 2.0 * super().share(increment, after)


class Forgets(Stribeck):
    """A reversal is forgotten."""

    def advance(self, state, increment, before, after):
        friction, stiffness, old = state
        kept = old if old * increment.displacement >= 0.0 else 0.0 * old
        return super().advance((friction, stiffness, kept), increment, before, after)


class Constant(Stribeck):
    """The word without the need."""

    def share(self, increment, after):
        return 1.0
