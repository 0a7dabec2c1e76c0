"""Laws under comparison run once: their least time of several runs is asserted by nobody."""

import pytest


@pytest.fixture(autouse=True, scope="session")
def timed_once():
    """Take every run for a long one, which is not repeated."""
    from contactlab.study import comparison

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(comparison, "LONG_RUN", 0.0)
        yield
