"""Laws that break what is asked of marks, normal motions, bounds, dissipation and partners."""

from typing import Any, ClassVar

import attrs
import numpy as np

import contactlab
from contactlab.contracts import SteppedTangentialLaw
from contactlab_laws.hertz.law import Hertz
from tests.testing.broken_laws import Sound

STEPS: Any = type(contactlab.create("integrator.symplectic"))


@attrs.frozen(kw_only=True)
class Seen(SteppedTangentialLaw):
    """Another law, without its marks and without its normal motion."""

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


class ForgetsMarks(STEPS):
    """Offers marks, and takes its even steps."""

    def integrate(self, normal, tangential, scene, observer=None):
        return super().integrate(normal, Seen(law=tangential), scene, observer)


class MisTellsDrift(STEPS):
    """Tells half of the drift."""

    def integrate(self, normal, tangential, scene, observer=None):
        return super().integrate(normal, Seen(law=tangential, times=0.5), scene, observer)


class KeepsTheMotion(STEPS):
    """Offers the normal motion of a law, and keeps it."""

    def integrate(self, normal, tangential, scene, observer=None):
        motion = super().integrate(normal, tangential, scene, observer)
        return attrs.evolve(motion, normal=None)


class FallingMarks(Sound):
    """Marks that fall."""

    def marks(self, scene, normal):
        return np.array([1.0, 0.5])


class NegativeBound(Sound):
    """Bounds its books by less than nothing."""

    def books_bound(self, scene):
        return -1.0


class RefusesByNod(Sound):
    """Refuses every partner, without a reason."""

    def refuses(self, other):
        return True


class LosesByWord(Hertz):
    """Says that it loses half of the energy."""

    def dissipation(self, motion):
        return 0.25 * motion.scene.pair.normal_mass * motion.scene.normal_speed**2


BROKEN = [
    (ForgetsMarks, "marks", "asks for the end of a step at phase 0.41"),
    (MisTellsDrift, "drift", "0.5 off velocity times drift"),
    (KeepsTheMotion, "normal_motion_told", "normal is None"),
    (FallingMarks, "marks_grow", "must grow along the first axis"),
    (NegativeBound, "books_bound_told", "must be at least 0"),
    (RefusesByNod, "partners", "returned True"),
    (LosesByWord, "dissipation", "off by 0.5"),
]
