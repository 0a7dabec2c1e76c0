"""Laws that break what is asked of drift, bounds, dissipation and partners."""

from typing import Any, ClassVar

import attrs
import numpy as np

import contactlab
from contactlab.contracts import SteppedTangentialLaw
from contactlab_laws.hertz import Hertz
from tests.testing.broken_laws import Sound

STEPS: Any = type(contactlab.create("integrator.symplectic"))


@attrs.frozen(kw_only=True)
class Seen(SteppedTangentialLaw):
    """Another law, told another drift."""

    api_version: ClassVar[int] = 2
    law: Any = None
    times: float = 1.0

    def start(self, scene, normal):
        return self.law.start(scene, normal)

    def advance(self, state, increment, before, after):
        told = increment._replace(drift=self.times * increment.drift)
        return self.law.advance(state, told, before, after)

    def stiffness(self, scene, normal):
        return self.law.stiffness(scene, normal)


class MisTellsDrift(STEPS):
    """Tells half of the drift."""

    def integrate(self, normal, tangential, scene, observer=None):
        return super().integrate(normal, Seen(law=tangential, times=0.5), scene, observer)


class BoundOfABatch(Sound):
    """Bounds the books of two impacts, whatever is asked."""

    def books_bound(self, scene):
        return np.array([0.1, 0.1])


class NegativeBound(Sound):
    """Bounds its books by less than nothing."""

    def books_bound(self, scene):
        return -1.0


class RefusesByNod(Sound):
    """Refuses every partner, without a reason."""

    def refuses(self, other):
        return True


class RefusesBlankly(Sound):
    """Refuses an integrator by a blank."""

    def refuses(self, other):
        return " " if other.kind == "integrator" else None


class RefusesSpeechless(Sound):
    """Refuses a scene without units, and says nothing."""

    def accept(self, scene):
        if scene.unit_friction:
            raise ValueError


class LosesByWord(Hertz):
    """Says that it loses half of the energy."""

    def dissipation(self, motion):
        return 0.25 * motion.scene.pair.normal_mass * motion.scene.normal_speed**2


BROKEN = [
    (MisTellsDrift, "drift", "0.5 off velocity times drift"),
    (BoundOfABatch, "books_bound_told", "must be at least 0, of shape () or ()"),
    (RefusesBlankly, "partners", "refuses(integrator.symplectic) returned ' '"),
    (RefusesSpeechless, "partners", "It refuses a scene without a word"),
    (NegativeBound, "books_bound_told", "must be at least 0"),
    (RefusesByNod, "partners", "returned True"),
    (LosesByWord, "dissipation", "off by 0.5"),
]
