"""Results drawn by one call: columns, bands, new figures, and the map of stick and slip."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactlab import Scene, Simulation
from contactlab.figures.results import draw_history, draw_result
from contactlab.figures.stick_slip import draw_stick_slip, stick_slip_map
from contactlab.figures.style import LAW_COLOURS

BLUE, GREY, RED, WHITE = "#0072B2", "#C4C4C4", "#D55E00", "#FFFFFF"
TIME = r"time over duration of contact $t/t_{\mathrm{c}}$"


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


@pytest.mark.parametrize("columns", [("psi1", None), (None, "psi2")])
def test_forces_of_one_impact_have_no_columns(axes, columns):
    one = Simulation(tangential="coulomb").run(Scene.nondimensional(psi1=1.0, chi=1.0))
    with pytest.raises(ValueError, match="are for the result of many impacts"):
        draw_result(axes, one, *columns)


@pytest.mark.parametrize(("width", "size"), [(None, (6.4, 4.8)), ("two", (7.0, 3.9))])
def test_without_axes_a_figure_is_made(width, size, many):
    from matplotlib import pyplot

    axes = draw_result(None, many, None, None, width=width)
    assert tuple(axes.figure.get_size_inches()) == pytest.approx(size)
    assert not axes.spines["top"].get_visible()
    pyplot.close(axes.figure)


def test_a_state_has_its_colour_at_its_time_and_radius(axes):
    """Stuck before all; else backward, forward, or no contact."""
    time, radius = np.array([0.1, 0.5, 0.9]), np.array([0.25, 0.75])
    stuck = np.array([[True, True], [False, False], [False, False]])
    slipping = np.array([[1, 0], [-1, 1], [1, 0]])
    assert stick_slip_map(axes, time, radius, stuck, slipping) is axes
    mesh = axes.collections[0]
    states = np.asarray(mesh.get_array()).reshape(2, 3)
    assert states.tolist() == [[1, 0, 2], [1, 2, 3]]
    colours = [mesh.cmap(mesh.norm(state))[:3] for state in range(4)]
    expected = [[int(name[k : k + 2], 16) / 255 for k in (1, 3, 5)] for name in (
        RED, GREY, BLUE, WHITE)]  # fmt: skip
    assert [list(colour) for colour in colours] == [pytest.approx(each) for each in expected]
    corners = mesh.get_coordinates()
    assert list(corners[0, :, 0]) == pytest.approx([-0.1, 0.3, 0.7, 1.1])
    assert list(corners[:, 0, 1]) == pytest.approx([0.0, 0.5, 1.0])
    assert (axes.get_xlim(), axes.get_ylim()) == ((0.0, 1.0), (0.0, 1.0))
    assert (axes.get_xlabel(), axes.get_ylabel()) == (
        TIME, r"radius over largest contact radius $r/a$"
    )  # fmt: skip
    legend = axes.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == [
        "slip, backward", "stick", "slip, forward"
    ]  # fmt: skip
    assert legend._ncols == 3
    only = stick_slip_map(Figure().subplots(), time, radius, ~stuck | stuck, slipping)
    assert [text.get_text() for text in only.get_legend().get_texts()] == ["stick"]


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
