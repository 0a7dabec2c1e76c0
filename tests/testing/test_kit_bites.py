"""The kit catches each broken law by the check that is meant for it, and lets a sound one pass."""

import numpy as np
import pytest

from contactlab.testing import (
    CHECKS,
    ConformanceError,
    Verdict,
    check_law,
    checks_for,
    faulty_laws,
    outcome,
)
from contactlab_laws.mindlin import MindlinCap
from tests.longer import longer
from tests.present import PACKAGE, ROOT
from tests.testing import broken_clauses as clauses
from tests.testing import broken_declarations as declarations
from tests.testing import broken_impacts as impacts
from tests.testing import broken_integrators as integrators
from tests.testing import broken_laws as laws
from tests.testing import broken_normal as normal
from tests.testing import broken_partners as partners
from tests.testing import broken_rigid as rigid
from tests.testing import broken_spin as spin
from tests.testing import broken_vectors as vectors
from tests.testing import fresh_faults
from tests.testing.made import checked

TOLD = (ROOT / "README.md", PACKAGE / "guide" / "how-far-to-trust.md")


BROKEN = [
    *laws.BROKEN,
    *declarations.BROKEN,
    *impacts.BROKEN,
    *normal.BROKEN,
    *integrators.BROKEN,
    *clauses.BROKEN,
    *partners.BROKEN,
    *fresh_faults.FAULTS,
    *rigid.BROKEN,
    *vectors.BROKEN,
    *spin.BROKEN,
]


def failed(law):
    """Names of the checks failed, the slow ones on whole impacts left out."""
    checks = [check for check in checks_for(law) if not check.name.startswith("impact_")]
    return [check.name for check in checks if outcome(law, check).verdict is Verdict.FAILED]


@pytest.mark.parametrize(
    "law",
    [
        laws.Sound(),
        *longer(
            impacts.Whole(),
            spin.Torsion(),
            normal.Stepwise(),
            declarations.TwoRequired(stretch=1e-3, count=3),
            declarations.Interpolates(),
            impacts.AllAtOnce(),
            impacts.Knowing(),
            vectors.SoundVector(),
        ),
    ],
    ids=lambda law: type(law).__name__,
)
def test_a_sound_law_passes_every_check(law):
    verdicts = {entry.verdict for entry in check_law(law)}
    assert verdicts <= {Verdict.PASSED, Verdict.NOT_CLAIMED, Verdict.NOT_APPLICABLE}
    assert Verdict.PASSED in verdicts


@pytest.mark.parametrize(
    ("broken", "name", "words"), BROKEN, ids=[f"{law.__name__}-{name}" for law, name, _ in BROKEN]
)
def test_each_broken_law_is_caught_by_the_check_meant_for_it(broken, name, words, monkeypatch):
    """For the fault it has: a check that only stumbles over it says something else."""
    monkeypatch.setattr(faulty_laws, "MOST_CALLS", 30_000)  # a run without end reaches any
    np.random.seed(1)  # noqa: NPY002 one of the faults draws from the global generator
    law = broken()
    found = checked(law, name)
    assert found.verdict is Verdict.FAILED, found
    assert words in found.sentence


def test_every_check_bites():
    assert {name for _, name, _ in BROKEN} == {check.name for check in CHECKS}


@pytest.mark.parametrize("page", TOLD, ids=lambda page: page.stem)
def test_the_counts_of_the_readme(page):
    told = " ".join(page.read_text(encoding="utf-8").split())
    broken = len({law for law, _, _ in BROKEN})
    assert f"{broken} broken laws" in told or f"{broken} deliberately broken laws" in told
    assert page.stem != "README" or f"{len(CHECKS)} named checks" in told


@pytest.mark.slow
@pytest.mark.parametrize(
    ("broken", "name"),
    [pytest.param(law, name, id=law.__name__) for law, name, _ in vectors.BROKEN],
)
def test_a_fault_in_vectors_or_in_the_future_fails_one_check(broken, name):
    """Laws of numbers do not show it, and each check sees what no other does."""
    assert failed(broken()) == [name]


def test_what_cannot_be_run_is_not_passed():
    law = declarations.OneOfThreeWays()
    found = {entry.name: outcome(law, entry).verdict for entry in checks_for(law)}
    marched = ("impact_", "whole_impacts", "sliding_impulse")
    tried = {name: verdict for name, verdict in found.items() if name.startswith(marched)}
    assert len(tried) >= 10
    assert set(tried.values()) <= {Verdict.NOT_APPLICABLE, Verdict.NOT_CLAIMED}


def test_a_force_that_is_not_told_is_not_judged():
    law = impacts.WholeTooLong()
    assert checked(law, "impact_coulomb_limit").verdict is Verdict.NOT_APPLICABLE


def test_a_refusal_names_law_check_and_fault():
    words = r"WrongSign.*\n(.*\n)*opposes_slip: failed: (.*\n)*.*expected_failures: ClassVar"
    with pytest.raises(ConformanceError, match=words):
        check_law(laws.WrongSign())


def test_a_failure_that_may_be_the_nature_of_a_law_says_so():
    """A stiffness that changes with the load keeps no books: Mindlin's spring, without a word."""
    law = type("Silent", (MindlinCap,), {"expected_failures": {}, "api_version": 2})()
    for name in ("books", "impact_books", "normal_load_alone"):
        found = checked(law, name)
        assert found.verdict is Verdict.FAILED
        assert "with the load" in found.sentence
        assert "named in expected_failures" in found.sentence


def test_an_unexpected_pass_is_reported():
    assert checked(declarations.ExpectsTooMuch(), "units").verdict is Verdict.UNEXPECTED_PASS
    said = {"expected_failures": {"impact_units": "it is not so"}, "api_version": 2}
    with pytest.raises(ConformanceError, match="impact_units: unexpected pass"):
        check_law(type("Expecting", (impacts.Whole,), said)())


@pytest.mark.slow
def test_a_fault_in_one_law_harms_no_other():
    for broken in (laws.Raises, laws.HiddenMemory, laws.ReturnsNone):
        failed(broken())
    assert failed(laws.Sound()) == []
