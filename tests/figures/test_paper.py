"""The paper's figures: curves, colours, limits and words, of data written out."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab.figures.paper import draw_paper
from contactlab.outcome.style import LAW_COLOURS
from contactlab.study.paper_figures import Curve, FigureData


@pytest.fixture
def axes():
    figure = Figure(figsize=(5.6, 3.9))
    FigureCanvasAgg(figure)
    return figure.subplots()


def reflexion(number, x):
    shapes = (("my", 0.5 * x), ("rigid-body theory", 0.1 * x), ("exact solution", 0.5 * x))
    curves = tuple(Curve(name, np.nan, x, y) for name, y in shapes)
    return FigureData(number=number, x="x", y="psi2", parameter="", curves=curves)


def written(axes):
    return [text.get_text() for text in axes.texts]


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
