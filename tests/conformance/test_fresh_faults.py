"""Forty fresh faults: the kit catches each by a sentence that names it."""

import numpy as np
import pytest

from contactlab.testing import Verdict, checks_for, examine, outcome
from tests.conformance.fresh_faults import FAULTS
from tests.conformance.fresh_sound import SOUND

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("law", [law() for law in SOUND], ids=repr)
def test_the_laws_that_the_faults_are_put_into_are_sound(law):
    bad = [(found.check, found.sentence) for found in examine(law) if not found.verdict.good]
    assert bad == []


@pytest.mark.parametrize(
    ("fault", "name", "words"), FAULTS, ids=[fault.__name__ for fault, _, _ in FAULTS]
)
def test_a_fault_is_caught_by_a_sentence_that_names_it(fault, name, words):
    np.random.seed(1)  # noqa: NPY002 one of the faults draws from the global generator
    law = fault()
    check = next(check for check in checks_for(law) if check.name == name)
    found = outcome(law, check)
    assert found.verdict is Verdict.FAILED, found
    assert words in found.sentence


def test_there_are_forty():
    assert len({fault for fault, _, _ in FAULTS}) == len(FAULTS) == 40
