"""The checks as pytest's own parametrised tests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from contactlab.contracts import Law
from contactlab.testing.outcomes import checks_for, claimed, expected, made_law


def parametrize_with_checks(laws: Sequence[Law | str]) -> Any:
    """Return a decorator that runs a test once for every check of every law.

    Expected failures are marked ``xfail``, strictly: passing one fails the test.

    Parameters
    ----------
    laws : sequence of Law or str
        Objects, or names of installed laws.

    Examples
    --------
    >>> @parametrize_with_checks(["tangential.coulomb"])
    ... def test_conformance(law, check):
    ...     check(law)
    """
    import pytest  # the only place where the kit needs it

    parameters = []
    for given in laws:
        law = made_law(given)
        name = given if isinstance(given, str) else type(law).__name__
        for check in checks_for(law):
            if not claimed(law, check):
                continue
            reason = expected(law).get(check.name)
            marks = []
            if reason is not None:
                marks = [pytest.mark.xfail(reason=reason, strict=True)]
            parameters.append(pytest.param(law, check, id=f"{name}-{check.name}", marks=marks))
    return pytest.mark.parametrize(("law", "check"), parameters)
