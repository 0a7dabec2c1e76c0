"""Every installed law keeps its contract, or says which part it does not keep, and why."""

import pytest

from contactlab.registry import REGISTRY
from contactlab.testing import parametrize_with_checks

#: Smaller than the defaults, for speed; as fine as the checks' tolerances need.
OPTIONS = {
    "tangential.annulus": {"annuli": 40},
    "tangential.sharp_annulus": {"annuli": 30},
    "tangential.springs": {"springs": 30},
}
NAMES = REGISTRY.names()
LAWS = [REGISTRY.create(name, **OPTIONS.get(name, {})) for name in NAMES]


@parametrize_with_checks(LAWS)
def test_conformance(law, check):
    check(law)


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_a_law_that_claims_partial_slip_expects_no_failure(law):
    if "partial_slip" in law.offers:
        assert not law.expected_failures
