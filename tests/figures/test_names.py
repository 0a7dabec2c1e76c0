"""Names beside curves: distances, boxes and places found by hand; one dot is one point."""

import itertools

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab.figures import names


def curve(axes, x, y):
    return axes.plot(x, y)[0]


@pytest.fixture
def axes():
    """Axes of 400 by 300 dots, one dot a unit, 72 dots an inch."""
    figure = Figure(figsize=(400 / 72, 300 / 72), dpi=72)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(0.0, 400.0)
    axes.set_ylim(0.0, 300.0)
    return axes


def words(axes):
    return {text.get_text(): text for text in axes.texts}


def test_names_have_the_colours_of_their_curves_and_touch_nothing(axes):
    x = np.linspace(0.0, 400.0, 50)
    lines = [curve(axes, x, np.full(50, y)) for y in (60.0, 150.0, 240.0)]
    assert names.name_curves(axes, lines, ["low", "middle", "high"])
    found = words(axes)
    for line, name, y in zip(lines, ("low", "middle", "high"), (60.0, 150.0, 240.0), strict=True):
        text = found[name]
        assert text.get_color() == line.get_color()
        box = text.get_window_extent()
        assert min(abs(box.y0 - y), abs(box.y1 - y)) == pytest.approx(2.5, abs=0.6)
        assert (text.get_ha(), text.get_va()) == ("center", "center")
    for one, other in itertools.combinations(found.values(), 2):
        assert not one.get_window_extent().overlaps(other.get_window_extent())
    assert len(axes.lines) == 3


def test_names_keep_clear_of_rules_and_of_the_legend(axes):
    x = np.linspace(0.0, 400.0, 50)
    line = curve(axes, x, np.full(50, 150.0))
    axes.plot([0.0, 400.0], [159.0, 159.0])  # two points: a rule
    axes.plot([0.0, 400.0], [141.0, 141.0])
    line.set_label("a name")
    legend = axes.legend(loc="upper left")
    assert names.name_curves(axes, [line], ["a name"])
    (text,) = axes.texts
    box = text.get_window_extent()
    assert not box.overlaps(legend.get_window_extent())
    assert box.y0 > 159.0 + 1.0 or box.y1 < 141.0 - 1.0
    leader = axes.lines[-1]
    assert (leader.get_linewidth(), leader.get_color()) == (0.6, line.get_color())
    (x0, x1), (y0, y1) = leader.get_data()
    assert y0 == pytest.approx(150.0, abs=0.1)
    assert min(abs(y1 - box.y0), abs(y1 - box.y1)) < 1.0
    assert box.x0 < x1 < box.x1
    assert abs(x1 - x0) < 60.0
    assert axes.get_xlim() == (0.0, 400.0)


def test_curves_of_one_group_may_be_alike(axes):
    x = np.linspace(0.0, 400.0, 50)
    pair = [curve(axes, x, np.full(50, y)) for y in (150.0, 153.0)]
    others = [curve(axes, x, np.full(50, y)) for y in (40.0, 260.0)]
    assert names.name_curves(axes, [pair[0], *others], ["both", "a", "b"], alike=[pair])
    text = words(axes)["both"].get_window_extent()
    assert min(abs(text.y1 - 150.0), abs(text.y0 - 153.0)) < 6.0
