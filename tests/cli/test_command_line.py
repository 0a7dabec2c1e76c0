"""The command line itself: warnings, streams, errors, and words that are no options."""

from __future__ import annotations

import warnings

import pytest

import contactlab
from contactlab import cli
from contactlab.cli import main as module
from contactlab.cli import run as run_command
from contactlab.contracts.status import Status
from contactlab.registry.registry import PluginWarning


class Another(Warning):
    """A warning that is not about plug-ins."""


def test_other_warnings_are_shown_as_ever(run, monkeypatch, capsys):
    shown = []

    def warn(_):
        warnings.warn("of a plug-in", PluginWarning, stacklevel=2)
        warnings.warn("of a plug-in", PluginWarning, stacklevel=2)
        warnings.warn("another", Another, stacklevel=2)
        return 0

    monkeypatch.setattr(run_command, "execute", warn)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", Another)
        warnings.showwarning = lambda message, category, *_: shown.append((str(message), category))
        before = warnings.showwarning
        ran = run("run")
        assert warnings.showwarning is before
    assert ran.err == "contactlab: warning: of a plug-in\n"  # once
    assert shown == [("another", Another)]


@pytest.mark.parametrize(
    ("error", "status", "words"),
    [
        (ValueError("a\n  b"), 2, "contactlab run: error: a b"),
        (ValueError(), 2, "contactlab run: error: ValueError"),
        (OSError("full"), 1, "contactlab run: error: full"),
        (PermissionError(13, "no", "o.csv"), 1,
         "contactlab run: error: o.csv: cannot be read or written: no"),
        (contactlab.PluginError("broken"), 1, "contactlab run: error: broken"),
        (contactlab.ImpactError("x", Status.INTERRUPTED), 130, "contactlab run: error: x"),
        (contactlab.ImpactError("x", Status.NON_FINITE), 1, "contactlab run: error: x"),
        (KeyboardInterrupt(), 130, "contactlab: interrupted"),
    ],
)  # fmt: skip
def test_an_error_is_one_line(run, monkeypatch, error, status, words):
    def fail(_):
        raise error

    monkeypatch.setattr(run_command, "execute", fail)
    assert run("run") == (status, "", f"{words}\n")


def test_a_command_that_is_not_there(run):
    ran = run("rnu")
    assert (ran.status, ran.out) == (2, "")
    assert ran.err.startswith("contactlab: error: no command 'rnu'; ")
    assert ran.err.endswith("; did you mean 'run'? (see contactlab --help)\n")
    assert "did you mean" not in run("zzzzz").err
    assert run().status == 2
    told = "contactlab run: error: unrecognized arguments: --x=3 (see contactlab run --help)\n"
    assert run("run", "--x=3", "--psi1", 1, "--chi", 1).err == told


def test_exit_statuses_are_those_of_a_shell():
    found = (cli.OK, cli.FAILED, cli.BAD_INPUT, cli.INTERRUPTED,
             cli.BROKEN_PIPE)  # fmt: skip
    assert found == (0, 1, 2, 128 + 2, 128 + 13)  # of SIGINT and of SIGPIPE


def test_a_reader_that_has_gone_is_told_by_the_status(run, monkeypatch):
    def gone(_):
        raise BrokenPipeError

    left = []
    monkeypatch.setattr(run_command, "execute", gone)
    monkeypatch.setattr(module, "_leave_stdout", lambda: left.append(1))
    assert run("run") == (141, "", "")
    assert left == [1]


@pytest.mark.parametrize(("error", "times"), [(OSError("full"), 1), (ValueError("bad"), 0)])
def test_after_an_error_of_the_system_stdout_may_not_be_flushed(run, monkeypatch, error, times):
    def fail(_):
        raise error

    left = []
    monkeypatch.setattr(run_command, "execute", fail)
    monkeypatch.setattr(module, "_leave_stdout", lambda: left.append(1))
    run("run")
    assert len(left) == times
