"""The command itself: version, help, exit statuses, streams."""

from __future__ import annotations

import importlib
import os
import signal
import subprocess
import sys

import pytest

import contactlab
from contactlab.cli import main as module
from contactlab.cli import run as run_command
from contactlab.registration.manager import commands
from contactlab.runs.sweep import MARCHED as CHUNK

COMMANDS = commands("contactlab")
COMMAND = [sys.executable, "-m", "contactlab"]
PSI = ["run", "--psi1", "6", "--chi", "1", "--tangential", "coulomb"]


def test_version(run):
    assert run("--version") == (0, contactlab.__version__ + "\n", "")


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_every_command_has_examples(run, command):
    ran = run(command, "--help")
    assert ran.status == 0
    assert "examples:" in ran.out
    assert f"contactlab {command}" in ran.out


def test_only_the_subcommand_that_is_named_is_imported():
    """Nor is a law, scipy or matplotlib for the list of laws, the guide or the help of all."""
    probe = (
        "import sys; from contactlab.cli.main import main\n"
        "for words in (['--version'], ['plugins', 'list'], ['guide', 'theory'], ['--help']):\n"
        "    main(words)\n"
        "    print('modules:', *sys.modules)"
    )
    command = [sys.executable, "-X", "utf8", "-c", probe]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=True)
    told = [line.split() for line in done.stdout.splitlines() if line.startswith("modules:")]
    imported = (set(), {"plugins"}, {"plugins", "guide"}, {"plugins", "guide"})
    for names, needed in zip(told, imported, strict=True):
        commands = {name.rpartition(".")[2] for name in names if name.startswith("contactlab.cli.")}
        assert commands & COMMANDS.keys() == needed
        heavy = [name for name in names if name.partition(".")[0] in ("scipy", "matplotlib")]
        assert heavy + [name for name in names if name.startswith("contactlab_")] == []


def test_help_lists_every_command_with_its_summary(run):
    for words in (["--help"], ["-h"], ["--traceback", "-h"]):
        out = " ".join(run(*words).out.split())
        for command in COMMANDS:
            imported = importlib.import_module(COMMANDS[command].module)
            summary = " ".join(imported.__doc__.partition("\n\n")[0].split())
            assert f"{command} {summary}" in out


def test_traceback_on_request(run):
    plain, full = run("run", "nowhere.toml"), run("--traceback", "run", "nowhere.toml")
    assert "Traceback" not in plain.err
    assert "Traceback" in full.err
    assert full.status == 2


def test_bug_is_not_hidden(run, monkeypatch):
    def fail(_):
        raise ZeroDivisionError

    monkeypatch.setattr(run_command, "execute", fail)
    with pytest.raises(ZeroDivisionError):
        run(*PSI)


@pytest.mark.skipif(os.name == "nt", reason="POSIX pipes")
def test_reader_that_has_gone_is_no_error():
    read, write = os.pipe()
    os.close(read)
    buffered = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    done = subprocess.run(
        [*COMMAND, *PSI], stdout=write, stderr=subprocess.PIPE, env=buffered, check=False
    )
    os.close(write)
    assert done.returncode == module.BROKEN_PIPE
    assert done.stderr == b""


@pytest.mark.skipif(os.name == "nt", reason="POSIX signals")
def test_interrupted_sweep_reports_what_is_done(tmp_path):
    path = tmp_path / "long.toml"
    path.write_text(
        "[nondimensional]\nchi = 1\n[sweep]\npsi1 = {start = 0, stop = 3, count = 2000}\n"
        "[simulation]\ntangential = 'linear_spring'\nintegrator = 'symplectic'\n",
        encoding="utf-8",
    )
    # It waits for the signal after its first line, however fast it is.
    talkative = (
        "import signal, sys; from contactlab.cli import main; "
        "from contactlab.numeric import progress; progress.QUIET = 1e6; "
        "usual = progress.Progress.__call__; progress.Progress.__call__ = "
        "lambda self, *counts: usual(self, *counts) or self._what == 'impacts' and "
        "(self._put(self._share), signal.pause()); "
    )
    command = [sys.executable, "-c", talkative + "sys.exit(main.main())", "run", path,
               "--progress", "--out", tmp_path / "part.npz", "--json"]  # fmt: skip
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Tests that run in the background may be told to ignore the signal.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as running:
        first = running.stderr.readline()
        running.send_signal(signal.SIGINT)
        out, err = running.communicate()
    assert first == f"impacts: 50 % ({CHUNK}/2000)\n"
    assert running.returncode == module.INTERRUPTED
    assert "interrupted" in err.splitlines()[-1]
    assert '"SUCCESS"' in out
    assert '"INTERRUPTED"' in out
    assert (tmp_path / "part.partial.npz").exists()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["runn"], "did you mean 'run'?"),
        (["plugins", "lst"], "did you mean 'list'?"),
        (["run", "--psi", "1", "--chi", "1"], "contactlab run: error: unrecognized"),
        (["sweep", "--psi1", "0:1:3", "--chi", "1", "--csv", "out.csv"], "--out"),
        (["figures", "--out", __file__], "is a file; give a folder"),
        (["figures"], "the following arguments are required: --out"),
        (["plugins"], "the following arguments are required: list|show|check"),
    ],
)
def test_slips_of_the_pen(words, told, run):
    ran = run(*words)
    assert ran.status == module.BAD_INPUT
    assert told in ran.err


def test_installed_command_runs():
    done = subprocess.run([*COMMAND, *PSI, "--json"], capture_output=True, text=True, check=False)
    assert done.returncode == 0
    assert '"psi2": 2.0' in done.stdout
