"""Pictures as files, and as the value of a notebook's cell."""

from __future__ import annotations

import numpy as np
import pytest

from contactlab import Scene, Simulation
from contactlab.figures.files import save
from contactlab.figures.stick_slip import draw_stick_slip


def draw(axes):
    axes.plot([0.0, 1.0], [0.0, 1.0])


@pytest.mark.parametrize(
    ("end", "png", "svg"), [("png", True, False), ("svg", False, True), ("pdf", False, False)]
)
def test_a_notebook_shows_what_was_saved(tmp_path, end, png, svg):
    path = tmp_path / f"line.{end}"
    picture = save(path, draw)
    assert picture.path == path
    assert picture._repr_png_() == (path.read_bytes() if png else None)
    assert picture._repr_svg_() == (path.read_text("utf-8") if svg else None)


@pytest.mark.parametrize("law", ["fronts", "springs"])
def test_the_map_of_stick_and_slip_ends_gross_slip_where_the_closed_form_does(law):
    """Slip of the whole contact ends at V = (2 chi - psi1)/(2 chi - 1) (theory §2)."""
    figure = pytest.importorskip("matplotlib.figure").Figure()
    psi1, chi = 2.0, 1.4412
    result = Simulation(tangential=law).run(
        Scene.nondimensional(psi1=psi1, chi=chi), history="fields"
    )
    axes = draw_stick_slip(figure.subplots(), result)
    states = np.asarray(axes.collections[0].get_array()).reshape(-1, len(result.history.time))
    sticks = np.flatnonzero((states == 1).any(axis=0))
    ends = result.history.normal_velocity[sticks[0]] / result.history.normal_velocity[0]
    assert ends == pytest.approx((2 * chi - psi1) / (2 * chi - 1), abs=0.03)
    middles = axes.collections[0].get_coordinates().reshape(-1, 2)
    for shown, place in zip((axes.get_xlim(), axes.get_ylim()), middles.T, strict=True):
        assert shown[0] <= max(place.min(), 0.0)
        assert shown[1] >= min(place.max(), 1.0)


@pytest.mark.parametrize(
    ("law", "psi1", "history"),
    [("coulomb", 2.0, "fields"), ("fronts", 2.0, True), ("fronts", [1.0, 2.0], "fields")],
)
def test_without_fields_of_one_impact_there_is_no_map(law, psi1, history):
    figure = pytest.importorskip("matplotlib.figure").Figure()
    scene = Scene.nondimensional(psi1=psi1, chi=1.4412)
    result = Simulation(tangential=law).run(scene, history=history)
    with pytest.raises(ValueError, match="history='fields'"):
        draw_stick_slip(figure.subplots(), result)
