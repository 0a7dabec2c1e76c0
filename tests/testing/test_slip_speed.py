"""The word ``slip_speed``: the checks of Coulomb's limit and of memory at one slip speed."""

from typing import ClassVar

import attrs
import numpy as np
import pytest

from contactlab.contracts import POSITIVE, SteppedTangentialLaw, TangentialResponse, quantity
from contactlab.testing.outcomes import Verdict, checks_for, examine, outcome


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


FIVE = {"gross_slip", "turning_points", "sliding_impulse", "friction_load", "load_impulse"}
FURTHER = {"slip_speed", "coulomb_limit", "friction_coefficient"}


def failed(law, names):
    checks = [check for check in checks_for(law) if check.name in names]
    found = [outcome(law, check) for check in checks]
    return {each.check for each in found if each.verdict is Verdict.FAILED}


@pytest.mark.slow
def test_the_word_is_all_that_the_kit_needs():
    outcomes = examine(Stribeck())
    assert {each.check for each in outcomes if not each.verdict.good} == set()
    assert {each.check for each in examine(Untold()) if not each.verdict.good} == FIVE


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (Stribeck(), set()),
        (Stribeck(speed=0.01), set()),
        (Untold(), FIVE),
        (Constant(), {"slip_speed"}),
    ],
    ids=["told", "slow", "untold", "constant"],
)
def test_a_law_of_the_slip_speed_passes_with_the_word_alone(law, expected):
    assert failed(law, FIVE | FURTHER) == expected


@pytest.mark.parametrize(
    ("law", "check"),
    [(OfLoad(), "slip_speed"), (OfLoad(), "gross_slip"), (Twice(), "slip_speed"),
     (Twice(), "coulomb_limit"), (Forgets(), "turning_points")],
)  # fmt: skip
def test_the_word_excuses_no_other_fault(law, check):
    assert failed(law, {check}) == {check}
