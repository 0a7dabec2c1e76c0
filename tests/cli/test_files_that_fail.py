"""What a command says of a file is true: on a full disk, without permission, after Ctrl-C."""

import os
import signal

import numpy as np
import pytest

from contactlab.outcome import files
from tests.cli.conftest import EXAMPLES, partial
from tests.full_disk import full_disk
from tests.longer import longer
from tests.present import of_commands

SWEEP = ("sweep", "--psi1", "0:9:3000", "--chi", "1.4412", "--tangential", "linear_spring")
FULL = "No space left on device"
#: A law whose user presses Ctrl-C in the third block of a sweep.
STOPPING = """
import signal
import attrs
import numpy as np
from contactlab_laws.linear_spring import LinearSpring

@attrs.frozen(kw_only=True)
class Stopping(LinearSpring):
    def whole_impacts(self, scene, normal):
        if np.min(scene.psi1) > 6.0:
            signal.raise_signal(signal.SIGINT)
        return super().whole_impacts(scene, normal)
"""


@pytest.fixture
def stopping(tmp_path):
    path = tmp_path / "law.py"
    path.write_text(STOPPING, encoding="utf-8")
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job ignores it
    yield ("--tangential", f"{path}:Stopping")
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("suffix", ["npz", *longer("csv", "json")])
def test_a_sweep_whose_file_fails_prints_every_impact(run, tmp_path, monkeypatch, suffix):
    full_disk(monkeypatch)
    out = tmp_path / f"a.{suffix}"
    ran = run(*SWEEP, "--out", out)
    assert ran.status == 1
    assert len(ran.out.splitlines()) == 2 + 3000 + 1
    assert ran.out.endswith(f"all 3000 impacts; {out} is not written\n")
    assert FULL in ran.err
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_loses_its_permission(run, tmp_path, monkeypatch):
    """It may be written into when the command begins."""
    access, asked = os.access, []

    def lost(path, mode):
        asked.append(path)
        return len(asked) < 2 and access(path, mode)

    monkeypatch.setattr(files.os, "access", lost)
    ran = run("sweep", "--psi1", "0:7:30", "--chi", "1", "--out", tmp_path / "a.csv")
    assert ran.status == 1
    assert ran.out.endswith(f"all 30 impacts; {tmp_path / 'a.csv'} is not written\n")
    assert f"nothing can be written in the folder {tmp_path}" in ran.err


def test_a_kept_sweep_whose_file_fails_goes_on_from_its_folder(run, tmp_path, monkeypatch):
    out, folder = tmp_path / "a.npz", tmp_path / "a.npz.kept"
    with monkeypatch.context() as patched:
        full_disk(patched, after=4)
        ran = run(*SWEEP, "--out", out, "--resume")
    assert ran.status == 1
    assert ran.err.splitlines()[-1] == (
        f"contactlab sweep: 3000 impacts are kept in {folder}; repeat the command to continue"
    )
    ran = run(*SWEEP, "--out", out, "--resume")
    assert (ran.status, ran.err) == (0, "contactlab sweep: 3000 impacts were done before\n")
    assert list(tmp_path.iterdir()) == [out]


def test_a_sweep_that_cannot_be_kept_says_what_is(run, tmp_path, monkeypatch):
    out, folder = tmp_path / "a.npz", tmp_path / "a.npz.kept"
    with monkeypatch.context() as patched:
        full_disk(patched, after=2)
        ran = run(*SWEEP, "--out", out, "--resume")
    assert (ran.status, ran.out) == (1, "")
    (line,) = ran.err.splitlines()
    assert FULL in line
    assert line.endswith(f"{folder} holds 1000 of 3000 impacts; the same sweep goes on from them")
    assert run(*SWEEP, "--out", out, "--resume").err.startswith("contactlab sweep: 1000 impacts")


def test_after_ctrl_c_the_partial_file_is_named(run, tmp_path, stopping):
    out = tmp_path / "a.npz"
    ran = run(*SWEEP[:-2], *stopping, "--out", out)
    assert ran.status == 130
    assert ran.out.endswith(f"25 of 3000 impacts; the 2000 finished ones are in {partial(out)}\n")
    assert not out.exists()
    with np.load(partial(out)) as content:
        assert np.isfinite(content["psi2"]).sum() == 2000


def test_after_ctrl_c_on_a_full_disk_nothing_is_said_to_be_written(
    run, tmp_path, stopping, monkeypatch
):
    out = tmp_path / "a.npz"
    full_disk(monkeypatch)
    ran = run(*SWEEP[:-2], *stopping, "--out", out)
    assert ran.status == 130
    assert ran.out.endswith(f"all 3000 impacts; {out} is not written\n")
    assert "what is done" not in ran.err


def test_ctrl_c_while_files_are_written_keeps_the_answers(run, tmp_path, monkeypatch):
    full_disk(monkeypatch, error=KeyboardInterrupt())
    out, picture = tmp_path / "a.csv", tmp_path / "a.png"
    ran = run("sweep", "--psi1", "0:7:30", "--chi", "1", "--out", out, "--figure", picture)
    assert ran.status == 130
    assert ran.out.endswith(f"all 30 impacts; {out} is not written\n")
    assert ran.err.splitlines() == [
        f"contactlab: interrupted: {path} is not written" for path in (out, picture)
    ]
    assert list(tmp_path.iterdir()) == []


KHARAZ = EXAMPLES / "kharaz2001.toml"


@pytest.mark.parametrize(
    "words",
    of_commands(
        ("run", "--psi1", 1, "--chi", 1, "--out", "a.csv"),
        ("run", "--psi1", 1, "--chi", 1, "--history", "a.csv", "--figure", "a.png"),
        ("sweep", "--psi1", "0:1:3", "--chi", 1, "--csv", "--figure", "a.pdf"),
        ("compare", "--psi1", 1, "--chi", 1, "--figure", "a.svg"),
        ("bench", "--quick", "--tangential", "coulomb", "--out", "a.csv"),
        ("explore", "--out", "a.html"),
        ("kernel", "--out", "."),
        *longer(
            (("report", EXAMPLES / "steel_ball.toml", "--out", "a.html"),),
            (("fit", KHARAZ, "--bootstrap", 0, "--residuals", "a.csv"),),
            (("stability", "--quick", "--tangential", "walton", "--out", "a.csv"),),
            (("figures", "--only", 2, "--tangential", "coulomb", "--out", "."),),
            (("animate", "--psi1", 1, "--chi", 1, "--out", "a.gif"),),
        ),
    ),
)
def test_no_command_says_that_a_file_is_written_which_is_not(run, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    full_disk(monkeypatch)
    ran = run(*words)
    assert ran.status == 1
    names = [word for word in words if str(word).startswith("a.")] or ["."]
    for name in names:
        assert name not in ran.out.split()
        assert f"{name}" in ran.err
    assert FULL in ran.err
    assert "None" not in ran.err
    assert list(tmp_path.iterdir()) == []


def test_a_folder_of_pictures_that_cannot_be_made_is_refused_before_the_checks(run, tmp_path):
    """After minutes of checks it took their findings with it."""
    (tmp_path / "pictures").write_text("a file")
    for name, words in (("pictures", "is a file"), ("p" * 300, "cannot make the folder")):
        ran = run("validate", "--out", tmp_path / name)
        assert (ran.status, ran.out) == (2, "")
        assert words in ran.err
