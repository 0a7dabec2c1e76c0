"""Orders of rows, the short table and the front."""

import pytest

from contactlab.study.benchmark import Benchmark
from tests.study.bench_rows import row


def test_rows_without_words_converge():
    assert row().converges
    assert not row().limit
    assert not Benchmark(rows=(), orders={}, complete=True).interrupted


@pytest.mark.parametrize(
    ("rows", "chosen"),
    [
        # Up to 1e-3 is good; else up to twice the least of the law.
        ([(1e-3, 5.0), (1.01e-3, 1.0), (4e-4, 6.0)], [0]),
        ([(0.2, 5.0), (0.4, 1.0), (0.41, 0.5)], [1]),
        # The most accurate stands before it if its error is a tenth, and takes longer.
        ([(1e-4, 5.0), (1e-3, 1.0)], [0, 1]),
        ([(1.01e-4, 5.0), (1e-3, 1.0)], [1]),
        ([(1e-4, 1.0), (1e-3, 1.0)], [0]),
        ([(1e-4, 2.0), (1e-4, 1.0)], [1]),
    ],
)
def test_a_short_table_takes_one_or_two_rows_of_a_law(rows, chosen):
    listed = tuple(row(error=error, time=time) for error, time in rows)
    short = Benchmark(rows=listed, orders={}, complete=True).short()
    assert short == [listed[place] for place in chosen]


def test_the_front_ends_where_errors_are_rounding():
    rows = tuple(row(error=error, time=time) for error, time in (
        (1e-10, 1.0), (1.1e-11, 2.0), (1.05e-11, 2.5), (1e-11, 3.0), (1e-13, 4.0),
    ))  # fmt: skip
    assert Benchmark(rows=rows, orders={}, complete=True).front("sphere") == list(rows[:4])
