"""``contactlab figures``: the paper's figures as PNG and CSV."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

from contactlab import Simulation, create
from contactlab.study import paper_figures
from contactlab.study.paper_figures import (
    figure_1,
    figure_2,
    figure_3,
    figure_4,
)

FEW = (
    "--set",
    "tangential.annuli=10",
    "--integrator",
    "symplectic",
    "--set",
    "integrator.steps=60",
)


@pytest.fixture(scope="module")
def simulation():
    return Simulation(
        tangential=create("tangential.annulus", annuli=20),
        integrator=create("integrator.symplectic", steps=150),
    )


@pytest.mark.slow
def test_every_figure_as_png_and_csv(run, tmp_path, monkeypatch):
    monkeypatch.setattr(paper_figures, "FIGURE_4_CHI", paper_figures.FIGURE_4_CHI[::4])
    ran = run("figures", "--out", tmp_path / "new" / "folder", *FEW)
    assert ran.status == 0
    assert len(ran.out.splitlines()) == 12
    assert "Figure 2. Local angle of reflexion" in ran.out
    for number in paper_figures.paper_data():
        picture = tmp_path / "new" / "folder" / f"figure-{number}.png"
        assert picture.read_bytes().startswith(b"\x89PNG")
        text = picture.with_suffix(".csv").read_text(encoding="utf-8")
        rows = list(csv.DictReader(text.splitlines()))
        assert len(rows) > 100
        assert "nan" not in text
        assert all(np.isfinite(float(list(row.values())[-1])) for row in rows)


def test_every_drawing_has_its_numbers():
    from contactlab.figures import paper

    drawn = {name for name in vars(paper) if name.startswith("figure_")}
    assert drawn == {f"figure_{number}" for number in paper_figures.paper_data()}


def test_only_some(run, tmp_path):
    assert run("figures", "--out", tmp_path, "--only", "2", *FEW).status == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["figure-2.csv", "figure-2.png"]


@pytest.mark.parametrize("only", ["5", "0", "two", ""])
def test_unknown_figure_is_refused(run, tmp_path, only):
    ran = run("figures", "--out", tmp_path, "--only", only)
    assert ran.status == 2
    assert "1, 2, 3, 4" in ran.err


def test_folder_must_be_named(run):
    assert "--out" in run("figures").err


def test_figure_1_forces_stay_inside_the_friction_limit(simulation):
    data = figure_1(simulation)
    normal, *tangential = data.curves
    assert normal.y.max() == pytest.approx(1.0, abs=1e-3)
    assert (normal.name, np.isnan(normal.parameter)) == ("P/P_max", True)
    assert {curve.name for curve in tangential} == {"F/(mu P_max)"}
    assert len(tangential) >= 4
    for curve in tangential:
        assert np.all(np.abs(curve.y) <= normal.y + 0.05)
        assert curve.y.min() < -0.02  # every one of them reverses


def test_figure_2_has_the_papers_shape(simulation):
    elastic, rigid, exact = figure_2(simulation).curves
    chi = 1.4411764706
    assert rigid.y.min() == 0.0
    assert 1e-6 < np.abs(elastic.y - exact.y).max() < 0.03
    assert elastic.y.min() == pytest.approx(-1.48, abs=0.04)
    slips = elastic.x >= 4.0 * chi
    assert elastic.y[slips] == pytest.approx(rigid.y[slips], abs=1e-12)


def test_figure_3_reverses_more_often_as_chi_grows(simulation):
    """The paper's §4.4: as chi is increased the number of reversals of the force increases."""
    _, *curves = figure_3(simulation).curves
    reversals = [np.sum(np.diff(np.sign(curve.y[np.abs(curve.y) > 1e-3])) != 0) for curve in curves]
    assert reversals == sorted(reversals)
    assert reversals[-1] >= reversals[0] + 2


@pytest.mark.slow
def test_figure_4_oscillates_about_the_rigid_theory(simulation):
    elastic, rigid, exact = figure_4(simulation).curves
    assert np.all(rigid.y[rigid.x > 0.3] == 0.0)
    assert 1e-6 < np.abs(elastic.y - exact.y)[elastic.x < 4.0].max() < 0.03
    signs = np.sign(elastic.y[elastic.x > 0.35])
    assert np.sum(np.diff(signs) != 0) >= 4


def test_figures_of_another_sphere(run, tmp_path):
    """chi = (1 + 1/K²) (1 - nu)/(2 - nu), eq. (38) of a sphere on its own material."""
    given = "--poisson-ratio", "0.45", "--gyration-ratio", "0.5"
    ran = run("figures", "--out", tmp_path, "--only", "2", *FEW, *given)
    chi = 5.0 * 0.55 / 1.55
    assert f"chi = {chi:.5g}" in ran.out
    rows = list(csv.DictReader((tmp_path / "figure-2.csv").read_text().splitlines()))
    rigid = [row for row in rows if row["curve"] == "rigid-body theory"]
    end = rigid[-1]
    assert float(end["psi1"]) > 4.0 * chi
    assert float(end["psi2"]) == pytest.approx(float(end["psi1"]) - 4.0 * chi)
    assert "must lie in (0, 1]" in run("figures", "--out", tmp_path, "--gyration-ratio", "2").err


@pytest.mark.parametrize("command", ["run", "sweep", "compare"])
def test_a_sphere_by_its_numbers_has_the_scene_of_its_chi(run, command):
    psi1 = "--psi1", "0.2:5:4" if command != "run" else "1.2"
    by_numbers = run(command, *psi1, "--poisson-ratio", "0.45", "--gyration-ratio", "0.5", "--json")
    by_chi = run(command, *psi1, "--chi", repr(5.0 * 0.55 / 1.55), "--json")
    one, other = (json.loads(ran.out) for ran in (by_numbers, by_chi))
    if command == "compare":
        one, other = (each["laws"]["fronts"]["values"] for each in (one, other))
    assert one["psi2"] == pytest.approx(other["psi2"], abs=1e-9)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--poisson-ratio", "0.45"), "--gyration-ratio: must be given beside --poisson-ratio"),
        (("--gyration-ratio", "0.5"), "--poisson-ratio: must be given beside --gyration-ratio"),
        (("--poisson-ratio", "0.3", "--gyration-ratio", "0.5", "--chi", "1"), "say the same"),
        (("--poisson-ratio", "0.7", "--gyration-ratio", "0.5"), "poisson_ratio = 0.7"),
    ],
)
def test_what_is_no_sphere_is_refused(run, words, told):
    ran = run("compare", "--psi1", "1", *words)
    assert ran.status == 2
    assert told in ran.err
