"""The time limit of a check, by a clock and an alarm of the test."""

import sys
import threading
from types import SimpleNamespace

import pytest

from contactlab.testing import limits
from contactlab.testing.limits import OutOfTimeError, limited

BEGUN, COMPUTED = 1000.0, 50.0


class Alarm:
    """Stands for the modules ``signal`` and ``time``."""

    SIGALRM, ITIMER_REAL = 14, 0

    def __init__(self):
        self.passed = self.used = 0.0
        self.timers = []
        self.handler = "the one before"

    def monotonic(self):
        return BEGUN + self.passed

    def process_time(self):
        return COMPUTED + self.used

    def signal(self, number, handler):
        assert number == self.SIGALRM
        before, self.handler = self.handler, handler
        return before

    def setitimer(self, which, *seconds):
        assert which == self.ITIMER_REAL
        self.timers.append(seconds)

    def ring(self, *, used, passed=0.0, frame=None):
        """Ring after ``used`` seconds of computing and ``passed`` seconds in all."""
        self.used, self.passed = used, passed
        self.handler(self.SIGALRM, frame)


@pytest.fixture
def alarm(monkeypatch):
    made = Alarm()
    monkeypatch.setattr(limits, "signal", made)
    monkeypatch.setattr(limits, "time", made)
    return made


@pytest.mark.parametrize(("used", "passed"), [(0.0, 0.0), (9.99, 99.9), (0.0, 99.9)])
def test_before_either_limit_nothing_happens(alarm, used, passed):
    with limited("grows", None, 10.0):
        alarm.ring(used=used, passed=passed)


@pytest.mark.parametrize(
    ("used", "passed", "words"),
    [
        (10.0, 10.0, "10 s of computing, its limit"),
        (10.5, 300.0, "10 s of computing, its limit"),
        (2.0, 100.0, "100 s, 2 s of them computing"),
        (0.125, 123.456, "123.5 s, 0.12 s of them computing"),
    ],
)
def test_a_check_is_stopped_at_either_limit(alarm, used, passed, words):
    with pytest.raises(OutOfTimeError) as stopped, limited("grows", None, 10.0):
        alarm.ring(used=used, passed=passed)
    told = f"The check grows was stopped after {words}: the law hangs, or crawls."
    assert str(stopped.value) == told


def test_the_alarm_rings_again_and_is_put_back(alarm):
    with limited("grows", None, 7.0):
        assert alarm.timers == [(7.0, 1.0)]
        stop = alarm.handler
        assert stop != "the one before"
    assert alarm.timers == [(7.0, 1.0), (0.0,)]
    assert alarm.handler == "the one before"
    alarm.used = 99.0
    stop(14, None)  # a late alarm stops nobody


def test_the_alarm_is_put_back_after_an_error(alarm):
    with pytest.raises(KeyError), limited("grows", None):
        raise KeyError
    assert alarm.timers == [(60.0, 1.0), (0.0,)]
    assert alarm.handler == "the one before"


def test_there_is_no_limit_in_another_thread(alarm):
    def body():
        with limited("grows", None, 1.0):
            seen.append(list(alarm.timers))

    seen = []
    limits.begin("something before")
    thread = threading.Thread(target=body)
    thread.start()
    thread.join()
    assert seen == [[]]
    assert (alarm.handler, alarm.timers) == ("the one before", [])
    assert limits.DOING.what == ""


def test_there_is_no_limit_without_the_alarm(alarm, monkeypatch):
    monkeypatch.setattr(limits, "signal", SimpleNamespace())
    with limited("grows", None, 1.0):
        pass
    assert alarm.timers == []


class Waits:
    """A law whose method asks a function, which asks another."""

    def force(self):
        return _deeper()


def _deeper():
    self = object()  # of no interest
    return sys._getframe(), self


def steps_of(alarm, law, steps, frame):
    """Take steps of a path, and be stopped there."""
    with limited("grows", law, 1.0):
        limits.begin("a path of 3 steps")
        for _ in range(steps):
            limits.DOING.steps += 1
        alarm.ring(used=1.0, frame=frame)


LAW = Waits()
LINE = Waits.force.__code__.co_firstlineno + 1


@pytest.mark.parametrize(
    ("law", "steps", "place"),
    [
        (LAW, 2, f" at step 2, in Waits.force, line {LINE}"),
        (Waits(), 0, f", in Waits.force, line {LINE}"),  # a copy of the law counts too
        ("another law", 1, " at step 1"),
    ],
)
def test_the_place_is_the_innermost_line_of_the_law(alarm, law, steps, place):
    with pytest.raises(OutOfTimeError) as stopped:
        steps_of(alarm, law, steps, _linked(LAW))
    assert str(stopped.value) == (
        "The check grows was stopped after 1 s of computing, its limit, in a path of 3 steps"
        f"{place}: the law hangs, or crawls."
    )


def _linked(law):
    """Return frames of a call from the law, as an alarm finds them."""
    inner, _ = law.force()
    code = Waits.force.__code__
    method = SimpleNamespace(
        f_locals={"self": law}, f_code=code, f_lineno=code.co_firstlineno + 1, f_back=None
    )
    return SimpleNamespace(
        f_locals=inner.f_locals, f_code=inner.f_code, f_lineno=inner.f_lineno, f_back=method
    )


def test_what_is_done_begins_without_steps():
    limits.begin("a path")
    limits.DOING.steps += 5
    limits.begin("another path")
    assert (limits.DOING.what, limits.DOING.steps) == ("another path", 0)
