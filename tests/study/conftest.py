"""Studies compare laws, each of which runs once."""

from tests.timed_once import timed_once  # noqa: F401
