"""The checks as parametrised tests of pytest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from contactlab.contracts import Law
from contactlab.testing.outcomes import applies, checks_for, expects_to_fail, make_law

if TYPE_CHECKING:
    import pytest


def parametrize_with_checks(laws: Sequence[Law | str]) -> pytest.MarkDecorator:
    """Return a decorator that runs a test once for every check of every law.

    Expected failures are marked as strict ``xfail``: an unexpected pass fails the test.

    Parameters
    ----------
    laws : sequence of Law or str
        Laws, or names of installed laws.

    Examples
    --------
    >>> @parametrize_with_checks(["tangential.coulomb"])
    ... def test_conformance(law, check):
    ...     check(law)
    """
    import pytest  # the kit needs pytest only here

    parameters = []
    for law_or_name in laws:
        law = make_law(law_or_name)
        name = law_or_name if isinstance(law_or_name, str) else type(law).__name__
        for check in checks_for(law):
            if not applies(law, check):
                continue
            reason = expects_to_fail(law).get(check.name)
            marks = []
            if reason is not None:
                marks = [pytest.mark.xfail(reason=reason, strict=True)]
            parameters.append(pytest.param(law, check, id=f"{name}-{check.name}", marks=marks))
    return pytest.mark.parametrize(("law", "check"), parameters)
