"""Normal laws that are not Hertz's: a linear spring, and one that is not elastic."""

from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import NormalContact, NormalLaw
from contactlab.numeric.checks import quantity


def in_si(scene):
    """Return a scene of psi1 and chi with its numbers in SI: a body of 1 m and 1 kg at 1 m/s."""
    return attrs.evolve(scene, has_units=True)


@attrs.frozen(kw_only=True)
class LinearSpring(NormalLaw):
    """P = k u_z, without radius or closed form: the impact lasts pi sqrt(M/k), and e = 1."""

    api_version: ClassVar[int] = 2

    stiffness: float = quantity("N/m", default=1.0)

    def start(self, scene):
        return None

    def respond(self, state, approach, rate):
        force = self.stiffness * approach * (approach > 0)
        return NormalContact(force, 0.0 * approach, approach), state


@attrs.frozen(kw_only=True)
class Damped(NormalLaw):
    """Hertz's force times 1 + damping times rate (Hunt & Crossley 1975)."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset] = frozenset({"radius", "hertzian_pressure"})

    damping: float = quantity("s/m", default=0.2)

    def start(self, scene):
        return scene.pair

    def respond(self, state, approach, rate):
        inside = np.maximum(approach, 0.0)
        hertz = (4 / 3) * state.effective_modulus * state.radius**0.5 * inside**1.5
        force = np.maximum(hertz * (1.0 + self.damping * rate), 0.0)
        return NormalContact(force, np.sqrt(state.radius * inside), approach), state


@attrs.frozen(kw_only=True)
class ForceFree(NormalLaw):
    """Bodies that go through one another."""

    api_version: ClassVar[int] = 2

    def start(self, scene):
        return None

    def respond(self, state, approach, rate):
        return NormalContact(0.0 * approach, 0.0 * approach, approach), state
