"""Rows of the benchmark: errors, gaps, times and orders, of runs that are written out."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

from contactlab import Scene, Simulation, create
from contactlab.contracts.status import Status
from contactlab.study import work_precision
from contactlab.study.bench_methods import Method
from contactlab.study.benchmark import Benchmark, Row
from contactlab.study.work_precision import Truth, bench

SPRINGS = Method(tangential="springs", integrator="symplectic")
ONE = Scene.nondimensional(psi1=1.2, chi=1.4)


def row(error=1.0, time=1.0, options="steps=10", failed=0, method="a", **entries):
    names = {
        "error_worst": error, "force_error_rms": error, "books_worst": 0.0, "sweep_time_s": time,
        "status": "SUCCESS",
    }  # fmt: skip
    return Row(method=method, options=options, error_rms=error, time_s=time, failed=failed,
               **(names | entries))  # fmt: skip


class Clock:
    """A clock that goes on by a step at each look."""

    def __init__(self, step):
        self.looks, self.step = itertools.count(), step

    def perf_counter(self):
        return self.step * next(self.looks)


def answer(change=0.0, *, status=Status.SUCCESS, imbalance=0.0, checked=True):
    energy = SimpleNamespace(relative_imbalance=imbalance, checked=checked)
    return SimpleNamespace(psi_change=change, status=status, energy=energy)


def measured(answers, truths, monkeypatch, *, alone=1e-3, forces=(0.0, 0.0)):
    """The row of scripted answers; each scene is run, then followed."""
    answers, forces = iter(answers), iter(forces)
    simulation = SimpleNamespace(
        run=lambda *_, **__: next(answers), tangential=create("tangential.springs")
    )
    swept = []
    monkeypatch.setattr(Method, "simulation", lambda *_: simulation)
    monkeypatch.setattr(work_precision, "_least_time", lambda *_: alone)
    monkeypatch.setattr(work_precision, "_sweep_time", lambda *_: swept.append(1) or 1e-6)
    monkeypatch.setattr(work_precision, "_elsewhere_rms", lambda *_, **__: 0.125)
    monkeypatch.setattr(work_precision, "_force_error", lambda *_: next(forces))
    listed = [Truth(ONE, change, None) for change in truths]
    options = {"tangential": {"springs": 4}, "integrator": {"tolerance": 1e-3}}
    return work_precision._row(SPRINGS, options, listed, quick=True), swept


def test_a_row_has_rms_and_largest_errors(monkeypatch):
    answers = [answer(-1.0, imbalance=-0.3), answer(-2.0, imbalance=0.1), answer(), answer()]
    found, swept = measured(answers, [-1.3, -1.6], monkeypatch, forces=(0.3, 0.4))
    assert found.error_rms == pytest.approx(np.sqrt((0.09 + 0.16) / 2.0))
    assert found.error_worst == pytest.approx(0.4)
    assert found.force_error_rms == pytest.approx(np.sqrt((0.09 + 0.16) / 2.0))
    assert found.books_worst == 0.3
    assert (found.method, found.options) == ("springs / symplectic", "springs=4, tolerance=0.001")
    assert (found.failed, found.status, found.ok) == (0, "SUCCESS", True)
    assert (found.time_s, found.sweep_time_s, found.elsewhere_rms) == (1e-3, 1e-6, 0.125)
    assert found.converges
    assert swept == [1]


@pytest.mark.parametrize(("alone", "swept"), [(0.099, [1]), (0.1, [])])
def test_slow_methods_are_not_swept(alone, swept, monkeypatch):
    found, ran = measured([answer(), answer()], [0.0], monkeypatch, alone=alone)
    assert ran == swept
    assert np.isnan(found.sweep_time_s) == (not swept)


@pytest.mark.parametrize("place", range(4))
def test_a_run_that_failed_leaves_a_gap(place, monkeypatch):
    """Whether by itself or followed, of the first scene or the second."""
    answers = [answer() for _ in range(4)]
    answers[place] = answer(status=Status.UNSETTLED)
    found, swept = measured(answers, [0.0, 0.0], monkeypatch)
    assert (found.failed, found.status, found.ok, swept) == (1, "UNSETTLED", False, [])
    gaps = (
        found.error_rms, found.error_worst, found.force_error_rms, found.books_worst,
        found.time_s, found.sweep_time_s, found.elsewhere_rms,
    )  # fmt: skip
    assert np.isnan(gaps).all()


def test_books_that_close_by_construction_are_no_number(monkeypatch):
    found, _ = measured([answer(checked=False), answer()], [0.0], monkeypatch)
    assert np.isnan(found.books_worst)


def test_what_is_left_out_is_a_row_of_gaps():
    found = work_precision._left_out(SPRINGS, {"tangential": {"springs": 100}, "integrator": {}})
    assert (found.options, found.failed, found.status) == ("springs=100", 1, "NOT_RUN")
    assert (found.ok, found.converges) == (False, True)
    assert np.isnan([found.error_rms, found.time_s, found.sweep_time_s, found.books_worst]).all()
    rigid = Method(tangential="coulomb", integrator="symplectic")
    assert not work_precision._left_out(rigid, {}).converges


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


def test_a_force_is_compared_at_its_own_instants_over_mu_p_max():
    """A history that is off by a constant is off by as much."""
    result = Simulation(integrator=create("integrator.events", tolerance=1e-8)).run(
        Scene.nondimensional(psi1=1.2, chi=1.4, friction_coefficient=0.2), history=True
    )
    peak = 0.2 * result.motion.maximum_force
    for share in (0.0, 0.125):
        force = result.history.tangential_force + share * peak
        other = SimpleNamespace(
            history=SimpleNamespace(time=result.history.time, tangential_force=force)
        )
        assert work_precision._force_error(other, result) == pytest.approx(share, abs=1e-9)
    assert np.isnan(work_precision._force_error(result, None))


def test_methods_are_judged_by_the_limit_of_their_law():
    def judged(tangential, normal):
        method = Method(tangential=tangential, integrator="symplectic", normal=normal)
        return work_precision._judged(method)

    assert judged("springs", "hertz") == judged("walton", "hertz") == ("hertz", "")
    assert judged("springs", "jkr") == ("jkr", "springs")
    assert judged("walton", "jkr") == ("jkr", "annulus")


def test_truths_are_exact_or_by_a_fine_law(monkeypatch):
    monkeypatch.setattr(work_precision, "scenes", lambda **words: [ONE] if words["sized"] else [])
    for change, expected in ((-0.5, float(ONE.psi(-0.5))), (None, np.nan)):
        monkeypatch.setattr(
            work_precision, "reference_for", lambda *_, change=change: lambda *_: change
        )
        (truth,) = work_precision._truths("jkr", "springs", quick=True)
        assert truth.result is None
        np.testing.assert_equal(truth.psi_change, expected)
    assert work_precision._truths("hertz", "", quick=True) == []


def test_the_error_elsewhere_is_of_elastic_contact(monkeypatch):
    truths = [Truth(ONE, -1.0, None), Truth(ONE, -2.0, None)]
    monkeypatch.setattr(work_precision, "_elsewhere", lambda **_: truths)

    def found(*answers, normal="hertz"):
        answers = iter(answers)
        method = Method(tangential="springs", integrator="symplectic", normal=normal)
        run = SimpleNamespace(run=lambda _: next(answers))
        return work_precision._elsewhere_rms(run, method, quick=True)

    assert found(answer(-1.3), answer(-1.6)) == pytest.approx(np.sqrt(0.125))
    assert np.isnan(found(answer(-1.3), answer(status=Status.UNSETTLED)))
    assert np.isnan(found(answer(-1.3), answer(-1.6), normal="jkr"))


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
