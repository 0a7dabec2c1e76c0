"""Laws that break what is asked of marks, normal motions, bounds, dissipation and partners."""

from typing import Any, ClassVar

import attrs
import numpy as np

import contactlab
from contactlab import Status
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


@attrs.frozen(kw_only=True)
class SeenWhole(Seen):
    """Another law, with its normal motion."""

    def normal_motion(self, state):
        return self.law.normal_motion(state)


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


class HastensTheDrift(STEPS):
    """Tells the drift half again as long."""

    def integrate(self, normal, tangential, scene, observer=None):
        told = SeenWhole(law=tangential, times=1.5)
        return super().integrate(normal, told, scene, observer)


class MarksOfTheMean(STEPS):
    """The mean change of a batch for each of its impacts."""

    def integrate(self, normal, tangential, scene, observer=None):
        motion = super().integrate(normal, tangential, scene, observer)
        change = np.mean(motion.slip_velocity_change) + 0.0 * motion.slip_velocity_change
        return attrs.evolve(motion, slip_velocity_change=change)


class GivesUpOnMarks(STEPS):
    """Follows no law with marks, and none with a normal motion."""

    def integrate(self, normal, tangential, scene, observer=None):
        motion = super().integrate(normal, tangential, scene, observer)
        return motion.failing(True, Status.UNRESOLVED, "it is too hard")


class FallingMarks(Sound):
    """Marks that fall."""

    def marks(self, scene, normal):
        return np.array([1.0, 0.5])


class LateMarks(Sound):
    """Marks after separation."""

    def marks(self, scene, normal):
        return np.array([1.0, 3.2])


class EarlyMarks(Sound):
    """Marks that begin at first touch."""

    def marks(self, scene, normal):
        return np.array([0.0, 1.0])


class WideMarks(Sound):
    """Marks of three impacts, whatever is asked."""

    def marks(self, scene, normal):
        return np.array([[1.0, 1.1, 1.2], [2.0, 2.1, 2.2]])


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
    (ForgetsMarks, "marks", "asks for the end of a step at phase 0.41"),
    (MisTellsDrift, "drift", "0.5 off velocity times drift"),
    (KeepsTheMotion, "normal_motion_told", "normal is None"),
    (HastensTheDrift, "normal_motion_told", "A conservative coupling changes the energy by"),
    (MarksOfTheMean, "marks", "A batch whose impacts have other marks is"),
    (GivesUpOnMarks, "marks", "UNRESOLVED it is too hard"),
    (GivesUpOnMarks, "normal_motion_told", "UNRESOLVED it is too hard"),
    (LateMarks, "marks_grow", "between 0 and pi"),
    (EarlyMarks, "marks_grow", "between 0 and pi"),
    (WideMarks, "marks_grow", "Marks of shape (2, 3) for a scene of shape ()"),
    (BoundOfABatch, "books_bound_told", "must be at least 0, of shape () or ()"),
    (RefusesBlankly, "partners", "refuses(integrator.symplectic) returned ' '"),
    (RefusesSpeechless, "partners", "It refuses a scene without a word"),
    (FallingMarks, "marks_grow", "must grow along the first axis"),
    (NegativeBound, "books_bound_told", "must be at least 0"),
    (RefusesByNod, "partners", "returned True"),
    (LosesByWord, "dissipation", "off by 0.5"),
]
