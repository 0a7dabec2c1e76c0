"""The stability picture: panels, cells, contours, bars and model errors."""

import numpy as np
import pytest
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure

from contactlab.figures import stability as figures
from contactlab.figures.stability import (
    _edges,
    draw_stability,
    error_colours,
    error_over_steps,
    model_errors,
)
from contactlab.figures.style import LAW_COLOURS
from contactlab.study.error_map import ErrorMap
from contactlab.study.model_error import ModelError


def area(law="one_law", error=((1e-4, 1e-2), (1e-5, 1e-3)), *, converges=True):
    return ErrorMap(
        law=law, integrator="paper", steps=(10, 1000), chis=(1.0, 4.0), error=np.array(error),
        converges=converges,
    )  # fmt: skip


def model(law="coulomb", error=(0.5, 0.2)):
    return ModelError(law=law, chis=(0.5, 3.0), error=np.array(error))


@pytest.fixture
def figure_of(tmp_path, monkeypatch):
    """The figure that is written."""
    kept = []
    monkeypatch.setattr(figures, "save_figure", lambda figure, path: kept.append((figure, path)))

    def draw(*words, **options):
        draw_stability(tmp_path / "a.png", *words, **options)
        assert kept[-1][1] == tmp_path / "a.png"
        return kept[-1][0]

    return draw


def places(figure):
    """Row and columns of each panel with a title, and of the last one."""
    return [
        (axes.get_title(), axes.get_subplotspec().rowspan.start,
         axes.get_subplotspec().colspan.start, len(axes.get_subplotspec().colspan))
        for axes in figure.axes if axes.get_label() != "<colorbar>"
    ]  # fmt: skip


def test_panels_stand_in_rows_of_three_laws_of_one_kind(figure_of):
    laws = [area(f"l{number}") for number in range(4)] + [area("m", converges=False)]
    figure = figure_of(laws, [model()])
    assert places(figure) == [
        ("l0 / paper", 0, 0, 1), ("l1 / paper", 0, 1, 1), ("l2 / paper", 0, 2, 1),
        ("l3 / paper", 1, 0, 1), ("m / paper", 2, 0, 1), ("", 3, 0, 3),
    ]  # fmt: skip
    assert tuple(figure.get_size_inches()) == pytest.approx((3 * 2.7 + 1.2, 3 * 2.4 + 2.6 + 0.4))
    panels = [axes for axes in figure.axes if axes.get_title()]
    steps = "steps of one contact"
    assert [axes.get_ylabel() for axes in panels] == [steps, "", "", steps, steps]
    assert {axes.get_xlabel() for axes in panels} == {r"inertia ratio $\chi$"}
    bars = [axes for axes in figure.axes if axes.get_label() == "<colorbar>"]
    assert [axes.get_ylabel() for axes in bars] == [
        "error of $\\psi_2$, from\nthe exact solution",
        "error of $\\psi_2$, from the\nlaw's own, other limit",
    ]


@pytest.mark.parametrize(
    ("count", "models", "width", "size"),
    [
        # Two columns at least, three at most.
        (1, 0, None, (6.6, 2.8)), (2, 1, None, (6.6, 5.4)), (3, 0, None, (9.3, 2.8)),
        (1, 0, "two", (7.0, 2.8 * 7.0 / 6.6)), (3, 1, "two", (7.0, 5.4 * 7.0 / 9.3)),
    ],
)  # fmt: skip
def test_the_picture_is_as_large_as_its_panels(figure_of, count, models, width, size):
    figure = figure_of([area(f"l{n}") for n in range(count)], [model()] * models, width=width)
    assert tuple(figure.get_size_inches()) == pytest.approx(size)
    assert len(places(figure)) == count + models


def test_cells_hold_their_errors_between_edges_half_way():
    """On a logarithmic scale: 1 and 4 meet at 2, 10 and 1000 at 100."""
    axes = error_over_steps(Figure().subplots(), area())
    mesh = axes.collections[0]
    corners = mesh.get_coordinates()
    assert list(corners[0, :, 0]) == pytest.approx([0.5, 2.0, 8.0])
    assert list(corners[:, 0, 1]) == pytest.approx([1.0, 100.0, 10000.0])
    np.testing.assert_array_equal(mesh.get_array().reshape(2, 2), area().error)
    assert mesh.norm.vmin == 1e-4
    assert mesh.norm.vmax == 1.0
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert axes.get_title() == "one law / paper"


def test_edges_of_uneven_cells():
    """The first and the last reach as far outwards as inwards."""
    found = _edges(np.array([1.0, 100.0, 1e6]))
    assert np.log10(found) == pytest.approx([-1.0, 1.0, 4.0, 8.0])


@pytest.mark.parametrize(
    ("errors", "levels"),
    [
        ((1e-4, 0.5), [1e-3, 1e-2]), ((1e-3, 0.5), [1e-2]), ((1e-4, 1e-2), [1e-3]),
        ((2e-2, 0.5), []), ((1e-5, 1e-4), []), ((np.nan, np.nan), []),
    ],
)  # fmt: skip
@pytest.mark.parametrize("converges", [True, False])
def test_contours_stand_within_the_errors(errors, levels, converges):
    low, high = errors
    axes = error_over_steps(
        Figure().subplots(), area(error=((low, high), (low, high)), converges=converges)
    )
    lines = [each for each in axes.collections if isinstance(each, QuadContourSet)]
    assert [list(each.levels) for each in lines] == ([levels] if levels else [])
    words = [text.get_text() for text in axes.texts]
    labels = {1e-3: "$10^{-3}$", 1e-2: "$10^{-2}$"}
    refused = ["refused: too few steps"] if np.isnan(low) else []
    assert sorted(words) == sorted([labels[level] for level in levels] + refused)
    if lines:
        colour = (1.0, 1.0, 1.0, 1.0) if converges else (0.0, 0.0, 0.0, 1.0)
        assert tuple(lines[0].get_edgecolor()[0]) == colour


def test_a_refused_cell_is_told():
    axes = error_over_steps(Figure().subplots(), area(error=((np.nan, 0.1), (0.1, 0.1))))
    assert [text.get_text() for text in axes.texts] == ["refused: too few steps"]
    assert axes.get_facecolor()[:3] == pytest.approx((221 / 255,) * 3)


def test_a_label_stands_in_the_middle_of_the_longest_piece():
    from matplotlib.path import Path

    codes = [Path.MOVETO, Path.LINETO, Path.MOVETO, Path.LINETO, Path.LINETO]
    path = Path([[0.0, 0.0], [1.0, 0.0], [2.0, 5.0], [3.0, 6.0], [4.0, 9.0]], codes)
    assert figures._middle(path) == (3.0, 6.0)


def test_colours_of_other_limits_are_purple_and_clipped():
    for converges in (True, False):
        colours, norm = error_colours(converges)
        assert norm.clip
        assert colours(norm(1e-9)) == colours(norm(1e-4))
        assert colours(norm(7.0)) == colours(norm(1.0))
    least, largest = colours(norm(1e-4)), colours(norm(1.0))
    assert max(least[:3]) < 0.95  # not white
    assert largest[1] < min(largest[0], largest[2])


def test_model_errors_have_markers_limits_and_names():
    models = [model(f"law_{number}", (0.5, 10.0 ** -(number + 1))) for number in range(9)]
    axes = model_errors(Figure().subplots(), models)
    assert "".join(line.get_marker() for line in axes.lines) == "os^Dv<>po"
    assert [line.get_color() for line in axes.lines[:6]] == list(LAW_COLOURS)
    assert axes.lines[8].get_ydata()[1] == 1e-6  # rounding
    assert axes.get_ylim() == pytest.approx((0.7e-6, 1.5))
    assert axes.lines[0].get_label() == "law 0"
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert axes.get_xlabel() == r"inertia ratio $\chi$"
    some = model_errors(Figure().subplots(), [model(error=(0.5, 0.2)), model(error=(0.1, np.nan))])
    assert some.get_ylim() == pytest.approx((0.07, 1.5))
    assert np.isnan(some.lines[1].get_ydata()[1])
