"""The error that a plan declares is never exceeded, and says what it is worth."""

import json
import re

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from tests.normal_laws import Damped

pytestmark = pytest.mark.slow

METHODS = [
    ("springs", "symplectic", {"springs": 12}, {"steps": 50}),
    ("springs", "paper", {}, {}),
    ("springs", "adaptive", {"springs": 20}, {"tolerance": 1e-3}),
    ("sharp_annulus", "symplectic", {}, {"steps": 60}),
    ("annulus", "symplectic", {"annuli": 20}, {}),
    ("annulus", "paper", {}, {}),
    ("fronts", "events", {}, {"tolerance": 1e-7}),
]
STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


def simulation(tangential, integrator, law_options, options):
    return Simulation(
        tangential=contactlab.create(f"tangential.{tangential}", **law_options),
        integrator=contactlab.create(f"integrator.{integrator}", **options),
    )


@pytest.mark.parametrize("method", METHODS, ids=lambda method: f"{method[0]}-{method[1]}")
def test_no_answer_is_further_off_than_declared(method):
    """Against the exact solution, over psi1 and chi, gross slip and central impact included."""
    draw = np.random.default_rng(8)
    chi = 10.0 ** draw.uniform(-1.0, 2.0, 24)
    psi1 = chi * draw.uniform(-1.0, 5.0, 24)
    psi1[:2] = 0.0, 1e6
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    result = simulation(*method).run(scene).check()
    exact = Simulation().run(scene).check()
    assert result.plan.psi2_error.shape == (24,)
    assert (np.abs(result.psi2 - exact.psi2) <= result.plan.psi2_error).all()
    assert result[5].plan.psi2_error == result.plan.psi2_error[5]
    assert result[4:8].plan.psi2_error.tolist() == result.plan.psi2_error[4:8].tolist()
    closed = ~result.plan.marched
    assert closed[:2].all()
    rounding = 1e-12 * np.maximum(1.0, np.abs(psi1)) + 1e-14 * 4.0 * chi
    assert (result.plan.psi2_error <= rounding)[closed].all()


@pytest.mark.parametrize("tangential", ["springs", "sharp_annulus"])
def test_the_declared_error_holds_beyond_the_chi_it_was_measured_at(tangential):
    """At chi from 1500 to 3000 springs were off by 1.4 times what they declared."""
    method = (tangential, "adaptive", {}, {"tolerance": 1e-4})
    psi1, chi = np.meshgrid([0.3, 0.95, 1.2], [1500.0, 3000.0])
    result = simulation(*method).run(Scene.nondimensional(psi1=psi1.ravel(), chi=chi.ravel()))
    off = np.abs(result.check().psi2 - contactlab.rebound(psi1.ravel(), chi.ravel()))
    assert (off <= result.plan.psi2_error).all()
    assert (off > 1e-3).any()


def test_the_error_is_declared_in_psi_whatever_the_units():
    scene = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.2, 1.0, 0.5, 20.0)
    same = Scene.nondimensional(psi1=scene.psi1, chi=scene.chi)
    for method in METHODS:
        plans = [simulation(*method).plan(either) for either in (scene, same)]
        assert plans[0].psi2_error == pytest.approx(plans[1].psi2_error, rel=1e-9)


def test_finer_declares_less():
    scene = Scene.nondimensional(psi1=1.2, chi=1.44)
    errors = [
        simulation("annulus", "paper", {"annuli": n}, {"steps": 10 * n}).plan(scene).psi2_error
        for n in (10, 20, 40)
    ]
    assert errors == sorted(errors, reverse=True)
    assert errors[2] == pytest.approx(errors[0] / 4.0, rel=0.1)


def test_a_coarse_method_is_told_so_before_it_runs():
    """50 annuli at chi = 1e4 miss psi2 by 0.4."""
    annulus = Simulation(tangential="annulus")
    assert "coarse" not in str(annulus.plan(Scene.nondimensional(psi1=1.2, chi=1.44)))
    plan = annulus.plan(Scene.nondimensional(psi1=1.2, chi=[1.44, 1e4]))
    assert re.search(
        r"coarse for 1 of 2 impacts: the declared numerical error is [01]\.", str(plan)
    )
    assert 0.4 < plan.psi2_error[1] < 2.7


@pytest.mark.parametrize("laws", [{"normal": Damped()}, {}])
def test_where_nothing_is_known_nothing_is_declared(laws):
    """The model was measured for elastic Hertz contacts; and a fault of one is not nothing."""
    declares = not laws
    sim = Simulation(tangential="springs", integrator="symplectic", **laws)
    plan = sim.plan(Scene.nondimensional(psi1=1.2, chi=1.44))
    assert np.isfinite(plan.psi2_error) == declares
    assert ("none is declared" in str(plan)) != declares
    assert (json.loads(json.dumps(plan.to_dict()))["psi2_error"] is None) != declares
