"""The stability picture: the least steps of each law, and what is refused."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from contactlab.figures.files import save
from contactlab.figures.stability import draw_least_steps, enough_steps
from contactlab.study.error_map import ErrorMap

NAN = np.nan


def area(law, error):
    return ErrorMap(
        law=law, steps=(10, 30, 100), chis=(0.5, 4.0, 20.0), error=np.array(error)
    )  # fmt: skip


MAPS = [
    area("one_law", [[1e-3, NAN, NAN], [1e-4, 5e-2, NAN], [1e-5, 1e-3, 0.5]]),
    area("other", [[1e-3, 1e-3, NAN], [0.2, 1e-2, 1e-4], [1e-5, 1e-3, 1e-4]]),
]


def test_a_curve_has_the_least_steps_from_which_on_the_error_is_small():
    axes = draw_least_steps(Figure().subplots(), MAPS)
    one, other, *_ = axes.lines
    np.testing.assert_array_equal(one.get_ydata(), [10.0, 100.0, NAN])
    np.testing.assert_array_equal(other.get_ydata(), [100.0, 10.0, 30.0])
    assert [list(line.get_xdata()) for line in (one, other)] == [[0.5, 4.0, 20.0]] * 2
    assert {"one law", "other"} <= {text.get_text() for text in axes.texts}


def test_steps_that_every_law_refuses_are_shaded():
    axes = draw_least_steps(Figure().subplots(), MAPS)
    (shade,) = axes.collections
    heights = shade.get_paths()[0].vertices
    at = {x: heights[heights[:, 0] == x, 1].max() for x in (0.5, 4.0, 20.0)}
    assert at == {0.5: 10.0, 4.0: 10.0, 20.0: 30.0}


def test_the_line_to_take_is_above_every_law_that_reaches_its_limit():
    """At chi = 0.5 the other law needs 100 steps, 142 per root of chi: rounded up to fives, 145."""
    assert enough_steps(MAPS) == (145, ["one law"])  # which has no answer at chi = 20
    axes = draw_least_steps(Figure().subplots(), MAPS)
    take = max(axes.lines[:3], key=lambda line: line.get_linewidth())
    for x, steps in zip(take.get_xdata(), take.get_ydata(), strict=True):
        assert steps == pytest.approx(145.0 * x**0.5)
    assert (take.get_ydata() >= axes.lines[1].get_ydata()).all()
    assert "145" in axes.get_title()
    assert any("one law" in text.get_text() and "100" in text.get_text() for text in axes.texts)


def test_least_steps_of_the_map_do_not_set_the_line():
    maps = [area("easy", [[1e-3] * 3] * 3)]
    assert enough_steps(maps) == (0, [])
    assert enough_steps([]) == (0, [])
    assert draw_least_steps(Figure().subplots(), maps).get_title().startswith("steps that keep")


@pytest.mark.slow
def test_a_picture_is_written_also_without_a_map(tmp_path):
    for maps in (MAPS, []):
        save(tmp_path / "a.png", lambda axes, maps=maps: draw_least_steps(axes, maps), width="two")
        assert (tmp_path / "a.png").read_bytes()[1:4] == b"PNG"
