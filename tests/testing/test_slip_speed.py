"""The word ``slip_speed``: the checks of Coulomb's limit and of memory at one slip speed."""

import pytest

from contactlab.testing.outcomes import Verdict, checks_for, examine, outcome
from tests.testing.slip_laws import Constant, Forgets, OfLoad, Stribeck, Twice, Untold

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
