"""The progress line by a clock that is set by hand."""

from __future__ import annotations

import pytest

from contactlab.cli.progress import Progress, in_words


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.4, "0 s"),
        (89.9, "90 s"),
        (90.0, "2 min"),
        (100.0, "2 min"),
        (89.4 * 60.0, "89 min"),
        (90.0 * 60.0, "1.5 h"),
        (9000.0, "2.5 h"),
    ],
)
def test_times_in_words(seconds, words):
    assert in_words(seconds) == words


def test_the_progress_line_waits_two_seconds_and_then_ten(monkeypatch, capsys):
    clock = [100.0]
    monkeypatch.setattr("contactlab.cli.progress.time.perf_counter", lambda: clock[0])
    line = Progress("runs", terminal=False)

    def at(seconds, done):
        clock[0] = 100.0 + seconds
        line(done, 8)
        return capsys.readouterr().err

    assert at(1.9, 1) == ""
    assert at(2.0, 0) == ""
    assert at(4.0, 2) == "runs: 25 % (2/8), 12 s left\n"
    assert at(13.9, 3) == ""
    assert at(14.0, 3) == "runs: 37 % (3/8), 23 s left\n"
    assert at(40.0, 8) == ""
    line.__exit__(None, None, None)
    assert capsys.readouterr().err == "runs: 100 % (8/8), took 40 s\n"


@pytest.mark.parametrize(
    ("seconds", "kind", "counted", "words"),
    [
        (1.9, None, True, ""),
        (2.0, None, True, "runs: 50 % (1/2), took 2 s\n"),
        (5.0, ValueError, True, ""),
        (5.0, None, False, ""),
    ],
)
def test_short_or_failed_work_ends_without_a_line(
    seconds, kind, counted, words, monkeypatch, capsys
):
    clock = [0.0]
    monkeypatch.setattr("contactlab.cli.progress.time.perf_counter", lambda: clock[0])
    line = Progress("runs", terminal=False)
    if counted:
        line(1, 2)
    clock[0] = seconds
    line.__exit__(kind, None, None)
    assert capsys.readouterr().err == words


def test_on_a_terminal_one_line_is_overwritten_twice_a_second(monkeypatch):
    clock, shown = [0.0], []

    class Terminal:
        overwrite = staticmethod(shown.append)

    monkeypatch.setattr("contactlab.cli.progress.time.perf_counter", lambda: clock[0])
    monkeypatch.setattr("contactlab.cli.progress.sys.stderr", Terminal())
    line = Progress("runs", terminal=True)
    for clock[0] in (1.0, 2.0, 2.4, 2.5):
        line(1, 2)
    line.__exit__(None, None, None)
    assert shown == ["runs: 50 % (1/2), 2 s left", "runs: 50 % (1/2), 2 s left", ""]
