"""The paper's figures: curves, colours, limits and words, of data written out."""

from types import SimpleNamespace

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab.figures.paper import draw_paper
from contactlab.figures.style import LAW_COLOURS
from contactlab.study.paper_figures import Curve, FigureData

X = np.linspace(0.0, 1.0, 30)
VIRIDIS = mpl.colormaps["viridis"]
TIME = r"time over duration of contact $t/t_{\mathrm{c}}$"


@pytest.fixture
def axes():
    figure = Figure(figsize=(5.6, 3.9))
    FigureCanvasAgg(figure)
    return figure.subplots()


def forces(number, parameters):
    curves = [Curve("P/P_max", np.nan, X, np.sin(np.pi * X))]
    curves += [
        Curve("F", value, X, 0.2 * (place - 1.0) * np.sin(np.pi * X))
        for place, value in enumerate(parameters)
    ]
    return FigureData(number=number, x="t", y="f", parameter="p", curves=tuple(curves))


def reflexion(number, x):
    shapes = (("my", 0.5 * x), ("rigid-body theory", 0.1 * x), ("exact solution", 0.5 * x))
    curves = tuple(Curve(name, np.nan, x, y) for name, y in shapes)
    return FigureData(number=number, x="x", y="psi2", parameter="", curves=curves)


def written(axes):
    return [text.get_text() for text in axes.texts]


@pytest.mark.parametrize(
    ("number", "parameters", "names", "labels", "common"),
    [
        (1, (0.4, 1.2, 3.0), [r"$\psi_1$ = 0.4", "1.2", "3"], ["0.4", "1.2", "3"],
         r"$\chi$ = 1.4412"),
        # K and chi = 0.35/0.85 (1 + 1/K²).
        (3, (1.0, 0.63246, 0.25), ["$K$ = 1", "0.632", "0.25"],
         ["1  (0.82)", "0.632  (1.44)", "0.25  (7.00)"], r"$\psi_1$ = 1.2"),
    ],
)  # fmt: skip
def test_forces_are_drawn_in_order_and_named(axes, number, parameters, names, labels, common):
    assert draw_paper(axes, forces(number, parameters)) is axes
    _, upper, lower, *curves = axes.lines[:6]
    np.testing.assert_array_equal(upper.get_ydata(), np.sin(np.pi * X))
    np.testing.assert_array_equal(lower.get_ydata(), -np.sin(np.pi * X))
    for place, curve in enumerate(curves):
        np.testing.assert_allclose(curve.get_ydata(), 0.2 * (place - 1.0) * np.sin(np.pi * X))
        assert curve.get_color() == VIRIDIS(0.43 * place)
    assert [curve.get_label() for curve in curves] == labels
    assert [word for word in written(axes) if word in names] == names
    assert common in written(axes)
    assert axes.get_xlabel() == TIME
    assert (axes.get_xlim(), axes.get_ylim()) == ((0.0, 1.0), (-1.05, 1.05))
    assert axes.get_legend() is None


def test_regimes_are_named_between_their_limits(axes):
    """psi1 = 1 and 4 chi - 1 = 4.7647; the words stand in the middle of each, at the top."""
    draw_paper(axes, reflexion(2, np.linspace(0.0, 7.0, 50)))
    dotted = [line for line in axes.lines if line.get_linestyle() == ":"]
    assert [line.get_xdata()[0] for line in dotted] == pytest.approx([1.0, 4.764706])
    places = {text.get_text(): text.get_position() for text in axes.texts}
    assert places["sticks\nat first"] == (0.5, 1.7)
    assert places["slips, sticks, slips"] == pytest.approx((0.5 * 5.764706, 1.7))
    assert places["slips\nthroughout"] == pytest.approx((0.5 * 11.764706, 1.7))
    regimes = [text for text in axes.texts if text.get_position()[1] == 1.7]
    assert {(text.get_ha(), text.get_va()) for text in regimes} == {("center", "top")}
    assert axes.get_ylim()[1] == 1.7
    assert axes.get_xlim() == (0.0, 7.0)
    assert axes.get_xlabel() == r"local angle of incidence $\psi_1$"
    assert r"$\chi$ = 1.4412" in places


@pytest.mark.parametrize("number", [2, 4])
def test_law_exact_solution_and_rigid_theory_are_told_apart(axes, number):
    x = np.linspace(0.25, 7.0, 50)
    draw_paper(axes, reflexion(number, x))
    law, exact, rigid = [line for line in axes.lines if len(line.get_xdata()) == 50]
    assert (law.get_label(), law.get_color()) == ("my law", LAW_COLOURS[0])
    assert (exact.get_label(), exact.get_color()) == ("exact solution", "black")
    assert (rigid.get_label(), rigid.get_color()) == ("rigid-body theory", LAW_COLOURS[1])
    np.testing.assert_array_equal(law.get_data(), (x, 0.5 * x))
    np.testing.assert_array_equal(rigid.get_data(), (x, 0.1 * x))
    assert axes.get_ylabel() == r"local angle of reflexion $\psi_2$"
    assert "my law (thick),\nexact solution (thin)" in written(axes)
    assert "rigid-body theory" in written(axes)


def test_the_range_of_solid_spheres_is_shaded(axes):
    """chi = 7/6 for nu = 0.5, and 7/4 for nu = 0."""
    draw_paper(axes, reflexion(4, np.geomspace(0.25, 16.0, 50)))
    (band,) = axes.patches
    box = band.get_extents().transformed(axes.transData.inverted())
    assert (box.x0, box.x1) == pytest.approx((7 / 6, 7 / 4))
    (words,) = [text for text in axes.texts if "solid spheres" in text.get_text()]
    assert words.get_text() == "solid spheres,\n" r"$\nu$ from 0 to 0.5"
    assert words.get_position() == pytest.approx((0.97 * 7 / 6, 0.95))
    assert (words.get_ha(), words.get_va()) == ("right", "top")
    assert axes.get_ylim()[1] == 0.95
    assert (axes.get_xscale(), axes.get_xlim()) == ("log", pytest.approx((0.25, 16.0)))
    assert list(axes.get_xticks()) == [0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0]
    assert [label.get_text() for label in axes.get_xticklabels()] == [
        "0.25", "0.5", "1", "2", "4", "8", "16"
    ]  # fmt: skip
    assert len(axes.get_xticks(minor=True)) == 0
    assert axes.get_xlabel() == r"inertia ratio $\chi$"


def test_a_figure_without_a_function_has_plain_curves(axes):
    data = forces(9, (0.5, 0.25))
    draw_paper(axes, SimpleNamespace(number=9, x="psi1", y="psi2", parameter="ratio",
                                     curves=data.curves))  # fmt: skip
    assert [line.get_label() for line in axes.lines] == ["P/P_max", "0.5", "0.25"]
    assert [line.get_color() for line in axes.lines] == [
        VIRIDIS(0.0), VIRIDIS(0.43), VIRIDIS(0.86)
    ]  # fmt: skip
    assert axes.get_legend().get_title().get_text() == "ratio"
    assert axes.get_xlabel() == r"local angle of incidence $\psi_1$"
    assert axes.get_ylabel() == r"local angle of reflexion $\psi_2$"
