"""``contactlab run``: answers, files, and refusals."""

from __future__ import annotations

import csv
import itertools
import json
import time

import numpy as np
import pytest

from contactlab import rebound
from contactlab.numeric import progress
from tests.full_disk import full_disk

RIGID = ("--tangential", "coulomb", "--integrator", "symplectic")
PSI = ("--psi1", "6", "--chi", "1", *RIGID)


def table(path):
    return list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))


def test_json_has_the_promised_keys_and_the_right_answer(run):
    ran = run("run", *PSI, "--json")
    content = json.loads(ran.out)
    assert ran.status == 0
    assert ran.err == ""
    assert {"psi2", "status", "run_time_s", "energy", "plan"} <= set(content)
    assert content["psi2"] == pytest.approx(2.0, abs=1e-12)
    assert content["status"] == "SUCCESS"
    assert content["run_time_s"] > 0.0
    assert abs(content["energy"]["relative_imbalance"]) < 1e-12
    assert content["plan"]["left_out"]


def test_json_of_the_elastic_law(run):
    content = json.loads(run("run", "--psi1", "1.2", "--chi", "1.4411764706", "--json").out)
    assert content["psi2"] == pytest.approx(-0.1805194095, abs=0.01)


def test_negative_numbers_are_numbers(run):
    content = json.loads(run("run", "--psi1", "-6e0", "--chi", "1", *RIGID, "--json").out)
    assert content["psi2"] == pytest.approx(-2.0, abs=1e-12)


def test_table_says_it_in_words(run, ball):
    ran = run("run", ball, *RIGID)
    assert ran.status == 0
    for words in ("A steel ball", "m/s", "rad/s", "local angle psi", "friction work", "left out:",
                  "run time", "success", "coulomb",
                  "largest normal force"):  # fmt: skip
        assert words in ran.out


@pytest.mark.parametrize(
    ("tick", "words"), [(2.5, "2.5 s"), (1e-3, "1 ms"), (4e-6, "4 µs"), (3e-8, "30 ns")]
)
def test_the_run_time_is_told_in_the_unit_that_suits(run, monkeypatch, tick, words):
    clock = itertools.count()
    monkeypatch.setattr(time, "perf_counter", lambda: next(clock) * tick)
    (line,) = (
        line
        for line in run("run", *PSI, "--no-estimate-error").out.splitlines()
        if "run time" in line
    )
    assert line.split(maxsplit=2)[2] == words


def test_table_of_a_nondimensional_scene_claims_no_units(run):
    out = run("run", *PSI).out
    assert "m/s" not in out
    assert " J" not in out
    assert " N" not in out


def test_nobody_is_told_to_estimate_what_was_estimated(run):
    """The plan said how to estimate the error, below the estimate."""
    scene = ("run", "--psi1", "2", "--chi", "1.44", "--tangential", "mindlin_cap")
    for words, advised in ((scene, False), ((*scene, "--no-estimate-error"), True)):
        out = run(*words).out
        assert ("estimates the error" in out) is advised
        assert (", estimated" in out) is not advised
        assert "computed: numerical error of psi2: the laws state no bound" in out


def test_options_reach_the_laws(run):
    laws = ("--tangential", "springs", "--integrator", "symplectic")
    content = json.loads(run("run", "--psi1", "1", "--chi", "1", *laws, "--json",
                             "--set", "integrator.steps=123").out)  # fmt: skip
    assert content["counters"]["steps"] == 123
    told = run("run", "--psi1", "1", "--chi", "1", *laws, "--set", "integrator.steps=123").out
    assert "123 steps" in told


def test_laws_on_the_command_line_replace_those_of_the_file(run, ball, tmp_path):
    """The file's options are for its own law, annulus, and must not reach another."""
    laws = (
        "[simulation]\ntangential = 'annulus'\nintegrator = 'symplectic'\n"
        "[simulation.options]\ntangential.annuli = 50\nintegrator.steps = 400\n"
    )
    file = tmp_path / "own_laws.toml"
    file.write_text(f"{ball.read_text('utf-8')}\n{laws}", encoding="utf-8")
    content = json.loads(run("run", file, "--tangential", "springs", "--json").out)
    assert content["laws"]["tangential"].startswith("springs")
    assert content["counters"]["steps"] == 400


def test_full_names_of_laws_serve_too(run):
    assert run("run", "--psi1", "6", "--chi", "1", "--tangential", "tangential.coulomb").status == 0


def test_sweep(run, short_sweep):
    ran = run("run", short_sweep, "--json")
    content = json.loads(ran.out)
    assert content["psi2"] == pytest.approx([0.0, 0.0, 2.0], abs=1e-9)
    assert content["varied"] == {"psi1": [0.0, 2.0, 6.0]}
    table = run("run", short_sweep).out
    assert "SUCCESS" in table
    assert "psi2 (1)" not in table  # a number without a unit has none in its heading


def test_progress_is_on_stderr_and_only_when_asked(run, short_sweep, monkeypatch):
    monkeypatch.setattr(progress, "QUIET", 0.0)
    quiet = run("run", short_sweep, "--json")
    shown = run("run", short_sweep, "--json", "--progress")
    assert quiet.err == ""
    assert "3/3" in shown.err
    json.loads(shown.out)


def test_out_files(run, short_sweep, tmp_path):
    for suffix in (".json", ".csv", ".npz"):
        assert run("run", short_sweep, "--out", tmp_path / f"out{suffix}").status == 0
    rows = table(tmp_path / "out.csv")
    assert [float(row["psi2 (1)"]) for row in rows] == pytest.approx([0.0, 0.0, 2.0], abs=1e-9)
    assert json.loads((tmp_path / "out.json").read_text())["psi2"][2] == pytest.approx(2.0)
    with np.load(tmp_path / "out.npz") as arrays:
        assert arrays["psi2"][2] == pytest.approx(2.0)


def test_history_file(run, tmp_path):
    assert run("run", *PSI, "--history", tmp_path / "h.csv").status == 0
    rows = table(tmp_path / "h.csv")
    force = np.array([float(row["tangential_force (1)"]) for row in rows])
    normal = np.array([float(row["normal_force (1)"]) for row in rows])
    assert len(rows) > 100
    assert force == pytest.approx(normal, rel=1e-9, abs=1e-12)  # mu = 1, slips throughout


def test_a_huge_angle_is_refused(run):
    """Its square is beyond a float: the energies are not defined."""
    ran = run("run", "--psi1", "1e300", "--chi", "1", "--json")
    assert ran.status == 2
    assert "kinetic energy" in ran.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "--psi1"),
        (("--psi1", "1"), "--chi"),
        (("--chi", "1"), "--psi1"),
        (("--psi1", "nan", "--chi", "1"), "finite"),
        (("--psi1", "inf", "--chi", "1"), "finite"),
        (("--psi1", "-inf", "--chi", "1"), "finite"),
        (("--psi1", "one", "--chi", "1"), "not a number"),
        (("--psi1", "1", "--chi", "-1"), "chi = -1.0: must be positive"),
        (("--psi1", "1", "--chi", "0"), "positive"),
        (("nowhere.toml",), "no such file"),
        ((*PSI, "--tangential", "columb"), "did you mean 'coulomb'"),
        ((*PSI, "--normal", "herz"), "did you mean 'hertz'"),
        ((*PSI, "--integrator", "papers"), "did you mean 'paper'"),
        ((*PSI, "--set", "integrator.stepz=3"), "stepz"),
        ((*PSI, "--set", "integrator.steps=nan"), "whole number"),
        ((*PSI, "--set", "integrator.steps=0"), "whole number"),
        ((*PSI, "--set", "integrator.steps=many"), "whole number"),
        ((*PSI, "--set", "steps=3"), "tangential.annuli = 50"),
        ((*PSI, "--set", "tangential.anulus.annuli=9"), "did you mean 'annulus'"),
        ((*PSI, "--set", "tangential.annulus.anuli=9"), "did you mean 'annuli'"),
        ((*PSI, "--set", "tangential.annulus.annuli=-5"), "annuli = -5"),
        ((*PSI, "--set", "intgrator.steps=3"), "did you mean 'integrator'"),
        ((*PSI, "--set", "integrator.steps"), "tangential.annuli=50"),
        ((*PSI, "--out", "result.xlsx"), ".json"),
        ((*PSI, "--out", "no/such/folder/result.csv"), "no folder"),
        ((*PSI, "--history", "history.json"), ".csv"),
        ((*PSI, "--colour"), "--colour"),
        ((*PSI, "--tangental", "springs"), "did you mean '--tangential'"),
        (("--psi", "1", "--chi", "1"), "did you mean '--psi1'"),
        ((*PSI, "--output", "x.csv"), "did you mean '--out'"),
        ((*PSI, "--tangential", "springs", "--set", "springs=8"), "mean 'tangential.springs'"),
    ],
)
def test_bad_input_is_one_line_and_status_2(run, arguments, words):
    ran = run("run", *arguments)
    assert ran.status == 2
    assert ran.out == ""
    assert len(ran.err.splitlines()) == 1
    assert ran.err.startswith("contactlab")
    assert words in ran.err


@pytest.mark.parametrize(
    "numbers", [("--psi1", "1", "--chi", "1"), ("--psi1", "1"), ("--chi", "1")]
)
def test_file_and_numbers_do_not_mix(run, ball, numbers):
    ran = run("run", ball, *numbers)
    assert (ran.status, ran.out) == (2, "")
    assert "--psi1, --chi: " in ran.err


def test_history_of_a_sweep_is_refused_before_it_runs(run, short_sweep, tmp_path):
    ran = run("run", short_sweep, "--history", tmp_path / "h.csv")
    assert ran.status == 2
    assert "single impact" in ran.err
    assert not (tmp_path / "h.csv").exists()


def test_failed_run_still_reports_and_has_status_1(run):
    ran = run("run", "--psi1", "1", "--chi", "1000", "--tangential", "annulus", "--json",
              "--set", "integrator.steps=5", "--set", "integrator.refine=false")  # fmt: skip
    assert ran.status == 1
    assert json.loads(ran.out)["status"] == "TOO_FEW_STEPS"
    assert json.loads(ran.out)["psi2"] is None
    assert ran.err.startswith("contactlab: failed:")
    assert len(ran.err.splitlines()) == 1


def test_two_outputs_that_are_one_file_are_refused_before_the_run(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ran = run("run", *PSI, "--out", "a.csv", "--history", "./a.csv")
    assert ran.status == 2
    assert "--out, --history" in ran.err
    assert list(tmp_path.iterdir()) == []
    scene = tmp_path / "scene.csv"
    scene.write_text("[nondimensional]\npsi1 = 6\nchi = 1\n")
    assert run("run", scene, "--out", scene).status == 2
    assert scene.read_text().startswith("[nondimensional]")


@pytest.mark.parametrize("command", ["run", "sweep"])
def test_a_file_that_cannot_be_written_does_not_take_the_answer_with_it(
    run, tmp_path, monkeypatch, command
):
    full_disk(monkeypatch)
    psi1 = "6" if command == "run" else "6:7:2"
    words = ("--psi1", psi1, "--chi", "1", *RIGID, "--json", "--out", tmp_path / "a.csv")
    ran = run(command, *words)
    assert ran.status == 1
    assert np.ravel(json.loads(ran.out)["psi2"])[0] == pytest.approx(2.0)
    assert len(ran.err.splitlines()) == 1
    assert "No space left" in ran.err


VECTORS = """
[sphere]
radius = 0.01
material = {young_modulus = 208e9, poisson_ratio = 0.3, density = 7850}
[target]
kind = "sphere"
radius = 0.02
material = {young_modulus = 208e9, poisson_ratio = 0.3, density = 7850}
[impact]
friction_coefficient = 0.2
normal = [0, 0, -1]
velocity = [3, 4, -1]
spin = [0, 0, 7]
"""


def test_vectors_of_both_bodies(run, tmp_path):
    """Slip throughout: the impulse is that of mu (1 + e) M_n v1 against the slip."""
    path, out = tmp_path / "vectors.toml", tmp_path / "vectors.csv"
    path.write_text(VECTORS)
    ran = run("run", path, "--out", out)
    assert ran.status == 0
    assert "target velocity" in ran.out
    assert "spin about the normal" in ran.out
    found = json.loads(run("run", path, "--json").out)["collision"]
    one = 7850.0 * 4.0 / 3.0 * np.pi * 0.01**3
    impulse = 2.0 * one * 8.0 / 9.0
    assert found["impulse"] == pytest.approx([-0.12 * impulse, -0.16 * impulse, impulse])
    pushed = np.array(found["impulse"]) / (-8.0 * one)
    assert found["target_velocity"] == pytest.approx(pushed.tolist())
    assert found["spin"][2] == 7.0
    (row,) = table(out)
    assert float(row["target_rebound_normal_velocity (m/s)"]) == pytest.approx(-pushed[2])
    assert float(row["target_rebound_tangential_velocity (m/s)"]) == pytest.approx(
        np.hypot(*pushed[:2])
    )
    assert float(row["target_rebound_spin (rad/s)"]) < 0.0


def test_ranges_run_as_a_sweep(run):
    """As ``contactlab.rebound`` answers."""
    ran = run("run", "--psi1", "0:7:8", "--chi", 1.44, "--csv")
    assert ran.status == 0
    rows = list(csv.DictReader(ran.out.splitlines()))
    assert [float(row["psi1 (1)"]) for row in rows] == [*range(8)]
    psi2 = [float(row["psi2 (1)"]) for row in rows]
    assert psi2 == pytest.approx(rebound(np.arange(8.0), 1.44), abs=1e-7)
    assert "psi1" in run("run", "--psi1", "0:7:8", "--chi", 1.44).out.splitlines()[0]


def test_of_bodies_velocity_and_spin_come_first_and_psi2_last(run, ball):
    out = run("run", ball).out
    order = [out.index(words) for words in ("normal velocity", "spin", "energy", "\npsi2 ")]
    assert order == sorted(order)
    assert run("run", "--psi1", 1.2, "--chi", 1.44).out.startswith("psi2 ")
