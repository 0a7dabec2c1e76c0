"""Rows of the benchmark: errors and gaps, of runs that are written out."""

from types import SimpleNamespace

import numpy as np
import pytest

from contactlab import Scene, Simulation, create
from contactlab.contracts.status import Status
from contactlab.study import work_precision
from contactlab.study.bench_methods import Method
from contactlab.study.work_precision import Truth
from tests.study.bench_rows import ONE, SPRINGS, answer


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
