"""Cases of a table that run among the longer tests."""

import pytest


def longer(*cases):
    """Return cases, values or tuples of values, as parameters of the longer tests."""
    many = (case if isinstance(case, tuple) else (case,) for case in cases)
    return [pytest.param(*case, marks=pytest.mark.slow) for case in many]
