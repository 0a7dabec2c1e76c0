"""Maps of errors over steps and chi, and model errors, of answers that are written out."""

from types import SimpleNamespace

import numpy as np
import pytest

from contactlab import Scene, Simulation, create
from contactlab.compose.registry import REGISTRY
from contactlab.contracts.error_model import range_of
from contactlab.contracts.status import Status
from contactlab.study import error_map as study
from contactlab.study import model_error as model
from contactlab.study.bench_methods import Method
from contactlab.study.error_map import CHIS, STEPS, error_map, error_maps
from contactlab.study.model_error import model_error

SPRINGS = Method(tangential="springs", integrator="symplectic")


def test_the_cells_go_from_light_shells_to_heavy_cores():
    assert (len(CHIS), len(STEPS)) == (36, 22)
    np.testing.assert_allclose(np.diff(np.log(CHIS)), np.log(600.0) / 35.0, rtol=1e-9)
    assert (CHIS[0], CHIS[-1]) == pytest.approx((0.05, 30.0))
    assert (STEPS[0], STEPS[-1]) == (2, 400)
    growth = np.diff(np.log(STEPS[7:]))
    assert growth.min() > 0.2 < growth.max() < 0.35
    assert len(study.QUICK_CHIS) == 9
    assert (study.QUICK_CHIS[0], study.QUICK_CHIS[-1]) == pytest.approx((0.05, 30.0))
    assert study.QUICK_STEPS == (3, 9, 30, 100)


def test_a_cell_holds_the_largest_error_of_its_impacts(monkeypatch):
    """The answer is off by chi over the steps, ten times at psi1 = 0.95; refused at 9 steps."""
    seen = []

    def psi2(simulation, scene):
        exact = np.sin(scene.psi1)
        march = simulation.integrator
        if not hasattr(march, "steps"):
            seen.append((type(simulation.tangential), march.tolerance))
            return exact
        seen.append((type(simulation.tangential), march.steps, march.refine))
        off = scene.chi / march.steps * np.where(scene.psi1 == 0.95, -10.0, 1.0)
        return exact + np.where((march.steps == 9) & (scene.psi1 == 1.2), np.nan, off)

    monkeypatch.setattr(study, "_psi2", psi2)
    found = error_map(SPRINGS, quick=True)
    assert (found.law, found.integrator, found.converges) == ("springs", "symplectic", True)
    assert (found.steps, found.chis) == (study.QUICK_STEPS, study.QUICK_CHIS)
    expected = 10.0 * np.array(found.chis) / np.array(found.steps)[:, None]
    expected[1] = np.nan
    np.testing.assert_allclose(found.error, expected)
    fronts, springs = (REGISTRY.law_class(f"tangential.{name}") for name in ("fronts", "springs"))
    assert seen[0] == (fronts, 1e-9)
    assert seen[1:] == [(springs, steps, False) for steps in (3, 9, 30, 100)]


def test_another_limit_is_ten_times_the_most_steps():
    limit = study._limit(create("tangential.mindlin_cap"))
    assert limit.integrator.steps == 4000 == 10 * STEPS[-1]
    assert type(limit.tangential) is REGISTRY.law_class("tangential.mindlin_cap")


def test_each_law_is_mapped_once_under_its_usual_integrator(monkeypatch):
    monkeypatch.setattr(study, "error_map", lambda method, *, quick: (method.name, quick))

    def method(tangential, integrator, normal="hertz"):
        return Method(tangential=tangential, integrator=integrator, normal=normal)

    listed = [
        method("annulus", "paper"), method("springs", "paper"), method("springs", "symplectic"),
        method("springs", "adaptive"), method("walton", "symplectic"),
        method("linear_spring", "adaptive"), method("mindlin_cap", "symplectic", "jkr"),
    ]  # fmt: skip
    assert error_maps(listed, quick=True) == [
        ("annulus / paper", True), ("springs / symplectic", True)
    ]  # fmt: skip
    assert error_maps(listed[:1]) == [("annulus / paper", False)]


def test_refused_impacts_have_no_psi2():
    result = SimpleNamespace(
        status=np.array([Status.SUCCESS, Status.TOO_FEW_STEPS], dtype=object),
        psi2=np.array([0.25, 0.5]),
    )
    found = study._psi2(SimpleNamespace(sweep=lambda _: result), None)
    np.testing.assert_array_equal(found, [0.25, np.nan])


def answers(monkeypatch, exact, own, *, run=None, declared=0.0):
    """Script the exact change, that of the law's reference, and a run with its declared error."""
    monkeypatch.setattr(model, "continuum", lambda *_: exact)
    monkeypatch.setattr(model, "reference_for", lambda *_: lambda *_: own)
    success = Status.SUCCESS if run is not None else Status.UNSETTLED
    result = SimpleNamespace(
        status=success,
        motion=SimpleNamespace(slip_velocity_change=run),
        plan=SimpleNamespace(psi2_error=declared),
    )
    known = Simulation(tangential="walton")
    monkeypatch.setattr(
        model, "Simulation", lambda **_: SimpleNamespace(run=lambda _: result, normal=known.normal)
    )


def error_of(law):
    """The model error of a law at psi1 = 1.2, chi = 3: the range is 2.4."""
    scene = Scene.nondimensional(psi1=1.2, chi=3.0)
    assert range_of(scene).width == pytest.approx(2.4)
    return model._error(create(f"tangential.{law}"), 1.2, 3.0)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_model_error_is_the_distance_of_two_exact_answers(monkeypatch, side):
    answers(monkeypatch, -1.0, -1.0 + side * 0.6)
    assert error_of("linear_spring") == pytest.approx(0.25)
    answers(monkeypatch, -1.0, None)
    assert np.isnan(error_of("linear_spring"))
    answers(monkeypatch, None, -1.0)
    assert np.isnan(error_of("linear_spring"))
    answers(monkeypatch, -1.0, -1.0)
    assert error_of("linear_spring") == 0.0


def test_whole_impacts_without_a_reference_are_their_own(monkeypatch):
    answers(monkeypatch, -1.0, None, run=-1.6)
    assert error_of("walton") == pytest.approx(0.25)
    answers(monkeypatch, -1.0, None)
    assert np.isnan(error_of("walton"))


@pytest.mark.parametrize(
    ("own", "run", "declared", "known"),
    [
        # The doubling changes by less than the distance, or more.
        (-1.6, -1.1, 0.0, True), (-1.6, -2.3, 0.0, False), (-1.6, -2.19, 0.0, True),
        # So does the declared error.
        (-1.6, -1.6, 0.59, True), (-1.6, -1.6, 0.61, False), (-1.6, -1.6, np.nan, True),
        # A run that failed shows nothing; rounding is 1e-12 of the range.
        (-1.6, None, 0.0, False),
        (-1.0 + 2.3e-12, -1.0 + 2.3e-12, 0.0, False), (-1.0 + 2.6e-12, -1.0 + 2.6e-12, 0.0, True),
    ],
)  # fmt: skip
def test_a_law_with_a_resolution_is_known_to_its_own_uncertainty(
    monkeypatch, own, run, declared, known
):
    answers(monkeypatch, -1.0, own, run=run, declared=declared)
    found = error_of("halfspace")
    assert np.isfinite(found) == known
    if known:
        assert found == pytest.approx(abs(own + 1.0) / 2.4, rel=1e-3)


def test_the_largest_over_the_incidences_counts(monkeypatch):
    table = {(1.0, 0.5): 0.1, (2.0, 0.5): 0.3, (1.0, 3.0): np.nan, (2.0, 3.0): 0.2}
    monkeypatch.setattr(model, "_error", lambda _, psi1, chi: table[psi1, chi])
    found = model_error("coulomb", (0.5, 3.0), (1.0, 2.0))
    assert (found.law, found.chis) == ("coulomb", (0.5, 3.0))
    assert found.error.tolist() == [0.3, 0.2]
    some = model_error("coulomb", (0.5, 3.0), (1.0,))
    np.testing.assert_array_equal(some.error, [0.1, np.nan])
    assert model_error("coulomb", (3.0,), (1.0,)) is None
    assert model_error("springs", (0.5,), (1.0,)) is None
