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
def work(monkeypatch):
    """Return a function that does ``count`` things of ``each`` s and returns what is seen."""

    def do(count, each, *, terminal, asked=None, each_time=lambda: None):
        clock = [100.0]
        screen = Screen(terminal=terminal)
        monkeypatch.setattr(sys, "stderr", screen)
        monkeypatch.setattr(sys, "stdout", screen)
        monkeypatch.setattr(module.time, "perf_counter", lambda: clock[0])
        with fitted(), progress(asked, "things") as show:
            for done in range(1, count + 1):
                clock[0] += each
                each_time()
                if show is not None:
                    show(done, count)
        return screen.getvalue()

    return do


@pytest.mark.parametrize("terminal", [True, False])
def test_short_work_says_nothing(work, terminal):
    assert "things" not in work(100, 0.019, terminal=terminal, asked=True)


def test_one_line_on_a_terminal_wiped_out_at_the_end(work):
    seen = work(100, 0.5, terminal=True)
    assert "\n" not in seen
    states = seen.split("\r\x1b[K")
    assert "things: 10 % (10/100), 45 s left" in states
    assert states[-1] == ""
    assert 90 < len(states) < 110
    assert len(work(10_000, 0.001, terminal=True).split("\r\x1b[K")) < 110  # not one an item


def test_what_is_printed_meanwhile_stands_by_itself(work):
    seen = work(10, 1.0, terminal=True, each_time=lambda: print("done"))
    assert "left\r\x1b[Kdone\n" in seen
    assert "leftdone" not in seen


def test_elsewhere_a_line_now_and_then_and_only_when_asked(work):
    assert work(100, 0.5, terminal=False) == ""
    lines = work(100, 0.5, terminal=False, asked=True).splitlines()
    assert lines[0] == "things: 4 % (4/100), 48 s left"
    assert lines[-1] == "things: 100 % (100/100), took 50 s"
    assert len(lines) == 6
    assert work(100, 0.5, terminal=True, asked=False) == ""


@pytest.fixture
def slowly(monkeypatch):
    """Return a function that makes a terminal and a clock; no thread writes to it."""

    def begin():
        clock = [100.0]
        screen = Screen(terminal=True)
        monkeypatch.setattr(sys, "stderr", screen)
        monkeypatch.setattr(module.time, "perf_counter", lambda: clock[0])
        monkeypatch.setattr(module.Progress, "_keep_alive", lambda _: None)
        return screen, clock

    return begin


def test_the_time_left_goes_on_while_one_thing_takes_long(slowly):
    screen, clock = slowly()
    with fitted(), progress(None, "things") as show:
        for passed, done, expected in (
            (1.0, None, ""),
            (5.0, None, "things: 6 s so far"),
            (2.0, 1, "things: 33 % (1/3), 16 s left"),
            (3.0, None, "things: 33 % (1/3), 13 s left"),
            (9.0, None, "things: 33 % (1/3), 8 s left"),  # it takes longer than the first
            (4.0, 2, "things: 66 % (2/3), 12 s left"),
            (13.0, None, "things: 66 % (2/3), 37 s so far"),  # longer than was to be expected
            (4.0, 3, "things: 100 % (3/3), 41 s so far"),
        ):
            clock[0] += passed
            if done is None:
                show._show(clock[0])
            else:
                show(done, 3)
            assert screen.getvalue().rpartition("\r\x1b[K")[2] == expected
    assert screen.getvalue().endswith("\r\x1b[K")


def test_the_line_ends_with_an_interruption(slowly):
    screen, clock = slowly()
    with fitted():
        with contextlib.suppress(KeyboardInterrupt), progress(None, "things") as show:
            clock[0] += 5.0
            show(1, 3)
            raise KeyboardInterrupt
        print("what is done", file=sys.stderr)
    assert screen.getvalue() == "things: 33 % (1/3), 10 s left\r\x1b[Kwhat is done\n"


def test_a_line_that_is_being_printed_is_left_alone(slowly):
    screen, clock = slowly()
    with fitted(), progress(None, "things") as show:
        clock[0] += 5.0
        print("half a", end="", file=sys.stderr)
        show._show(clock[0])
        print(" line", file=sys.stderr)
        assert screen.getvalue() == "half a line\n"


def test_a_thread_keeps_it_alive(monkeypatch):
    screen = Screen(terminal=True)
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(module, "QUIET", 0.0)
    monkeypatch.setattr(module, "ALIVE", 0.001)
    seen = threading.Event()
    monkeypatch.setattr(module.Progress, "_overwrite", lambda _, text: text and seen.set())
    with progress(None, "things"):
        assert seen.wait(60.0)


def test_times():
    assert [in_words(seconds) for seconds in (0.2, 89.0, 600.0, 7200.0)] == [
        "0 s", "89 s", "10 min", "2.0 h",
    ]  # fmt: skip
