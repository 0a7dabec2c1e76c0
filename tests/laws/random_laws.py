"""Laws with a draw for each impact, keyed by a seed and the impact's place in the whole batch."""

from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import (
    NormalContact,
    NormalLaw,
    SteppedTangentialLaw,
    TangentialResponse,
    WholeImpact,
    WholeImpactTangentialLaw,
)
from contactlab.numeric.checks import count


def draws(seed, index):
    """Return a number from 0 to 1 for each impact, of the shape of ``index``."""
    found = [np.random.default_rng((seed, int(one))).random() for one in np.ravel(index)]
    return np.reshape(found, np.shape(index)) if np.ndim(index) else found[0]


@attrs.frozen(kw_only=True)
class RandomNormal(NormalLaw):
    """A spring and a dashpot whose constant is drawn for each impact."""

    api_version: ClassVar[int] = 2
    seed: int = count(default=7, least=0)

    def start(self, scene):
        pair = scene.pair
        stiffness = pair.effective_modulus * pair.radius
        share = 0.05 + 0.2 * draws(self.seed, scene.index)
        return stiffness, 2.0 * share * (stiffness * pair.normal_mass) ** 0.5

    def respond(self, state, approach, rate):
        stiffness, constant = state
        force = stiffness * approach + constant * rate
        pushing = (approach > 0.0) & np.logical_not(force <= 0.0)
        return NormalContact(
            force=force * pushing, radius=0.0 * approach, overlap=approach * (2.0 * pushing - 1.0)
        ), state


@attrs.frozen(kw_only=True)
class RandomWhole(WholeImpactTangentialLaw):
    """A share of the slip velocity is lost, drawn for each impact."""

    api_version: ClassVar[int] = 2
    seed: int = count(default=7, least=0)

    def whole_impacts(self, scene, normal):
        lost = draws(self.seed, scene.index) * scene.slip_velocity
        work = scene.pair.tangential_mass * lost * (scene.slip_velocity - 0.5 * lost)
        return (WholeImpact(where=True, slip_velocity_change=-lost, friction_work=work, reason=""),)


@attrs.frozen(kw_only=True)
class RandomStepped(SteppedTangentialLaw):
    """Friction with a coefficient drawn for each impact, without a spring."""

    api_version: ClassVar[int] = 2
    seed: int = count(default=7, least=0)

    def start(self, scene, normal):
        return scene.friction_coefficient * draws(self.seed, scene.index)

    def advance(self, state, increment, before, after):
        force = state * increment.friction_load * np.sign(increment.velocity)
        return TangentialResponse(force, np.abs(force * increment.displacement)), state

    def stiffness(self, scene, normal):
        return 0.0
