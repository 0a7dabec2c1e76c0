"""Clauses of plans: their shares, their numbers, and how those of parts become one."""

import math

import numpy as np

from contactlab.outcome.plan import Clause, Plan
from tests.outcome.made import plan

NAN = math.nan


def where(*flags):
    return np.array(flags)


def test_a_clause_has_its_share_before_the_colon():
    clause = Clause("steps: at most {:.2g}", where(True, False, True), (where(0.1, 0.9, 0.2),))
    assert clause.words == "steps: at most 0.2"  # of the impacts that it is said of
    assert str(clause) == "steps (2 of 3 impacts): at most 0.2"
    assert str(clause.take(slice(2, 3))) == "steps: at most 0.2"
    assert str(Clause("words", where(True, False))) == "words (1 of 2 impacts)"
    for flags, value in ((False, 0.5), (True, NAN)):  # of no impact, or of one without a number
        assert Clause("never: {:g}", where(flags), (where(value),)).words == "never: nan"


def parts():
    """Return plans of two impacts and of three, with one clause in common."""
    text = "error: at most {:.2g}"
    first = Plan(
        computed=(Clause(text, where(True, False), (where(0.1, 0.2),)),),
        left_out=(),
        cautions=(Clause("steps raised", where(False, True), code="steps"),),
        marched=where(True, False),
        psi2_error=where(0.1, 0.2),
    )
    second = Plan(
        computed=(Clause(text, where(True, True, False), (where(0.3, 0.4, 9.0),)),),
        left_out=(Clause("history", where(True, True, True)),),
        cautions=(Clause("steps raised", where(True, False, False), code="steps"),),
        marched=where(False, True, True),
        psi2_error=0.5,
    )  # fmt: skip
    return first, second


def test_a_plan_joined_from_its_parts():
    joined = Plan.joined(parts())
    assert str(joined).splitlines() == [
        "computed: error (3 of 5 impacts): at most 0.4",
        "left out: history (3 of 5 impacts)",
        "caution:  steps raised (2 of 5 impacts)",
    ]
    assert [clause.where.tolist() for clause in (*joined.computed, *joined.cautions)] == [
        [True, False, True, True, False],
        [False, True, True, False, False],
    ]
    assert joined.marched.tolist() == [True, False, False, True, True]
    assert joined.psi2_error.tolist() == [0.1, 0.2, 0.5, 0.5, 0.5]
    assert joined.cautions[0].code == "steps"
    assert str(joined[0]) == "computed: error: at most 0.1"
    assert str(joined[1]) == "caution:  steps raised"
    wide = Plan.joined(parts(), (5, 1))
    assert wide.psi2_error.shape == wide.marched.shape == (5, 1)
    first, second = parts()
    assert Plan.joined([first]).psi2_error.tolist() == [0.1, 0.2]
    assert Plan.joined([second]).psi2_error.tolist() == [0.5] * 3


def test_a_plan_as_a_mapping():
    planned = plan((2,), error=[0.1, NAN], unchecked=[True, False], cautions=("doubt: one",))
    assert planned.to_dict() == {
        "computed": ["normal motion: Hertz"],
        "left_out": ["books (1 of 2 impacts)"],
        "cautions": ["doubt: one"],
        "psi2_error": [0.1, None],
    }
    assert planned.unchecked.tolist() == [True, False]
    assert plan(unchecked=True).unchecked is True
    assert plan().unchecked is False
