"""What a check says where it does not apply, and sound laws of rare kinds, which pass."""

from typing import Any, ClassVar

import attrs
import numpy as np
import pytest

from contactlab.contracts import TangentialMotion
from contactlab.testing import CHECKS, Verdict, normal_motions
from contactlab.testing.faulty_laws import SpoiledHertz
from tests.laws.outside_laws import Adhesive
from tests.testing.broken_clauses import RunsItsOwnLawsOnly
from tests.testing.broken_laws import Sound
from tests.testing.broken_normal import Stepwise
from tests.testing.broken_partners import STEPS, Seen
from tests.testing.fresh_sound import HardSphere, Press
from tests.testing.made import checked

BOOKS = "The integrator runs neither of the laws of the kit whose books close."
FAULTY = "None of the faulty laws of the kit fits it."


class AsksNobody(STEPS):
    """Returns a motion without a step."""

    def integrate(self, scene, normal, tangential, observer=None):
        return TangentialMotion(slip_velocity_change=0.0, friction_work=0.0)


class TellsNoDrift(STEPS):
    """Leaves the drift of each step out."""

    def integrate(self, scene, normal, tangential, observer=None):
        law = Seen(law=tangential, times=np.nan)
        return super().integrate(scene, normal, law, observer)


class WithoutResolution(STEPS):
    resolution: ClassVar[Any] = None


class OfElasticBodies(Sound):
    """Runs under Hertz's law alone."""

    needs: ClassVar[frozenset] = frozenset({"elastic_hertz"})


class AnswersNothing(Sound):
    """Marches every impact, the central ones too."""

    def whole_impacts(self, scene, normal):
        return ()


class RefusesNan(Sound):
    """Refuses a step or a load that is not a number."""

    def advance(self, state, increment, before, after):
        if np.isnan(increment.displacement).any() or np.isnan(after.force).any():
            raise ValueError("a step must have numbers")
        return super().advance(state, increment, before, after)


class RefusesNanDepth(Press):
    """Refuses an approach or a rate that is not a number."""

    def respond(self, state, approach, rate):
        if np.isnan(approach).any() or np.isnan(rate).any():
            raise ArithmeticError("a contact must have numbers")
        return super().respond(state, approach, rate)


class NanAlone(RefusesNan):
    """Refuses NaN in a batch, and answers NaN to it alone."""

    def advance(self, state, increment, before, after):
        if np.ndim(increment.displacement) or np.ndim(after.force):
            return super().advance(state, increment, before, after)
        return Sound.advance(self, state, increment, before, after)


@attrs.frozen(kw_only=True)
class RefusesWithWords(Sound):
    """Refuses a scene and a partner, and says why."""

    def accept(self, scene):
        raise ValueError("scene: it runs none")


GLUED = Adhesive(pull=2e4, reach=1e-4)  # holds 1.3 J, of which the fastest impact has 0.21
STICKY = Adhesive(pull=500.0, reach=5e-6)  # holds 2 mJ: the slowest has 0.23 mJ, the next 23

CASES = [
    (RunsItsOwnLawsOnly(), "sliding_impulse_by",
     "The integrator runs neither of the sliding laws of the kit."),
    (RunsItsOwnLawsOnly(), "books_by", BOOKS),
    (RunsItsOwnLawsOnly(), "faults_reported", FAULTY),
    (RunsItsOwnLawsOnly(), "faults_named", FAULTY),
    (RunsItsOwnLawsOnly(), "normal_faults_reported", FAULTY),
    (RunsItsOwnLawsOnly(), "bounded", FAULTY),
    (AsksNobody(), "drift", "The integrator did not ask the law."),
    (TellsNoDrift(), "drift", "The integrator does not tell the drift."),
    (WithoutResolution(), "resolution_told", "The integrator has no resolution."),
    (WithoutResolution(), "order", "The integrator has no count of steps."),
    (SpoiledHertz(), "motion_accuracy", "Its motion declares no accuracy."),
    (Stepwise(), "dissipation", "The law declares none."),
    (GLUED, "rebounds", "At no speed do the bodies part: adhesion holds them."),
    (GLUED, "normal_passive", "Adhesion holds the surfaces far behind first touch: no cycle is "
     "closed."),
    (OfElasticBodies(), "coulomb_at_a_point_damped", "No integrator runs it under "
     "StronglyDampedHertz."),
    (Sound(), "coulomb_at_a_point", "The law tells no tractions: fields has neither radius and "
     "traction, nor radius, displacement and limit of springs."),
    (OfElasticBodies(), "load_impulse", "There is no way to run it under a normal law that pulls."),
    (AnswersNothing(), "whole_impact_form", "The law has no whole-impact answer."),
    (AnswersNothing(), "whole_impacts",
     "The law has no whole-impact answer for an impact with slip."),
    (HardSphere(), "whole_impacts", "No integrator can march it."),
    (HardSphere(), "impact_coulomb_limit", "Its whole-impact answers have no course, and so no "
     "force to check."),
    (HardSphere(), "declared_error", "The law declares no psi2_error, or nothing is finer to "
     "compare it with."),
    (Sound(), "at_rest_stiffness", "Its stiffness does not grow in proportion to the contact "
     "radius."),
]  # fmt: skip
SOUND = [
    (RefusesNan(), "non_finite"),
    (NanAlone(), "non_finite"),
    (RefusesNanDepth(), "contacts_non_finite"),
    (RefusesWithWords(), "partners"),
    (STICKY, "rebounds"),
    (STICKY, "normal_passive"),
    (OfElasticBodies(), "stiffness"),
]


def named(case):
    return f"{type(case[0]).__name__}-{case[1]}"


@pytest.mark.parametrize(("law", "name", "sentence"), CASES, ids=map(named, CASES))
def test_a_check_that_does_not_apply_says_why(law, name, sentence, monkeypatch):
    if law is GLUED:
        monkeypatch.setattr(normal_motions, "SPEEDS", (1.0,))  # a glued motion takes long
    told = checked(law, name)
    assert (told.verdict, told.sentence) == (Verdict.NOT_APPLICABLE, sentence)


@pytest.mark.parametrize(("law", "name"), SOUND, ids=map(named, SOUND))
def test_a_sound_law_of_a_rare_kind_passes(law, name, monkeypatch):
    if law is STICKY:
        monkeypatch.setattr(normal_motions, "SPEEDS", (0.1, 1.0))
    told = checked(law, name)
    check = next(check for check in CHECKS if check.name == name)
    assert (told.verdict, told.sentence) == (Verdict.PASSED, check.holds)


def test_a_claim_that_is_not_made_is_told():
    told = checked(Sound(), "cattaneo_mindlin")
    assert told.verdict is Verdict.NOT_CLAIMED
    assert told.sentence == "The law does not offer 'partial_slip'."


class RaisesOtherwise(Press):
    """Refuses a batch by an error that names no writing."""

    def respond(self, state, approach, rate):
        if np.ndim(approach):
            raise ValueError("no batches")
        return super().respond(state, approach, rate)


def test_an_error_that_is_not_of_writing_is_told_as_it_is():
    told = checked(RaisesOtherwise(), "contacts_read_only")
    assert told.verdict is Verdict.FAILED
    assert told.sentence.startswith("Raised ValueError: no batches (in respond, line ")


def test_checks_run_in_order_and_once_each():
    names = [check.name for check in CHECKS]
    assert len(set(names)) == len(names)
    assert names[:3] == ["contract", "spelling", "api_version"]
    assert names[-1] == "partners"
