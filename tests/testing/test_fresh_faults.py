"""Forty fresh faults: ``test_kit_bites`` holds that a sentence of the kit names each."""

import pytest

from contactlab.testing import examine
from tests.testing.fresh_faults import FAULTS
from tests.testing.fresh_sound import SOUND


@pytest.mark.slow
@pytest.mark.parametrize("law", [law() for law in SOUND], ids=repr)
def test_the_laws_that_the_faults_are_put_into_are_sound(law):
    bad = [(found.check, found.sentence) for found in examine(law) if not found.verdict.good]
    assert bad == []


def test_there_are_forty():
    assert len({fault for fault, _, _ in FAULTS}) == len(FAULTS) == 40
