"""Cases of a table that run among the longer tests."""

import pytest


def longer(*cases):
    """Return cases, values or tuples of values, as parameters of the longer tests."""
    slow = pytest.mark.slow
    return [pytest.param(*(c if isinstance(c, tuple) else (c,)), marks=slow) for c in cases]
