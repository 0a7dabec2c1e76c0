"""The line of progress: one line, with time left, and nothing for what is soon done."""

from __future__ import annotations

import contextlib
import io
import itertools
import re
import sys

import numpy as np
import pytest

from contactlab import Scene, Simulation, compare
from contactlab.cli.terminal import fit_terminal
from contactlab.numeric import progress as module
from contactlab.numeric.progress import in_words, progress
from tests.longer import longer
from tests.present import of_commands


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
    with fit_terminal(), progress(True, "things") as show:
        clock[0] += 1.9
        show(100, 100)
    assert screen.getvalue() == ""


@pytest.mark.parametrize(
    ("words", "what", "items"),
    of_commands(
        ("sweep {short} --out o.csv", "impacts", 3),
        ("compare {short}", "runs", 2),
        ("fit {impacts} {ball} --tangential exact,coulomb,walton --bootstrap 0", "laws", 2),
        ("bench --quick --tangential coulomb", "bench", 2),
        ("stability --quick --tangential coulomb", "stability", None),
        *longer(
            ("figures --out . --only 2", "figures", 1),
            ("validate", "checks", None),
        ),
    ),
)
def test_commands_tell_what_is_done(
    run, short_sweep, impacts, ball, tmp_path, monkeypatch, words, what, items
):
    """By a clock that goes on by half a minute whenever somebody looks at it.

    Each line counts one item more, up to the last of those that were asked for.
    """
    clock = itertools.count(0, 30)
    monkeypatch.setattr(module.time, "perf_counter", lambda: next(clock))
    monkeypatch.chdir(tmp_path)
    ran = run(*words.format(short=short_sweep, impacts=impacts, ball=ball).split(), "--progress")
    assert ran.status == 0
    line = rf"^{what}: (\d+) % \((\d+)/(\d+)\), "
    lines = [[*map(int, numbers)] for numbers in re.findall(line, ran.err, flags=re.MULTILINE)]
    shares, counts, (total, *_) = zip(*lines, strict=True)
    assert list(counts) == [*range(counts[0], total), total]
    assert shares == tuple(100 * count // total for count in counts)
    assert items is None or total == items


def test_nothing_is_shown_unasked_elsewhere_and_where_it_is_not_wanted(begin):
    for terminal, wanted in ((False, None), (True, False), (False, False)):
        begin(terminal=terminal)
        with progress(wanted, "things") as show:
            assert show is None


def test_the_line_on_a_terminal_is_overwritten_and_cleared_at_the_end(begin):
    screen, clock = begin(terminal=True)
    with fit_terminal(), progress(None, "things") as show:
        for passed, done in ((1.0, 1), (8.0, 3), (0.4, 4), (0.2, 5), (0.4, 10)):
            clock[0] += passed
            show(done, 10)
    states = ["things: 30 % (3/10), 21 s left", "things: 50 % (5/10), 10 s left", ""]
    assert screen.getvalue().split("\r\x1b[K") == states


def test_elsewhere_there_is_a_line_now_and_then_and_one_at_the_end(begin):
    screen, clock = begin(terminal=False)
    with fit_terminal(), progress(True, "things") as show:
        for done in range(1, 101):
            clock[0] += 0.5
            show(done, 100)
    assert screen.getvalue().splitlines() == [
        "things: 4 % (4/100), 48 s left",
        "things: 24 % (24/100), 38 s left",
        "things: 44 % (44/100), 28 s left",
        "things: 64 % (64/100), 18 s left",
        "things: 84 % (84/100), 8 s left",
        "things: 100 % (100/100), took 50 s",
    ]


def test_the_line_ends_with_an_interruption(begin):
    screen, clock = begin(terminal=True)
    with fit_terminal():
        with contextlib.suppress(KeyboardInterrupt), progress(None, "things") as show:
            clock[0] += 5.0
            show(1, 3)
            raise KeyboardInterrupt
        print("what is done", file=sys.stderr)
    assert screen.getvalue() == "things: 33 % (1/3), 10 s left\r\x1b[Kwhat is done\n"


def test_an_interruption_elsewhere_is_not_called_100_percent(begin):
    screen, clock = begin(terminal=False)
    with fit_terminal(), contextlib.suppress(KeyboardInterrupt), progress(True, "things") as show:
        clock[0] += 5.0
        show(1, 3)
        raise KeyboardInterrupt
    assert screen.getvalue() == "things: 33 % (1/3), 10 s left\n"


def test_a_warning_clears_the_line(begin):
    screen, clock = begin(terminal=True)
    with fit_terminal(), progress(None, "things") as show:
        clock[0] += 5.0
        show(1, 3)
        print("a warning", file=sys.stderr)
    assert screen.getvalue() == "things: 33 % (1/3), 10 s left\r\x1b[Ka warning\n"


def test_times():
    assert [in_words(seconds) for seconds in (0.2, 89.0, 600.0, 7200.0)] == [
        "0 s", "89 s", "10 min", "2.0 h",
    ]  # fmt: skip


class Bar:
    """A bar as tqdm's: it has the count ``n``, and is moved by ``update``."""

    def __init__(self, iterable=None, desc=None):
        self.n = 0

    def update(self, steps):
        self.n += steps


SOME = Scene.nondimensional(psi1=np.linspace(0.1, 4.0, 5), chi=1.44)
LONG = {
    "impacts": lambda progress: Simulation(tangential="coulomb").sweep(SOME, progress=progress),
    "runs": lambda progress: compare(SOME, {"exact": Simulation()}, progress=progress),
}


@pytest.mark.parametrize("what", LONG)
@pytest.mark.parametrize("terminal", [True, False])
def test_true_is_the_line_of_the_command_line(begin, monkeypatch, terminal, what):
    screen, clock = begin(terminal=terminal)
    put = module.Progress.__call__

    def slow(line, done, total):
        clock[0] += 60.0
        put(line, done, total)
        put(line, done, 2 * total)

    monkeypatch.setattr(module.Progress, "__call__", slow)
    LONG[what](True)
    lines = screen.getvalue()
    assert f"{what}: 50 % (" in lines
    assert lines.endswith("\r\x1b[K") if terminal else "took 60 s\n" in lines


@pytest.mark.parametrize("what", LONG)
@pytest.mark.parametrize("progress", [Bar, Bar(), "yes", 1])
def test_a_bar_is_refused_with_lines_that_work(what, progress):
    with pytest.raises(ValueError, match="must be True or a function") as refused:
        LONG[what](progress)
    lines = str(refused.value).split("or: ")[1].replace("progress=", "progress = ")
    made = {"tqdm": Bar}
    exec(lines.replace("; ", "\n"), made)
    LONG[what](made["progress"])
    assert made["bar"].n == (5 if what == "impacts" else 1)
