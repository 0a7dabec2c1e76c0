"""Tangential laws that several tests need, and that no one should use."""

from typing import ClassVar

import attrs

from contactlab.contracts import SteppedTangentialLaw, TangentialResponse


@attrs.frozen(kw_only=True)
class Creator(SteppedTangentialLaw):
    """Makes energy, and says that its books close to a thousandth."""

    api_version: ClassVar[int] = 2

    def books_bound(self, scene):
        return 1e-3

    def start(self, scene, normal):
        return scene.friction_coefficient

    def advance(self, state, increment, before, after):
        return TangentialResponse(-0.1 * state * increment.friction_load, 0.0), state


@attrs.frozen(kw_only=True)
class Slinger(SteppedTangentialLaw):
    """Drives the slip on, and declares nothing of its books."""

    api_version: ClassVar[int] = 2

    def start(self, scene, normal):
        return scene.friction_coefficient

    def advance(self, state, increment, before, after):
        return TangentialResponse(-state * increment.friction_load, 0.0), state
