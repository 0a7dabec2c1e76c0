"""Refusals of the commands in full, and the words that they read."""

from __future__ import annotations

import argparse
from pathlib import Path

import pytest

from contactlab.cli import arguments as shared


def test_a_file_has_one_of_the_suffixes_and_a_folder(tmp_path):
    convert = shared.file_of(".png", ".pdf")
    assert convert(str(tmp_path / "a.PDF")) == tmp_path / "a.PDF"
    with pytest.raises(argparse.ArgumentTypeError, match=r"^'a\.gif': must end in \.png or \.pdf$"):
        convert("a.gif")
    with pytest.raises(argparse.ArgumentTypeError, match=r"^'no/such/a\.png': there is no folder"):
        convert("no/such/a.png")


def test_every_file_is_written_though_one_fails(tmp_path, capsys):
    done = []

    def full(_):
        raise OSError("no space")

    one, two, three = (tmp_path / name for name in "abc")
    status = shared.save((one, full), (None, full), (two, done.append), (three, done.append),
                         progress_wanted=False)  # fmt: skip
    assert (status, done) == (shared.FAILED, [two, three])
    assert capsys.readouterr().err == (
        f"contactlab: error: {tmp_path / 'a'} is not written: no space\n"
    )
    assert shared.save((one, done.append), progress_wanted=False) == shared.OK
    assert shared.save((None, full), progress_wanted=False) == shared.OK


BOTH = "--psi1, --chi: {sweep} is a scene already; leave out the file, or both"
SPHERE = "must be given (chi is 1.4412 for a solid sphere, nu = 0.3)"
MISSING = "must be given too (chi is 1.4412 for a solid sphere)"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["run"], f"a scene file, or --psi1 and --chi: {SPHERE}"),
        (["run", "--psi1", 1], f"--chi: {SPHERE}"),
        (["run", "--chi", 1], f"--psi1: {SPHERE}"),
        (["run", "SWEEP", "--psi1", 1], BOTH),
        (["run", "SWEEP", "--chi", 1], BOTH),
        (["run", "SWEEP", "--history", "h.csv"],
         "--history: needs a single impact, this scene is a sweep; leave out --history"),
        (["run", "SWEEP", "--stick-slip", "h.png"],
         "--stick-slip: needs a single impact, this scene is a sweep; leave out --stick-slip"),
        (["animate", "SWEEP", "--out", "a.gif"],
         "scene: must be a single impact, not a sweep; leave out [sweep]"),
        (["sweep"], "--psi1 and --chi: must be given, or a sweep file"),
        (["sweep", "--psi1", "0:1:2"], "--chi: must be given, or a sweep file"),
        (["sweep", "--chi", 1], "--psi1: must be given, or a sweep file"),
        (["sweep", "SWEEP", "--chi", 1], BOTH),
        (["sweep", "--psi1", "0:1:1001", "--chi", "1:2:1000"],
         "--psi1, --chi = 1001000: at most 1000000 impacts; contactlab sweep "
         "--out folder/ holds more"),
        (["sweep", "--psi1", "0:1:2", "--chi", 1, "--resume"],
         "--resume: needs --out FILE; finished impacts are kept beside this file"),
        (["sweep", "BALL"], "{ball}: holds a single impact; use contactlab run"),
        (["sweep", "BALL", "--out", "new/"], "{ball}: holds a single impact; use contactlab run"),
        (["compare", "--psi1", 1], f"--chi: {MISSING}"),
        (["compare", "--chi", 1], f"--psi1: {MISSING}"),
        (["compare", "SWEEP", "--chi", 1], BOTH),
        (["compare", "--psi1", "0:1:2", "--chi", "1:2:2"],
         "--psi1, --chi: only one may be a range; give one number for the other"),
        (["compare", "SWEEP", "--all", "--tangential", "coulomb"], "ALL"),
        (["compare", "SWEEP", "--all", "--integrator", "paper"], "ALL"),
        (["compare", "SWEEP", "--all", "--normal", "hertz,jkr"], "ALL"),
        (["compare", "SWEEP", "--all", "--set", "tangential.annuli=3"], "--set tangential.annuli: "
         "with --all name one law, such as --set integrator.symplectic.steps=400"),
        (["compare", "SWEEP", "--tangential", "coulomb", "--set", "tangential.annuli=5"], "--set "
         "tangential.annuli: no chosen law has this option; known: none"),
        (["compare", "SWEEP", "--tangential", "annulus", "--set", "tangential.anuli=5"], "--set "
         "tangential.anuli: no chosen law has this option; did you mean "
         "'tangential.annuli'? known: tangential.annuli, tangential.displacement"),
        (["run", "BALL", "--restitution", "big"], "argument --restitution: 'big' is not a number; "
         "write e as in 0.9, '1 - 0.02 v^(1/5)' or 0.5:0.95,2:0.9 (see contactlab run --help)"),
        (["stability", "--restitution", "1:0.9,2:0.8"], "argument --restitution: '1:0.9,2:0.8' is "
         "not a number; write one for all scenes, as 0.9 (see contactlab stability --help)"),
        (["validate", "--out", "no/such/dir"],
         "--out no/such/dir: there is no folder no/such"),
        (["guide", "qqq"], None),
        (["guide", "theory", "99"], "section = '99': is not a section of 'theory'; leave it out "
         "for the whole topic"),
        (["kernel", "--out", "FILE"], "argument --out: '{file}': is a file; give a folder "
         "(see contactlab kernel --help)"),
        (["run", "BALL", "other.toml"], "unrecognized arguments: other.toml; one scene at a time; "
         "give each a command of its own (see contactlab run --help)"),
        (["sweep", "SWEEP", "--workers", "two"], "argument --workers: 'two' is not a whole number "
         "(see contactlab sweep --help)"),
        (["figures", "--out", "all.png"], "argument --out: 'all.png': is the name of a file; give "
         "a folder (see contactlab figures --help)"),
        (["kernel", "--out", ""], "argument --out: '': is no name; give a folder "
         "(see contactlab kernel --help)"),
    ],
)  # fmt: skip
def test_a_refusal_is_one_line(run, short_sweep, ball, tmp_path, monkeypatch, words, told):
    monkeypatch.chdir(tmp_path)
    file = Path("x")
    file.write_text("", encoding="utf-8")
    places = {"SWEEP": short_sweep, "BALL": ball, "FILE": file}
    ran = run(*(places.get(word, word) for word in words))
    assert (ran.status, ran.out) == (2, "")
    head = f"contactlab {words[0]}: error: "
    if told is None:
        assert ran.err.startswith(f"{head}topic = 'qqq': is not in the guide; known: getting-sta")
    elif told == "ALL":
        assert ran.err == (
            f"{head}--all runs every tangential law with its own integrator; leave out "
            "--tangential and --integrator, and name at most one normal law\n"
        )
    else:
        assert ran.err == f"{head}{told.format(ball=ball, file=file, sweep=short_sweep)}\n"


@pytest.mark.parametrize(("count", "shown"), [(25, 25), (26, 25), (3, 3)])
def test_a_file_of_more_than_25_impacts_is_told(run, tmp_path, count, shown):
    out = tmp_path / "a.csv"
    ran = run("sweep", "--psi1", f"0:7:{count}", "--chi", 1, "--tangential", "coulomb",
              "--out", out)  # fmt: skip
    more = [f"25 of 26 impacts; all of them are in {out}"] if count > 25 else []
    assert ran.out.splitlines()[shown + 2 :] == more
    swept = tmp_path / "s.toml"
    swept.write_text(f"[nondimensional]\nchi = 1\n[sweep]\npsi1 = {{start = 0, stop = 7, count = "
                     f"{count}}}\n", encoding="utf-8")  # fmt: skip
    ran = run("sweep", swept, "--tangential", "coulomb", "--out", out)
    assert ran.out.splitlines()[shown + 2 :] == more
