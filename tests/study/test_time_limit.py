"""A time limit stops what has begun, also what swallows the first exception."""

import math
import signal
import time

import pytest

from contactlab.study.time_limit import TimeLimitError, end_of, in_time

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGALRM"), reason="needs SIGALRM")


def forever():
    while True:
        time.sleep(0.01)


def stubborn():
    try:
        forever()
    except KeyboardInterrupt:
        return "as if nothing were wrong"


@pytest.mark.parametrize("run", [forever, stubborn])
def test_what_has_begun_is_stopped(run):
    before = signal.getsignal(signal.SIGALRM)
    with pytest.raises(TimeLimitError):
        in_time(run, end_of(0.05))
    assert signal.getsignal(signal.SIGALRM) == before
    assert signal.getitimer(signal.ITIMER_REAL)[0] == 0.0


def test_what_ends_in_time_is_returned_and_nothing_begins_too_late():
    assert in_time(lambda: 3, end_of(60.0)) == in_time(lambda: 3, end_of(None)) == 3
    assert end_of(None) == math.inf
    with pytest.raises(TimeLimitError):
        in_time(lambda: 3, time.perf_counter())
