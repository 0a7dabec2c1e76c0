"""Declared and estimated errors: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import numpy as np
import pytest

from contactlab import (
    Scene,
    Simulation,
    create,
)
from tests.longer import longer
from tests.solve.any_scene import (
    BATCHES,
    EXACT,
    ONES,
)


@pytest.mark.parametrize("name", ["central", "planar"])
def test_the_exact_law_declares_its_errors(name):
    scene = BATCHES[name]
    bounds = EXACT.plan(scene).psi2_error
    assert bounds == pytest.approx(1e-9 * np.maximum(1.0, np.abs(scene.psi1)), rel=0.01)
    assert (EXACT.plan(scene).restitution_error <= 1e-9).all()
    finer = Simulation(
        tangential=create("tangential.fronts", table=False),
        integrator=create("integrator.events", tolerance=1e-12),
    ).run(scene)
    result = EXACT.run(scene)
    assert (np.abs(result.psi2 - finer.psi2) <= bounds).all()
    assert np.abs(result.normal_restitution - finer.normal_restitution).max() <= 1e-9
    assert np.array_equal(result.plan.psi2_error, bounds)
    assert f"numerical error of psi2: below {bounds.max():.2g}" in str(result.plan)


def test_in_a_mixed_batch_each_impact_has_its_own_errors():
    plan = EXACT.plan(BATCHES["mixed"])
    assert np.isfinite(plan.psi2_error).all()
    assert np.isnan(plan.restitution_error).tolist() == [False, False, True]
    for place, name in enumerate(ONES):
        alone = EXACT.plan(ONES[name])
        for error in ("psi2_error", "restitution_error"):
            assert getattr(plan[place], error) == pytest.approx(getattr(alone, error), nan_ok=True)


@pytest.mark.parametrize(("springs", "steps"), [(12, 60), *longer((50, 200))])
def test_the_normal_restitution_has_an_error_of_its_own(springs, steps):
    """Within a factor of three of the distance from the exact law, as that of psi2."""
    scene = Scene.nondimensional(psi1=np.linspace(-3.0, 3.0, 13) + 0.05, chi=1.4, lam=0.2, eta=0.5)
    rough = Simulation(
        tangential=create("tangential.springs", springs=springs),
        integrator=create("integrator.symplectic", steps=steps),
    )
    result, exact = rough.run(scene, estimate_error=True), EXACT.run(scene)
    for estimate, found, true in (
        (result.restitution_error_estimate, result.normal_restitution, exact.normal_restitution),
        (result.psi2_error_estimate, result.psi2, exact.psi2),
    ):
        ratio = np.asarray(estimate) / np.abs(found - true)
        assert np.mean((ratio > 1 / 3) & (ratio < 3.0)) > 0.9
        assert ratio.min() > 0.3
    assert np.isnan(result.plan.restitution_error).all()
    assert "numerical error of the normal restitution: the laws state no bound" in str(result.plan)


@pytest.mark.slow
def test_estimates_of_a_history_are_those_of_its_march():
    """The march of a batch with one time axis is that of springs, for the central impact too."""
    scene = BATCHES["mixed"]
    result = EXACT.run(scene, history=True, estimate_error=True)
    distance = np.abs(result.psi2 - EXACT.run(scene).psi2)[:2, 0]
    assert result.psi2_error_estimate[:2] == pytest.approx(distance, rel=1.0)
