"""Figures of the command line: their panels, read back from what is drawn."""

from __future__ import annotations

import csv
import functools

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactlab import Scene, Simulation, read_scene
from contactlab.cli import drawing
from contactlab.study.comparison import compare
from contactlab.study.loops import loops

LAWS = {name: Simulation(tangential=name) for name in ("coulomb", "frictionless")}
LOOK = {"look": "slides", "width": "two"}


@pytest.fixture
def drawn(monkeypatch):
    """Record what would be saved, with the axes drawn on a figure."""
    saved = []

    def save(path, draw, *, rows=1, columns=1, heights=None, **look):
        axes = Figure().subplots(rows, columns, squeeze=False)
        draw(axes if axes.size > 1 else axes[0, 0])
        saved.append((path, axes, heights, look))

    monkeypatch.setattr(drawing, "save", save)
    monkeypatch.setattr("contactlab.figures.files.save", save)
    return saved


def legends(axes):
    return [[text.get_text() for text in each.get_legend().get_texts()]
            if each.get_legend() else None for each in axes.flat]  # fmt: skip


def test_a_comparison_over_a_sweep_has_a_column_for_each_series(drawn, measured, tmp_path):
    """Two series of one quantity, and a quantity without any."""
    text = measured.read_text(encoding="utf-8")
    more = "[[measured]]\nquantity = 'psi2'\nagainst = 'psi1'\nsource = 'x'\nx = [2.0]\n"
    measured.write_text(f"{text}{more}values = [-1.0]\nlabel = 'others'\n", encoding="utf-8")
    comparison = compare(read_scene(measured), LAWS)
    drawing.draw_comparison(tmp_path, comparison, ["psi2", "slip_restitution"], **LOOK)
    ((path, axes, heights, look),) = drawn
    assert (path, axes.shape, heights, look) == (tmp_path, (2, 3), (2.4, 1.0), LOOK)
    assert [each.get_xlabel() for each in axes[0]] == ["", "", ""]
    assert all("psi_1" in each.get_xlabel() for each in axes[1])
    first, second, third = legends(axes[0])
    assert {"coulomb", "frictionless", "measured"} <= set(first)
    assert {"others"} <= set(second)  # it is not that of the first panel
    assert {"coulomb", "frictionless"} <= set(third)
    assert not {"measured", "others"} & set(third)
    assert "restitution" in axes[0, 2].get_ylabel()


def test_a_legend_of_the_same_laws_is_shown_once(drawn, short_sweep, tmp_path):
    comparison = compare(read_scene(short_sweep), LAWS)
    drawing.draw_comparison(tmp_path, comparison, ["psi2", "slip_restitution"])
    upper = legends(drawn[0][1][0])
    assert upper == [["coulomb", "frictionless"], None]
    drawing.draw_comparison(tmp_path, comparison, ["psi2"])
    assert legends(drawn[1][1][0]) == [["coulomb", "frictionless"]]


def test_a_comparison_of_one_impact_is_of_its_forces(drawn, tmp_path):
    comparison = compare(Scene.nondimensional(psi1=1.2, chi=1.44),
                         {"springs": Simulation(tangential="springs")}, history=True)  # fmt: skip
    drawing.draw_comparison(tmp_path, comparison, ["psi2"], **LOOK)
    ((_, axes, heights, look),) = drawn
    assert (axes.shape, heights, look) == ((1, 1), None, LOOK)
    assert max(np.max(line.get_ydata()) for line in axes[0, 0].lines) == pytest.approx(
        1.0, abs=0.02
    )


def test_loops_at_constant_and_at_oscillating_load(drawn, ball, tmp_path):
    paths = loops(read_scene(ball).scene, {"mindlin_cap": Simulation(tangential="mindlin_cap")})
    drawing.draw_load_paths(tmp_path, paths, **LOOK)
    ((_, axes, _, look),) = drawn
    assert (axes.shape, look) == ((1, 2), LOOK)
    left, right = axes[0]
    assert [each.get_title() for each in (left, right)] == ["constant load", "oscillating load"]
    assert left.get_ylabel()
    assert right.get_ylabel() == ""
    assert legends(axes) == [["mindlin_cap"], None]
    loads = [max((line.get_ydata() for line in each.lines), key=len) for each in (left, right)]
    assert not np.array_equal(*loads)


def test_the_paper_s_figures_are_saved_as_asked(run, monkeypatch, tmp_path):
    saved = []
    monkeypatch.setattr(
        "contactlab.figures.files.save",
        lambda path, draw, **look: saved.append((path, draw, look)),
    )
    few = ("--set", "tangential.annuli=5", "--set", "integrator.steps=30")
    ran = run("figures", "--out", tmp_path, "--only", "2, 2", "--format", "pdf", "--width", "one",
              "--style", "slides", *few)  # fmt: skip
    picture, numbers = tmp_path / "figure-2.pdf", tmp_path / "figure-2.csv"
    assert (ran.status, *ran.out.splitlines()[:2]) == (0, str(picture), str(numbers))
    ((path, draw, look),) = saved
    assert (path, look) == (picture, {"look": "slides", "width": "one"})
    assert isinstance(draw, functools.partial)
    assert draw.keywords["data"].number == 2
    rows = list(csv.reader(numbers.read_text(encoding="utf-8").splitlines()))
    assert rows[0] == ["curve", "parameter", "psi1", "psi2"]
    assert {row[1] for row in rows[1:]} == {""}


@pytest.mark.parametrize("only", ["2,x", "7", "1,,2"])
def test_a_figure_that_there_is_not(run, tmp_path, only):
    word = next(word for word in only.split(",") if word not in ("1", "2"))
    ran = run("figures", "--out", tmp_path, "--only", only)
    assert ran.status == 2
    assert f"argument --only: {word!r}: the paper's figures are 1, 2, 3, 4 (see" in ran.err


def test_a_folder_that_cannot_be_made_is_told(run, tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    for folder, words in (
        ("file", "cannot make the folder: File exists"),
        ("file/inner", "cannot make the folder: Not a directory"),
    ):
        ran = run("figures", "--out", tmp_path / folder, "--only", "2")
        told = f"contactlab figures: error: --out {tmp_path / folder}: {words}\n"
        assert (ran.status, ran.out, ran.err) == (2, "", told)
