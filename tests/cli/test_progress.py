"""The line of progress: one line, with time left, and nothing for what is soon done."""

from __future__ import annotations

import contextlib
import io
import sys
import threading

import pytest

from contactlab.cli import progress as module
from contactlab.cli.progress import in_words, progress
from contactlab.cli.terminal import fitted


class Screen(io.StringIO):
    """A terminal, or a file, that keeps what is written to it."""

    encoding = "ascii"

    def __init__(self, *, terminal):
        super().__init__()
        self._terminal = terminal

    def isatty(self):
        return self._terminal


@pytest.fixture
def begin(monkeypatch):
    """Return a function that makes a terminal, or a file, and a clock that stands."""

    def screen_and_clock(*, terminal):
        clock = [100.0]
        screen = Screen(terminal=terminal)
        monkeypatch.setattr(sys, "stderr", screen)
        monkeypatch.setattr(sys, "stdout", screen)
        monkeypatch.setattr(module.time, "perf_counter", lambda: clock[0])
        return screen, clock

    return screen_and_clock


@pytest.mark.parametrize("terminal", [True, False])
def test_short_work_says_nothing(begin, terminal):
    screen, clock = begin(terminal=terminal)
    with fitted(), progress(True, "things") as show:
        clock[0] += 1.9
        show(100, 100)
    assert screen.getvalue() == ""


def test_nothing_is_shown_unasked_elsewhere_and_where_it_is_not_wanted(begin):
    for terminal, wanted in ((False, None), (True, False), (False, False)):
        begin(terminal=terminal)
        with progress(wanted, "things") as show:
            assert show is None


def test_the_time_left_goes_on_while_one_thing_takes_long(begin):
    _, clock = begin(terminal=True)
    with progress(None, "things") as show:
        for passed, done, expected in (
            (6.0, None, "things: 6 s so far"),
            (2.0, 1, "things: 33 % (1/3), 16 s left"),
            (3.0, None, "things: 33 % (1/3), 13 s left"),
            (9.0, None, "things: 33 % (1/3), 8 s left"),  # it takes longer than the first
            (4.0, 2, "things: 66 % (2/3), 12 s left"),
            (13.0, None, "things: 66 % (2/3), 37 s so far"),  # longer than was to be expected
            (4.0, 3, "things: 100 % (3/3), 41 s so far"),
        ):
            clock[0] += passed
            if done is not None:
                show(done, 3)
            assert show.line() == expected


@pytest.fixture
def shown(monkeypatch):
    """Return an event that is set whenever the thread has shown a state; none of it waits."""
    event = threading.Event()
    put = module.Progress._put

    def tell(self, text):
        put(self, text)
        if text:
            event.set()

    monkeypatch.setattr(module.Progress, "_put", tell)
    for name in ("QUIET", "OFTEN", "SELDOM"):
        monkeypatch.setattr(module, name, 0.001)
    return event


def wait_for(event):
    event.clear()
    assert event.wait(60.0)


def test_one_line_on_a_terminal_wiped_out_at_the_end(begin, shown):
    screen, clock = begin(terminal=True)
    with fitted(), progress(None, "things") as show:
        clock[0] += 5.0
        show(1, 3)
        wait_for(shown)
        wait_for(shown)
        print("done")
        wait_for(shown)
    states = screen.getvalue().split("\r\x1b[K")
    assert states[-1] == ""
    assert set(states) <= {"", *PLAIN, *(f"done\n{text}" for text in PLAIN)}
    assert any(state.startswith("done\n") for state in states)


#: States of the line of one thing of three, done after 5 s; before it was done too.
PLAIN = ("things: 33 % (1/3), 10 s left", "things: 0 s so far", "things: 5 s so far")


def test_elsewhere_a_line_now_and_then_and_one_at_the_end(begin, shown):
    screen, clock = begin(terminal=False)
    with fitted(), progress(True, "things") as show:
        clock[0] += 5.0
        show(1, 3)
        wait_for(shown)
        wait_for(shown)
        show(3, 3)
    lines = screen.getvalue().splitlines()
    assert PLAIN[0] in lines
    assert lines[-1] == "things: 100 % (3/3), took 5 s"


def test_the_line_ends_with_an_interruption(begin, shown):
    screen, clock = begin(terminal=True)
    with fitted():
        with contextlib.suppress(KeyboardInterrupt), progress(None, "things") as show:
            clock[0] += 5.0
            show(1, 3)
            wait_for(shown)
            raise KeyboardInterrupt
        print("what is done", file=sys.stderr)
    assert screen.getvalue().endswith("left\r\x1b[Kwhat is done\n")


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_line_that_is_being_printed_is_left_alone(begin, stream):
    screen, _ = begin(terminal=True)
    with fitted():
        printed = getattr(sys, stream)
        print("half a", end="", file=printed)
        sys.stderr.overwrite("10 %")
        print(" line", file=printed)
        assert screen.getvalue() == "half a line\n"
        sys.stderr.overwrite("20 %")
        sys.stderr.overwrite("30 %")
        print("next", file=printed)
    assert screen.getvalue() == "half a line\n20 %\r\x1b[K30 %\r\x1b[Knext\n"


def test_times():
    assert [in_words(seconds) for seconds in (0.2, 89.0, 600.0, 7200.0)] == [
        "0 s", "89 s", "10 min", "2.0 h",
    ]  # fmt: skip
