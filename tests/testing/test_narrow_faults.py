"""Faults that show in one quantity alone, and laws just beside the bound of a check."""

import re
from typing import ClassVar

import attrs
import numpy as np
import pytest

import contactlab
from contactlab.contracts import NormalContact
from contactlab.testing import Verdict
from tests.testing.broken_declarations import Mutable
from tests.testing.broken_impacts import AllAtOnce
from tests.testing.broken_laws import Sound
from tests.testing.broken_normal import Altered, Stepwise
from tests.testing.fresh_faults import STEPS, Steps
from tests.testing.fresh_sound import HardSphere, Mindlin, Press
from tests.testing.made import altered, broken, checked


def found(law, name):
    """Verdict and sentence of one check of a law."""
    told = checked(law, name)
    return told.verdict, told.sentence


class Paid(HardSphere):
    """Another friction work than that of its change."""

    def share(self, scene):
        raise NotImplementedError

    def answer(self, scene, change, work):
        return super().answer(scene, change, work * self.share(scene))


class Worked(Steps):
    """Another friction work than that of its march."""

    def share(self, scene):
        raise NotImplementedError

    def alter(self, motion, scene):
        return attrs.evolve(motion, friction_work=self.share(scene) * motion.friction_work)


class ShowsWhatIsOver(STEPS):
    """Shows an instant half a duration after separation."""

    def integrate(self, scene, normal, tangential, observer=None):
        motion = super().integrate(scene, normal, tangential, last := Last(observer))
        if observer is not None:
            observer(last.sample._replace(time=1.5 * normal.duration))
        return motion


class Last:
    """Hands on every sample, and keeps the last one."""

    def __init__(self, observer):
        self.observer, self.stepwise = observer, True

    def __call__(self, sample):
        self.sample = sample
        if self.observer is not None:
            self.observer(sample)


class TakesMore(Sound):
    """Takes any new attribute."""

    def __setattr__(self, name, value):
        if name != "something_new":
            raise AttributeError(name)
        object.__setattr__(self, name, value)


NARROW = [
    (ShowsWhatIsOver, "observer_changes_nothing", "The last instant seen is at 1.5 of the durati"),
    (TakesMore, "immutable", "something_new can be set: freeze the class, attrs.frozen(kw_only"),
    *broken(Paid, "share",
        ("PaidBySense",
         lambda scene: np.where(np.asarray(scene.slip_velocity) < 0.0, 1.01, 1.0)[()],
         "impact_odd", "psi1 = -0.01, chi = 0.4: differs by 4.2e-07 from the mirror"),
        ("PaidByTheMetre", lambda scene: 1.0 + scene.pair.radius,
         "impact_units", "psi1 = 0.01, chi = 0.4: in other units psi2 differs by "),
        ("PaidInBatches", lambda scene: 1.01 if scene.shape == (6,) else 1.0,
         "impact_batch", "Impact (0, 0) of a batch is off by "),
    ),
    *broken(Worked, "share",
        ("WorkOfOneSense",
         lambda scene: np.where(np.asarray(scene.slip_velocity) < 0.0, 1.01, 1.0)[()],
         "impact_odd", "psi1 = -0.01, chi = 0.4: differs by "),
        ("WorkOfABatch", lambda scene: 1.01 if scene.shape else 1.0,
         "impact_batch", "Impact (0, 0) of a batch is off by 9.6e-03 in psi"),
    ),
    *broken(Altered, "alter",
        ("ComplexLoad", lambda contact, *_: contact._replace(friction_load=contact.force + 0j),
         "contacts", "friction_load = 0j at approach 0.0, batch shape ()."),
        ("NoRadius", lambda contact, *_: contact._replace(radius=None),
         "contacts", "radius = None at approach 0.0, batch shape ()."),
    ),
    *broken(Sound, "api_version",
        ("HalfAVersion", 2.0, "api_version", "api_version = 2.0: contactlab has 2."),
    ),
    *broken(Press, "api_version",
        ("NoVersion", None, "api_version", "api_version = None: contactlab has 2."),
    ),
    *broken(Sound, "offers",
        ("OffersNumbers", frozenset({1}),
         "contract", "OffersNumbers.offers = frozenset({1}): must be words"),
    ),
    *broken(STEPS, "needs",
        ("RunsNothing", frozenset(),
         "contract", "needs = frozenset(): must have a class derived from TangentialLaw"),
    ),
    *broken(Sound, "expected_failures",
        ("TwoWords", {"units": "by nature"}, "expected_failures", "'units' needs a reason."),
    ),
    *altered(AllAtOnce, "advance_all",
        ("CostlyInABatch", lambda answer, scene, *_: answer if not scene.shape else answer._replace(
            friction_work=1.01 * answer.friction_work),
         "all_steps", "A batch of shape (8,): differs by "),
    ),
    *altered(Sound, "advance",
        ("WorkByTheMetre", lambda response, new, _, _increment, _before, after: (response._replace(
            friction_work=response.friction_work * (1.0 + after.radius)), new),
         "units", "In other units the answer differs by "),
    ),
]  # fmt: skip


@pytest.mark.parametrize(("law", "name", "words"), NARROW, ids=[law.__name__ for law, *_ in NARROW])
def test_a_fault_in_one_quantity_is_caught(law, name, words):
    verdict, sentence = found(law(), name)
    assert verdict is Verdict.FAILED
    assert sentence.startswith(words), sentence


def test_the_check_of_a_law_that_can_be_changed_leaves_it_as_it_was():
    law = Mutable()
    assert found(law, "immutable")[0] is Verdict.FAILED
    assert law.ratio == 0.7


@attrs.frozen(kw_only=True)
class Wide(Stepwise):
    """b² over R z is ``share``; with ``pull`` in N the surfaces attract each other."""

    share: float = 1.0
    pull: float = 0.0

    def alter(self, contact, dashpot, rate):
        pulled = contact.force - self.pull * (contact.overlap > 0.0)
        return NormalContact(pulled, self.share**0.5 * contact.radius, contact.overlap)


@pytest.mark.parametrize(
    ("name", "law", "good"),
    [  # elastic 1, flowing 2, either with 0.02 of room
        ("radius", Wide(share=0.975), False),
        ("radius", Wide(share=0.985), True),
        ("radius", Wide(share=2.015), True),
        ("radius", Wide(share=2.025), False),
        ("hertzian_pressure", Wide(share=0.975), False),
        ("hertzian_pressure", Wide(share=0.985), True),
        ("hertzian_pressure", Wide(share=1.015), True),
        ("hertzian_pressure", Wide(share=1.025), False),
        ("hertzian_pressure", Wide(share=1.5, pull=50.0), True),
        ("hertzian_pressure", Wide(share=2.025, pull=50.0), False),
    ],
)
def test_the_radius_is_that_of_an_elastic_sphere_or_of_one_that_flows(name, law, good):
    assert (found(law, name)[0] is Verdict.PASSED) == good


class TwoThirds(Mindlin):
    """The stiffness of Di Renzo and Di Maio."""

    factor: ClassVar[float] = 2.0 / 3.0

    def modulus(self, scene):
        return self.factor * super().modulus(scene)


class Softer(TwoThirds):
    factor: ClassVar[float] = 0.96


class Between(TwoThirds):
    factor: ClassVar[float] = 0.72


@pytest.mark.parametrize(
    ("law", "verdict"),
    [
        (Mindlin(), Verdict.PASSED),
        (TwoThirds(), Verdict.PASSED),
        (Softer(), Verdict.FAILED),
        (Between(), Verdict.FAILED),
    ],
)
def test_a_stiffness_in_proportion_to_the_radius_is_one_of_two(law, verdict):
    assert found(law, "at_rest_stiffness")[0] is verdict


class TellsOfMore(type(contactlab.create("tangential.annulus"))):
    """Annuli whose force is right, and whose tractions are told half as large again."""

    def fields(self, state):
        fields = super().fields(state)
        return {**fields, "traction": 1.5 * fields["traction"]}


def test_tractions_that_are_told_are_held_against_the_limit_at_their_place():
    """Half of mu p too much; the greatest is at the centre, where p is 3/2 of its mean."""
    assert found(contactlab.create("tangential.annulus"), "coulomb_at_a_point")[0] is Verdict.PASSED
    verdict, sentence = found(TellsOfMore(), "coulomb_at_a_point")
    assert verdict is Verdict.FAILED
    assert 0.7 <= float(re.search(r"exceeds mu p by (\S+) of the mean", sentence)[1]) <= 0.9
