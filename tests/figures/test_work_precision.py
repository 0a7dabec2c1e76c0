"""Error over run time: which rows are drawn, where, in which colour and with which name."""

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactlab.figures.style import QUIET
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
