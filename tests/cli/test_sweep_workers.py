"""`contactlab sweep` on workers, and gone on with after it was killed."""

import signal
import subprocess
import sys

import numpy as np
import pytest

from contactlab.runs import pieces

SWEEP = ("sweep", "--psi1", "0:9:3000", "--chi", "1.4412", "--tangential", "linear_spring")


def test_workers_print_what_one_process_prints(run):
    sweep = ("sweep", "--psi1", "0:9:30", "--chi", "1:2:2", "--tangential", "springs", "--csv")
    alone, shared = run(*sweep), run(*sweep, "--workers", "2")
    assert (alone.status, alone.err) == (0, "")
    assert shared == alone
    assert alone.out.splitlines()[0] == "psi1 (1),chi (1),psi2 (1),status"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--workers", "0"), "workers = 0: must be a whole number from 1"),
        (("--workers", "two"), "--workers"),
        (("--resume",), "--resume: needs --out FILE"),
    ],
)
def test_bad_arguments_are_one_line_and_status_2(run, arguments, words):
    ran = run("sweep", "--psi1", "0:9:3", "--chi", "1", *arguments)
    assert (ran.status, ran.out) == (2, "")
    assert len(ran.err.splitlines()) == 1
    assert words in ran.err


#: The command line, killed in the middle of the file of the second of three chunks.
KILLED = """
import os, signal, sys
import numpy as np
from contactlab.cli.main import main
write, calls = np.savez, []

def savez(stream, **arrays):
    calls.append(None)
    if len(calls) == 2:
        stream.write(b"PK")
        stream.flush()
        os.kill(os.getpid(), signal.SIGKILL)
    write(stream, **arrays)

np.savez = savez
main(sys.argv[1:])
"""


@pytest.mark.parametrize("workers", [(), pytest.param(("--workers", "2"), marks=pytest.mark.slow)])
@pytest.mark.slow
def test_killed_and_resumed_it_writes_the_same_file(run, tmp_path, workers):
    whole, killed, kept = tmp_path / "a.npz", tmp_path / "b.npz", tmp_path / "b.npz.kept"
    assert run(*SWEEP, "--out", whole).status == 0
    command = [sys.executable, "-c", KILLED, *SWEEP, "--out", killed, "--resume", *workers]
    assert subprocess.run(command, check=False).returncode == -signal.SIGKILL
    names = sorted(path.name for path in kept.iterdir())
    assert [name.partition("-")[0] for name in names] == [".contactlab", "impacts", "sweep.json"]
    assert not killed.exists()
    ran = run(*SWEEP, "--tangential", "coulomb", "--out", killed, "--resume")
    assert ran.status == 2
    assert "holds another sweep: tangential was linear_spring" in ran.err
    assert sorted(path.name for path in kept.iterdir()) == names
    ran = run(*SWEEP, "--out", killed, "--resume", "--workers", "2")
    assert (ran.status, ran.err) == (0, "contactlab sweep: 1000 impacts were done before\n")
    assert killed.read_bytes() == whole.read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.npz", "b.npz"]


def test_interrupted_it_keeps_what_is_done(run, monkeypatch, tmp_path):
    outcome, calls = pieces.outcome, []

    def interrupted(*arguments, **keywords):
        calls.append(None)
        if len(calls) == 2:
            raise KeyboardInterrupt
        return outcome(*arguments, **keywords)

    monkeypatch.setattr(pieces, "outcome", interrupted)
    out = tmp_path / "a.npz"
    out.write_text("earlier")
    ran = run(*SWEEP, "--out", out, "--resume")
    assert (ran.status, out.read_text()) == (130, "earlier")
    assert "what is done is in" in ran.err
    with np.load(tmp_path / "a.partial.npz") as content:
        assert np.isfinite(content["psi2"]).sum() == 1000
    assert len(list((tmp_path / "a.npz.kept").glob("*.npz"))) == 1
    again = run(*SWEEP, "--out", out, "--resume")
    assert again.status == 0
    assert "a.partial.npz is left from an interrupted run" in again.err
    assert len(calls) == 5  # the block that is kept was computed again, to compare
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.npz", "a.partial.npz"]
