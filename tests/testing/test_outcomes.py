"""How checks are run on a law, and how their outcomes are told."""

from typing import ClassVar

import pytest

import contactlab
from contactlab.testing import (
    CHECKS,
    CheckFailedError,
    ConformanceError,
    Outcome,
    Verdict,
    check_law,
    checks_for,
    examine,
    outcomes,
    parametrize_with_checks,
)
from contactlab.testing.check import (
    Check,
    CheckStoppedError,
    NotApplicableError,
    apply_if,
    hold,
)
from contactlab.testing.every_law import list_words
from tests.testing.broken_laws import Sound


class Expecting(Sound):
    """Expects to fail two checks."""

    expected_failures: ClassVar[dict] = {"second": "it is its nature", "claimed": "it is so too"}


class Offering(Sound):
    offers: ClassVar[frozenset] = frozenset({"word"})


def fails(law):
    """The law fails.

    In more words.
    """
    hold(False, "The law failed.")


def passes(law):
    """The law passes."""
    hold(1.0, "The law failed.")


def stops(law):
    """The law is stopped."""
    raise CheckStoppedError("The law hangs.")


def skips(law):
    """The law is left out."""
    apply_if([], "It has none.")


def raises(law):
    """The law raises."""
    return {}["missing"]


def made(name, function, claim=None):
    return Check(name, function, contactlab.contracts.Law, claim)


def told(law, check):
    found = outcomes.outcome(law, check)
    return found.verdict, found.sentence, found.out_of_time


LINE = raises.__code__.co_firstlineno + 2


@pytest.mark.parametrize(
    ("law", "check", "expected"),
    [
        (Sound(), made("first", passes), (Verdict.PASSED, "The law passes.", False)),
        (Sound(), made("first", fails), (Verdict.FAILED, "The law failed.", False)),
        (Sound(), made("first", stops), (Verdict.FAILED, "The law hangs.", True)),
        (Sound(), made("first", skips), (Verdict.NOT_APPLICABLE, "It has none.", False)),
        (Sound(), made("first", raises),
         (Verdict.FAILED, f"Raised KeyError: 'missing' (in raises, line {LINE})", False)),
        (Sound(), made("first", fails, "word"),
         (Verdict.NOT_CLAIMED, "The law does not offer 'word'.", False)),
        (Offering(), made("first", fails, "word"), (Verdict.FAILED, "The law failed.", False)),
        (Expecting(), made("first", fails), (Verdict.FAILED, "The law failed.", False)),
        (Expecting(), made("second", fails),
         (Verdict.EXPECTED_FAILURE, "it is its nature", False)),
        (Expecting(), made("second", raises),
         (Verdict.EXPECTED_FAILURE, "it is its nature", False)),
        (Expecting(), made("second", passes),
         (Verdict.UNEXPECTED_PASS, "The law says it fails: it is its nature", False)),
        (Expecting(), made("second", stops), (Verdict.FAILED, "The law hangs.", True)),
        (Expecting(), made("second", skips), (Verdict.NOT_APPLICABLE, "It has none.", False)),
        (Expecting(), made("claimed", fails, "word"),
         (Verdict.EXPECTED_FAILURE, "it is so too", False)),
    ],
)  # fmt: skip
def test_an_outcome_is_verdict_and_sentence(law, check, expected):
    assert told(law, check) == expected


def test_two_verdicts_are_faults():
    bad = {verdict for verdict in Verdict if not verdict.good}
    assert bad == {Verdict.FAILED, Verdict.UNEXPECTED_PASS}


def test_a_check_says_what_it_holds_in_one_line():
    assert made("first", fails).holds == "The law fails."
    assert made("first", fails).claim is None
    assert issubclass(CheckFailedError, AssertionError)


def test_what_holds_and_what_applies_raises_nothing():
    hold(True, "no")
    apply_if(True, "no")
    with pytest.raises(NotApplicableError, match=r"^no$"):
        apply_if(0, "no")


@pytest.fixture
def few(monkeypatch):
    """Three checks in place of all."""
    checks = [made("first", fails), made("second", passes), made("third", skips)]
    monkeypatch.setattr(outcomes, "CHECKS", checks)
    return checks


def test_progress_is_told_after_each_check(few):
    seen = []
    found = examine(Sound(), progress=lambda done, total: seen.append((done, total)))
    assert seen == [(1, 3), (2, 3), (3, 3)]
    assert [entry.check for entry in found] == ["first", "second", "third"]
    assert [entry.verdict.name for entry in found] == ["FAILED", "PASSED", "NOT_APPLICABLE"]


def test_the_faults_of_a_law_are_listed(few):
    with pytest.raises(ConformanceError) as error:
        check_law(Expecting())
    assert str(error.value) == (
        f"{__name__}.Expecting (not registered): 2 of 3 checks\n"
        "first: failed: The law failed.\n"
        "second: unexpected pass: The law says it fails: it is its nature\n"
        "A failure by the law's nature is named in its class with the reason: "
        'expected_failures: ClassVar = {"check": "reason"}'
    )
    few[0] = made("first", passes)
    assert [entry.verdict for entry in check_law(Sound())] == [
        Verdict.PASSED, Verdict.PASSED, Verdict.NOT_APPLICABLE,
    ]  # fmt: skip


@pytest.mark.parametrize("before", [2, 3])
def test_after_three_checks_out_of_time_the_rest_is_not_tried(few, before):
    few[:] = [made(f"stopped {n}", stops) for n in range(before)] + [made("last", passes)]
    last = examine(Sound())[-1]
    assert last == Outcome(
        "last",
        Verdict.PASSED if before == 2 else Verdict.FAILED,
        "The law passes." if before == 2 else "Not tried: 3 checks before it ran out of time.",
    )


def test_the_time_limit_is_handed_on(few, monkeypatch):
    limits = []

    def call(self, law, *, seconds=60.0):
        limits.append(seconds)

    monkeypatch.setattr(Check, "__call__", call)
    examine(Sound(), seconds=7.0)
    check_law(Sound(), seconds=8.0)
    examine(Sound())
    outcomes.outcome(Sound(), few[0])
    assert limits == [7.0] * 3 + [8.0] * 3 + [60.0] * 4


def test_a_law_may_be_named():
    named = checks_for("tangential.coulomb")
    assert named == checks_for(contactlab.create("tangential.coulomb"))
    assert {check.name for check in named} < {check.name for check in CHECKS}
    assert "grows" not in {check.name for check in named}


def test_tests_of_pytest_are_those_that_a_law_claims(few):
    few.append(made("claimed", fails, "word"))
    mark = parametrize_with_checks([Sound(), Expecting(), "tangential.coulomb"]).mark
    names, parameters = mark.args
    assert names == ("law", "check")
    ids = [parameter.id for parameter in parameters]
    assert ids == [
        "Sound-first", "Sound-second", "Sound-third",
        "Expecting-first", "Expecting-second", "Expecting-third", "Expecting-claimed",
        "tangential.coulomb-first", "tangential.coulomb-second", "tangential.coulomb-third",
    ]  # fmt: skip
    marked = {each.id: each.marks for each in parameters if each.marks}
    assert list(marked) == ["Expecting-second", "Expecting-claimed"]
    [mark] = marked["Expecting-second"]
    assert (mark.name, mark.kwargs) == ("xfail", {"reason": "it is its nature", "strict": True})
    law, check = parameters[4].values
    assert (type(law), check) == (Expecting, few[1])


def test_words_that_a_law_may_offer_are_those_that_checks_test():
    contracts = contactlab.contracts
    assert list_words(contracts.NormalLaw) == {
        "radius",
        "hertzian_pressure",
        "elastic_hertz",
        "kelvin_voigt",
        "viscous",
        "similar",
        "plastic",
        "elliptic",
    }
    assert list_words(contracts.TangentialLaw) == {
        "partial_slip",
        "rigid",
        "slip_speed",
        "no_friction",
        "vectors",
        "elliptic",
        "normal_spin",
        "shares_loss",
    }
    assert list_words(contracts.Integrator) == {"several_contacts", "controls_error"}
