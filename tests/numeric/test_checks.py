"""What checked numbers and words take, and what they refuse."""

import numpy as np
import pytest

import contactlab
from contactlab.numeric import checks


@pytest.mark.parametrize("value", [1, 7, np.int64(7), np.array(3)])
def test_whole_numbers_within_their_bounds(value):
    assert checks.whole("steps", value, most=7) == int(value)


@pytest.mark.parametrize("value", [0, 8, 2.0, "3", True, None, np.array([3])])
def test_other_numbers_are_refused(value):
    with pytest.raises(ValueError, match=r"steps = .*must be a whole number from 1 to 7"):
        checks.whole("steps", value, most=7)


def test_the_bounds_of_an_option_belong_to_it():
    for steps in (1, 2_000_000):
        assert contactlab.create("integrator.paper", steps=steps).steps == steps
    with pytest.raises(ValueError, match="from 1 to 2000000"):
        contactlab.create("integrator.paper", steps=2_000_001)


@pytest.mark.parametrize("word", ["middle", "MEAN", "", 5, None, ["mean"]])
def test_a_word_that_is_no_choice_is_refused(word):
    with pytest.raises(ValueError, match=r"displacement = .*must be one of 'm"):
        contactlab.create("tangential.annulus", displacement=word)


def test_what_is_shown_of_an_answer_is_one_short_line():
    assert checks.shown("x" * 78) == repr("x" * 78)
    assert checks.shown("x" * 79) == "'" + "x" * 76 + "..."
    assert checks.shown(np.zeros((3, 3))).count("\n") == 0
    assert len(checks.shown(np.zeros(100))) == 80
