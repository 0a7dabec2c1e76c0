"""Laws that break what is asked of drift, bounds, dissipation and partners."""

from typing import Any, ClassVar

import attrs
import numpy as np

from contactlab.contracts import SteppedTangentialLaw
from contactlab_laws.hertz import Hertz
from tests.testing.broken_laws import Sound
from tests.testing.fresh_faults import STEPS
from tests.testing.made import broken


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

    def integrate(self, scene, normal, tangential, observer=None):
        return super().integrate(scene, normal, Seen(law=tangential, times=0.5), observer)


class RefusesSpeechless(Sound):
    """Refuses a scene without units, and says nothing."""

    def accept(self, scene):
        if scene.unit_friction:
            raise ValueError


BROKEN = [
    (MisTellsDrift, "drift", "0.5 off velocity times drift"),
    (RefusesSpeechless, "partners", "The law refuses a scene without a word"),
    *broken(Sound, "books_bound",
        ("BoundOfABatch", lambda *_: np.array([0.1, 0.1]),
         "books_bound_told", "must be at least 0, of shape () or ()"),
        ("NegativeBound", lambda *_: -1.0, "books_bound_told", "must be at least 0"),
    ),
    *broken(Sound, "refuses",
    ),
    *broken(Hertz, "dissipation",
        ("LosesByWord",
         lambda motion: 0.25 * motion.scene.pair.normal_mass * motion.scene.normal_speed**2,
         "dissipation", "off by 0.5"),
    ),
]  # fmt: skip
