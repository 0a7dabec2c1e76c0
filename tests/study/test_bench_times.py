"""Times of the benchmark, by clocks that are written out: repeats, budgets, sweeps."""

from types import SimpleNamespace

import numpy as np
import pytest

from contactlab import Scene
from contactlab.contracts.status import Status
from contactlab.study import work_precision
from contactlab.study.work_precision import Truth, bench
from tests.study.bench_rows import ONE, SPRINGS, Clock, row


@pytest.mark.parametrize(
    ("quick", "time", "statuses"),
    [
        (True, 0.05, ["SUCCESS", "SUCCESS", "SUCCESS"]),
        (True, 0.051, ["SUCCESS", "NOT_RUN", "NOT_RUN"]),
        (False, 0.1, ["SUCCESS"] * 8),
        (False, 0.101, ["SUCCESS"] + ["NOT_RUN"] * 7),
    ],
)
def test_a_slow_method_is_not_refined(quick, time, statuses, monkeypatch):
    monkeypatch.setattr(work_precision, "_truths", lambda *_, **__: [])
    monkeypatch.setattr(work_precision, "_row", lambda method, *_, **__: row(
        method=method.name, time=time))  # fmt: skip
    found = bench([SPRINGS], quick=quick)
    assert [each.status for each in found.rows] == statuses
    assert found.complete
    assert not found.interrupted


@pytest.mark.parametrize(
    ("budget", "rows"), [(0.0, 0), (1.5, 1), (2.0, 2), (2.5, 2), (9.0, 3), (np.inf, 3)]
)
def test_a_budget_is_asked_before_each_resolution(budget, rows, monkeypatch):
    """The clock goes on by a second at each look."""
    monkeypatch.setattr(work_precision, "time", Clock(1.0))
    monkeypatch.setattr(work_precision, "_truths", lambda *_, **__: [])
    monkeypatch.setattr(work_precision, "_row", lambda *_, **__: row(time=0.0))
    found = bench([SPRINGS], quick=True, budget=budget)
    assert len(found.rows) == rows
    assert found.complete == (rows == 3)


def test_interrupted_rows_are_kept(monkeypatch):
    answers = iter([row(time=0.0), row(time=0.0)])

    def run(*_, **__):
        for answer in answers:
            return answer
        raise KeyboardInterrupt

    monkeypatch.setattr(work_precision, "_truths", lambda *_, **__: [])
    monkeypatch.setattr(work_precision, "_row", run)
    found = bench([SPRINGS], quick=True)
    assert (len(found.rows), found.interrupted, found.complete) == (2, True, False)


def test_the_function_of_the_table_counts_as_a_row(monkeypatch):
    monkeypatch.setattr(work_precision, "_truths", lambda *_, **__: [])
    monkeypatch.setattr(work_precision, "_row", lambda *_, **__: row(time=0.0))
    monkeypatch.setattr(work_precision, "_rebound_row", lambda **_: row(time=0.0))
    found = bench([SPRINGS], quick=True, with_rebound=True)
    assert (len(found.rows), found.complete) == (4, True)


def test_the_least_time_is_the_mean_over_scenes_of_the_quickest_run(monkeypatch):
    """The clock ticks at each look; a run takes what it adds."""
    clock = SimpleNamespace(now=0.0)
    clock.perf_counter = lambda: clock.now
    takes = iter([9.0, 5.0, 2.0, 3.0, 4.0, 6.0, 9.0, 8.0, 7.0, 8.0, 9.0, 9.0])

    def run(_):
        clock.now += 1e-3 * next(takes)

    monkeypatch.setattr(work_precision, "time", clock)
    found = work_precision._least_time(SimpleNamespace(run=run), [ONE, ONE])
    assert found == pytest.approx(1e-3 * (2.0 + 7.0) / 2.0)
    assert next(takes, None) is None


def test_long_runs_are_timed_once(monkeypatch):
    """More than a second has gone: one run after the warm-up is enough."""
    clock = SimpleNamespace(now=0.0)
    clock.perf_counter = lambda: clock.now
    ran = []

    def run(_):
        ran.append(1)
        clock.now += 0.6

    monkeypatch.setattr(work_precision, "time", clock)
    assert work_precision._least_time(SimpleNamespace(run=run), [ONE]) == pytest.approx(0.6)
    assert len(ran) == 2


@pytest.mark.parametrize(
    # Two seconds of impacts one by one, from 50 to 1000.
    ("alone", "size"),
    [(1e-6, 1000), (2e-3, 1000), (1e-2, 200), (0.5, 50)],
)
def test_a_sweep_is_as_long_as_its_budget(alone, size, monkeypatch):
    clock = SimpleNamespace(now=0.0)
    clock.perf_counter = lambda: clock.now
    swept, takes = [], iter([3.0, 2.0])

    def sweep(batch):
        swept.append(batch.shape)
        clock.now += next(takes)
        return SimpleNamespace(status=Status.SUCCESS)

    monkeypatch.setattr(work_precision, "time", clock)
    found = work_precision._sweep_time(SimpleNamespace(sweep=sweep), alone)
    assert found == pytest.approx(2.0 / size)
    assert swept == [(size,)] * 2


def test_swept_scenes_are_solid_spheres_that_stick_somewhere():
    batch = work_precision._swept_scenes()
    assert batch.shape == (1000,)
    assert batch.chi.min() == pytest.approx(1.17, abs=1e-3)
    assert batch.chi.max() == pytest.approx(1.75, abs=1e-3)
    np.testing.assert_allclose(batch.chi[:3], 1.17 + 0.58 * np.array([0.0, 0.618034, 0.236068]))
    assert batch.psi1[0] == pytest.approx(0.01)
    assert (batch.psi1 < 4.0 * batch.chi - 1.0).all()
    assert batch.psi1[-1] == pytest.approx(4.0 * batch.chi[-1] - 1.01)
    # Each share of the range is met at light and at heavy inertia.
    for part in np.array_split(batch.chi, 20):
        assert part.min() < 1.2 < 1.7 < part.max()


def test_the_function_of_the_table_has_its_errors_and_its_times(monkeypatch):
    """Off by 0.3 and -0.4 here, by 0.5 elsewhere; the clock goes on by a second at each look."""
    answers = {1.0: 0.5 + 0.3, 2.0: 1.0 - 0.4, 3.0: 2.0 + 0.5}
    called = []

    def rebound(psi1, chi):
        called.append(np.shape(psi1))
        return psi1 if np.ndim(psi1) else answers[float(psi1)]

    def truth(psi1, change):
        return Truth(Scene.nondimensional(psi1=psi1, chi=1.5), change, None)

    monkeypatch.setattr(work_precision, "rebound", rebound)
    monkeypatch.setattr(
        work_precision, "_truths", lambda *_, **__: [truth(1.0, -0.5), truth(2.0, -1.0)]
    )
    monkeypatch.setattr(work_precision, "_elsewhere", lambda **_: [truth(3.0, -1.0)])
    monkeypatch.setattr(work_precision, "time", Clock(1.0))
    found = work_precision._rebound_row(quick=True)
    assert found.error_rms == pytest.approx(np.sqrt(0.125))
    assert found.error_worst == pytest.approx(0.4)
    assert found.elsewhere_rms == pytest.approx(0.5)
    assert found.time_s == pytest.approx(1.0 / (20 * 2))
    assert found.sweep_time_s == pytest.approx(1.0 / 1000)
    assert (called.count(()), called.count((1000,))) == (2 + 1 + 5 * 2 * 20, 20)
    assert (found.method, found.options, found.status, found.failed) == (
        "rebound()", "", "SUCCESS", 0
    )  # fmt: skip
    assert np.isnan([found.force_error_rms, found.books_worst]).all()
