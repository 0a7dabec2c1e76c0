"""`contactlab sweep`."""

import contextlib
import json

import numpy as np
import pytest

from contactlab import SweepFolder
from contactlab.impact.hertz import rigid_body_rebound

LAWS = ("--tangential", "coulomb", "--integrator", "symplectic")


def test_ranges_make_every_combination_psi1_fastest(run):
    ran = run("sweep", "--psi1", "0:8:5", "--chi", "1:2:2", *LAWS, "--csv")
    rows = [line.split(",") for line in ran.out.splitlines()[1:]]
    assert ran.status == 0
    assert [(float(row[0]), float(row[1])) for row in rows] == [
        (psi1, chi) for chi in (1.0, 2.0) for psi1 in (0.0, 2.0, 4.0, 6.0, 8.0)
    ]
    psi1, chi, psi2 = np.array([row[:3] for row in rows], dtype=float).T
    assert psi2 == pytest.approx(rigid_body_rebound(psi1, chi), abs=1e-12)


def test_json_and_file(run, tmp_path):
    ran = run(
        "sweep", "--psi1", "-3:3:4", "--chi", "1.44", *LAWS, "--json", "--out", tmp_path / "a.npz"
    )
    assert len(json.loads(ran.out)["psi2"]) == 4
    with np.load(tmp_path / "a.npz") as content:
        assert content["psi1"].tolist() == [-3.0, -1.0, 1.0, 3.0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--psi1", "0:1:3"), "--chi"),
        (("--psi1", "0:1", "--chi", "1"), "START:STOP:COUNT"),
        (("--psi1", "0:1:x", "--chi", "1"), "whole number"),
        (("--psi1", "0:1:0", "--chi", "1"), "COUNT"),
        (("--psi1", "0:5:1", "--chi", "1"), "COUNT must be at least 2"),
        (("--psi1", "0:nan:3", "--chi", "1"), "finite"),
        (("--psi1", "0:1:1000000", "--chi", "1:2:1000000"), "at most 1000000"),
        (("--psi1", "0:1:3", "--chi", "-1"), "chi"),
        (("nowhere.toml",), "no such file"),
    ],
)
def test_bad_ranges_are_one_line_and_status_2(run, arguments, words):
    ran = run("sweep", *arguments)
    assert ran.status == 2
    assert len(ran.err.splitlines()) == 1
    assert words in ran.err


def test_of_many_impacts_in_a_file_some_are_printed(run, tmp_path):
    ran = run("sweep", "--psi1", "0:8:401", "--chi", "1", *LAWS, "--out", tmp_path / "a.csv")
    *lines, last = ran.out.splitlines()
    shown = [float(line.split()[0]) for line in lines[2:]]
    assert (shown[0], shown[-1], len(shown)) == (0.0, 8.0, 25)
    assert last == f"25 of 401 impacts; all of them are in {tmp_path / 'a.csv'}"
    assert len((tmp_path / "a.csv").read_text("utf-8").splitlines()) == 402
    assert len(run("sweep", "--psi1", "0:8:401", "--chi", "1", *LAWS).out.splitlines()) == 403


def test_the_table_of_a_file_has_what_it_varies(run, tmp_path):
    path = tmp_path / "drops.toml"
    path.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[target]\nkind = 'half-space'\n"
        "material = 'steel'\n[impact]\nspeed = 2.0\nfriction_coefficient = 0.1\n"
        "[sweep]\nangle_deg = [60.0, 70.0]\n",
        encoding="utf-8",
    )
    rows = run("sweep", path, *LAWS).out.splitlines()[-2:]
    for row, angle in zip(rows, (60.0, 70.0), strict=True):
        first, *_, along = map(float, row.split()[:5])  # angle, psi1, psi2, e_n, e_t
        assert first == angle
        assert along == pytest.approx(1.0 - 0.2 / np.tan(np.radians(angle)), rel=1e-5)


def test_a_folder_holds_the_columns_and_goes_on(run, tmp_path, monkeypatch):
    command = ("sweep", "--psi1", "0:8:40", "--chi", "1:2:10", *LAWS, "--out", f"{tmp_path}/swept/")
    ran = run(*command)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith(f"SweepFolder('{tmp_path}/swept'; 400 impacts; 400 SUCCESS)\n")
    folder = SweepFolder(tmp_path / "swept").check()
    psi2 = rigid_body_rebound(folder["psi1"], folder["chi"])
    assert folder["psi2"] == pytest.approx(psi2, abs=1e-12)
    assert folder["psi1"][:40].tolist() == np.linspace(0.0, 8.0, 40).tolist()
    (path,) = (tmp_path / "swept").glob("impacts-*.npz")
    before = path.stat().st_mtime_ns
    assert run(*command[:-1], tmp_path / "swept", "--workers", "2").status == 0
    assert path.stat().st_mtime_ns == before
    ran = run("sweep", "--psi1", "0:8:41", *command[3:])
    assert ran.status == 2
    assert "another" in ran.err


def test_a_file_may_be_swept_into_a_folder(run, tmp_path):
    path = tmp_path / "drops.toml"
    path.write_text(
        "[nondimensional]\nchi = 1.4\npsi1 = 1.0\n[sweep]\npsi1 = [1.0, 2.0, 3.0]\n",
        encoding="utf-8",
    )
    assert run("sweep", path, *LAWS, "--out", f"{tmp_path}/swept/").status == 0
    assert SweepFolder(tmp_path / "swept").check()["psi1"].tolist() == [1.0, 2.0, 3.0]


def test_failures_in_a_folder_are_status_1(run, tmp_path):
    few = ("--set", "integrator.steps=5", "--set", "integrator.refine=false")
    laws = ("--tangential", "springs", "--integrator", "symplectic", *few)
    ran = run("sweep", "--psi1", "0:8:40", "--chi", "1.4", *laws, "--out", f"{tmp_path}/swept/")
    assert ran.status == 1
    assert "failed (impact" in ran.out
    assert ran.err.startswith("contactlab: failed: ")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--json", "--out", "{}/swept/"), "--json: needs all impacts in memory"),
        (("--csv", "--out", "{}/swept/"), "--csv: needs"),
        (("--figure", "{}/a.png", "--out", "{}/swept/"), "--figure: needs"),
        (("--out", "{}/swept.npz/"), "must not end as a file"),
        (("--out", "{}/none/swept/"), "there is no folder"),
        (("--out", "{}/swept"), "name a folder, {}/swept/"),
    ],
)
def test_what_a_folder_cannot_be_is_one_line_and_status_2(run, tmp_path, arguments, words):
    each = [str(part).replace("{}", str(tmp_path)) for part in arguments]
    ran = run("sweep", "--psi1", "0:8:40", "--chi", "1.4", *LAWS, *each)
    assert ran.status == 2
    assert len(ran.err.splitlines()) == 1
    assert words.replace("{}", str(tmp_path)) in ran.err
    assert not (tmp_path / "swept").exists()


def test_an_interrupted_folder_says_how_to_go_on(run, tmp_path, monkeypatch):
    from contactlab.cli import arguments as shared  # the line of progress counts chunks

    @contextlib.contextmanager
    def interrupting(wanted, what):
        def stop(done, total):
            raise KeyboardInterrupt

        yield stop

    monkeypatch.setattr(shared, "progress", interrupting)
    command = ("sweep", "--psi1", "0:8:1000", "--chi", "1:2:200", *LAWS, "--out", f"{tmp_path}/s/")
    ran = run(*command)
    assert ran.status == 130
    assert "not complete: it stopped after impact 131071; the same sweep" in ran.out
    monkeypatch.undo()
    assert run(*command).status == 0
    assert len(SweepFolder(tmp_path / "s").check()) == 200_000
