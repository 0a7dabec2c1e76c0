"""Error over run time: which rows are drawn, where, in which colour and with which name."""

import attrs
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab.figures import work_precision as figures
from contactlab.figures.style import LAW_COLOURS, QUIET
from contactlab.figures.work_precision import OTHERS, work_precision
from contactlab.study.benchmark import Benchmark, Row


def row(method, error=1e-3, time=1e-4, many=None, options="", failed=0, converges=True):
    return Row(
        method=method, options=options, error_rms=error, error_worst=error, force_error_rms=error,
        books_worst=0.0, time_s=time, sweep_time_s=time / 10 if many is None else many,
        failed=failed, status="SUCCESS", converges=converges,
    )  # fmt: skip


def benchmark(*rows):
    return Benchmark(rows=rows, orders={}, complete=True)


def panels(width=9.0):
    figure = Figure(figsize=(width, 4.0), dpi=100)
    FigureCanvasAgg(figure)
    return figure.subplots(1, 2, squeeze=False)


ROWS = (
    row("springs / symplectic", 1e-2, 1e-4, options="springs=4, steps=25"),
    row("springs / symplectic", 1e-3, 3e-4, options="springs=16, steps=64"),
    row("annulus / symplectic", 1e-1, 2e-4, many=np.nan),
    row("halfspace", 1e-4, 5e-2), row("sharp_annulus / paper", 1e-5, 1e-3),
    row("fronts / events", 1e-15, 2e-3),
    row("walton", 0.3, 1e-5, converges=False),
)  # fmt: skip


@pytest.fixture(scope="module")
def drawn():
    axes = panels()
    assert work_precision(axes, benchmark(*ROWS)) is axes
    return axes[0]


def curves(axes):
    """The data of curves with dots, in microseconds, by colour."""
    lines = [line for line in axes.lines if line.get_marker() in ("o", "v")]
    return [(line.get_color(), *map(list, line.get_data())) for line in lines]


def test_each_of_many_stands_left_and_one_alone_right(drawn):
    """In microseconds; errors below 1e-8 stand there; what was not measured is not drawn."""
    left, right = map(curves, drawn)
    expected = [
        (LAW_COLOURS[1], [100.0, 300.0], [1e-2, 1e-3]),
        (LAW_COLOURS[0], [200.0], [1e-1]),
        (LAW_COLOURS[3], [5e4], [1e-4]),
        (LAW_COLOURS[5], [1e3], [1e-5]),
        (LAW_COLOURS[2], [2e3], [1e-8]),
        (QUIET, [10.0], [0.3]),
    ]
    assert right == [
        (colour, pytest.approx(times), pytest.approx(errors)) for colour, times, errors in expected
    ]
    del expected[1]
    assert left == [
        (colour, pytest.approx(np.array(times) / 10.0), pytest.approx(errors))
        for colour, times, errors in expected
    ]


def test_codes_that_are_not_run_are_hollow_squares(drawn):
    """Times that are cited: 50 steps of 57 and of 84 ns, and 11.9 ms."""
    for axes, points in zip(
        drawn, ({(2.85, 0.269): QUIET, (4.2, 0.006): "#555555"}, {(11900.0, 1.8e-3): "#555555"}),
        strict=True,
    ):  # fmt: skip
        squares = [line for line in axes.lines if line.get_marker() == "s"]
        found = {tuple(float(each[0]) for each in line.get_data()): line for line in squares}
        assert sorted(found) == [pytest.approx(point) for point in sorted(points)]
        colours = [found[place].get_color() for place in sorted(found)]
        assert colours == [points[point] for point in sorted(points)]
        assert {line.get_markerfacecolor() for line in squares} == {"white"}
    assert [other.name for other in OTHERS] == ["LAMMPS mindlin", "8 in LAMMPS", "plain NumPy"]


def test_springs_are_numbered_by_their_parts(drawn):
    for axes in drawn:
        numbers = {text.get_text(): text for text in axes.texts if text.get_text().isdigit()}
        assert set(numbers) == {"4", "16"}
        assert numbers["16"].xy[1] == 1e-3
    assert numbers["4"].xy == pytest.approx((100.0, 1e-2))
    assert numbers["4"].xyann == (-5.0, 0.0)  # on the left of its point


def test_axes_titles_and_limits_are_alike(drawn):
    left, right = drawn
    assert left.get_title(loc="left") == "each of many (arrays, one core)"
    assert right.get_title(loc="left") == "one alone, with its call"
    assert left.get_ylabel() == r"error of $\psi_2$, rms over the scenes"
    for axes in drawn:
        assert axes.get_ylim() == pytest.approx((2e-9, 1e5))
        assert axes.get_xlabel() == "run time per impact (µs)"
        np.testing.assert_allclose(axes.get_yticks(), 10.0 ** np.arange(-8, 1, 2))
        bands = [patch for patch in axes.patches if patch.get_facecolor()[:3] == (237 / 255,) * 3]
        box = bands[0].get_extents().transformed(axes.transData.inverted())
        assert (box.y0, box.y1) == pytest.approx((0.05, 1e5))
    assert left.get_shared_y_axes().joined(left, right)
    assert not right.yaxis.get_tick_params()["labelleft"]
    words = [text.get_text() for text in left.texts]
    assert "another model: no finer step helps" in words
    assert figures.SOURCES[0] in words
    assert figures.SOURCES[1] in [text.get_text() for text in right.texts]


def test_a_law_without_a_measured_time_has_no_name():
    rows = [attrs.evolve(ROWS[0], sweep_time_s=np.nan)]
    left, right = work_precision(panels(), benchmark(*rows))[0]
    assert "springs" not in [text.get_text() for text in left.texts]
    assert "springs" in [text.get_text() for text in right.texts]
