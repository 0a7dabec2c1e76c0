"""Orders of rows, the short table and the front."""

import numpy as np
import pytest

from contactlab.study import work_precision
from contactlab.study.benchmark import Benchmark
from tests.study.bench_rows import row


def test_an_order_is_that_of_rows_that_count():
    ladder = [row(error=100.0 * h**-1.5, options=f"steps={h}, annuli=7") for h in (10, 20, 40)]
    order = work_precision._order
    assert order(ladder) == pytest.approx(1.5)
    assert np.isnan(order(ladder[:2]))
    finest = [row(error=1e-11, options="steps=80"), row(error=0.5e-11, options="steps=160")]
    assert order([*ladder, *finest]) == pytest.approx(1.5)  # rounding
    failed = row(error=7.0, failed=1, options="steps=80")
    assert order([*ladder, failed]) == pytest.approx(1.5)
    ruled = [row(error=h**-2.0, options=f"tolerance={h}") for h in (1, 2, 4)]
    assert np.isnan(order(ruled))
    assert np.isnan(order([row(error=h**-2.0, options="") for h in (1, 2, 4)]))
    # Half a unit of log error is enough.
    for gain, known in ((0.49, False), (0.51, True)):
        flat = [row(error=np.exp(-gain * k / 2.0), options=f"steps={10 * 2**k}") for k in range(3)]
        assert np.isfinite(order(flat)) == known
        if known:
            assert order(flat) == pytest.approx(gain / 2.0 / np.log(2.0))


def test_a_law_that_comes_nearer_by_a_factor_of_two_converges():
    def marks(*errors):
        listed = [row(error=each, converges=False) for each in errors]
        return [each.converges for each in work_precision._with_nearer(listed)]

    assert marks(0.4, 0.3, 0.19) == [True] * 3
    assert marks(0.4, 0.1, 0.21) == [False] * 3
    assert marks(0.4, 0.2) == [False] * 2
    other = work_precision._with_nearer([
        row(error=0.4, converges=False), row(error=0.1, failed=1, converges=False),
        row(error=0.4, method="b"),
    ])  # fmt: skip
    assert [each.converges for each in other] == [False, False, True]


def test_rows_without_words_converge_and_know_nothing_elsewhere():
    plain = row()
    assert plain.converges
    assert np.isnan(plain.elsewhere_rms)
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
    assert Benchmark(rows=rows, orders={}, complete=True).front() == list(rows[:4])
