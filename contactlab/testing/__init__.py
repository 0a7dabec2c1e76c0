"""Small named checks of a law against its contract, for the tests of any plug-in.

In a plug-in's own tests::

    from contactlab.testing import parametrize_with_checks

    @parametrize_with_checks(["tangential.mine"])
    def test_conformance(law, check):
        check(law)

On the command line: ``contactlab plugins check tangential.mine``.

A law that cannot pass a check by its nature names the check, with the reason::

    expected_failures: ClassVar[Mapping[str, str]] = {
        "cattaneo_mindlin": "one spring for the whole contact: it sticks or slips as one",
    }
"""

import importlib

from contactlab.testing.check import CHECKS, Check, CheckFailedError
from contactlab.testing.outcomes import (
    ConformanceError,
    Outcome,
    Verdict,
    check_law,
    checks_for,
    examine,
    outcome,
)
from contactlab.testing.parametrize import parametrize_with_checks

#: Modules with checks, in the order in which the checks run. Importing a module enters its checks.
ORDER = (
    "every_law", "normal", "normal_contact", "normal_motions", "motion", "stepping", "friction",
    "stiffness", "energy", "memory", "coulomb_at_a_point", "impacts", "whole_impacts", "coulomb",
    "unlike_bodies", "vectors", "normal_spin", "rigid_bodies", "integrators", "integrator_faults",
    "accuracy", "declared_errors", "declarations",
)  # fmt: skip
for _module in ORDER:
    importlib.import_module(f"contactlab.testing.{_module}")

__all__ = [
    "CHECKS",
    "Check",
    "CheckFailedError",
    "ConformanceError",
    "Outcome",
    "Verdict",
    "check_law",
    "checks_for",
    "examine",
    "outcome",
    "parametrize_with_checks",
]
