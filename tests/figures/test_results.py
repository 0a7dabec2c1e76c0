"""Results drawn by one call: columns, bands, new figures, and the map of stick and slip."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactlab import Scene, Simulation
from contactlab.figures.stick_slip import draw_stick_slip
from contactlab.outcome.history_figure import draw_history
from contactlab.outcome.result_figure import draw_result
from contactlab.outcome.style import LAW_COLOURS

BLUE, GREY, RED, WHITE = "#0072B2", "#C4C4C4", "#D55E00", "#FFFFFF"


@pytest.fixture
def axes():
    return Figure().subplots()


@pytest.fixture(scope="module")
def many():
    return Simulation(tangential="coulomb").run(Scene.nondimensional(psi1=[3.0, 0.0, 6.0], chi=1.0))


class History(SimpleNamespace):
    def unit(self, name):
        return {"normal_force": "N", "time": "ms"}[name]


def test_a_history_has_both_forces_in_its_units(axes):
    history = History(
        time=np.array([0.0, 1.0]), normal_force=np.array([2.0, 3.0]),
        tangential_force=np.array([0.5, -0.5]),
    )  # fmt: skip
    assert draw_history(axes, history) is axes
    zero, normal, tangential = axes.lines
    assert list(zero.get_ydata()) == [0.0, 0.0]
    assert list(normal.get_ydata()) == [2.0, 3.0]
    assert list(tangential.get_ydata()) == [0.5, -0.5]
    assert [normal.get_color(), tangential.get_color()] == list(LAW_COLOURS[:2])
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time (ms)", "force (N)")
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == ["normal force", "tangential force"]


def test_points_of_one_abscissa_are_not_joined(axes, many):
    draw_result(axes, many, "chi", None)
    (line,) = axes.lines
    assert (line.get_linestyle(), line.get_marker()) == ("None", ".")
    assert axes.get_xlabel() == r"inertia ratio $\chi$"
    assert axes.get_ylabel() == r"local angle of reflexion $\psi_2$"
    assert list(line.get_ydata()) == [0.0, 0.0, 2.0]


@pytest.mark.parametrize(("columns", "where"), [(("psi9", None), "x"), ((None, "psi9"), "y")])
def test_an_unknown_column_is_named_with_its_place(axes, many, columns, where):
    with pytest.raises(ValueError, match=rf"^{where} = 'psi9'"):
        draw_result(axes, many, *columns)
    assert not axes.lines


@pytest.mark.parametrize(("width", "size"), [(None, (6.4, 4.8)), ("two", (7.0, 3.9))])
def test_without_axes_a_figure_is_made(width, size, many):
    from matplotlib import pyplot

    axes = draw_result(None, many, None, None, width=width)
    assert tuple(axes.figure.get_size_inches()) == pytest.approx(size)
    assert not axes.spines["top"].get_visible()
    pyplot.close(axes.figure)


def test_the_map_is_over_duration_and_largest_radius(axes):
    fields = {
        "radius": np.array([[0.5, 1.5], [0.5, 1.5]]), "stuck": np.ones((2, 2), dtype=bool),
        "slipping": np.zeros((2, 2)),
    }  # fmt: skip
    result = SimpleNamespace(
        history=SimpleNamespace(time=np.array([1.0, 3.0]), fields=fields),
        scene=SimpleNamespace(shape=()),
        motion=SimpleNamespace(duration=4.0, maximum_radius=2.0),
    )
    draw_stick_slip(axes, result)
    corners = axes.collections[0].get_coordinates()
    assert list(corners[0, :, 0]) == pytest.approx([0.0, 0.5, 1.0])
    assert list(corners[:, 0, 1]) == pytest.approx([0.0, 0.5, 1.0])
