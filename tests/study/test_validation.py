"""Checks of an installation: findings, bounds, sources; with small sources of their own."""

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation, rebound
from contactlab.scene_file import read_scene
from contactlab.study import evidence, validation
from contactlab.study.agreement import Agreement
from contactlab.study.comparison import Comparison
from contactlab.study.evidence import Evidence, Source, simulations_over
from contactlab.study.stability_coupled import rod
from contactlab.study.validation import Finding
from tests.study.made_up import ERRORS, SERIES, SWEEP

RIGID = Simulation(tangential="coulomb")
SMOOTH = Simulation(tangential="frictionless")
FILE = f"""{SWEEP}{SERIES}{ERRORS}
[[measured]]
quantity = "psi2"
against = "psi1"
x = [5.0]
values = [1.0]
source = "made up"
"""


@pytest.fixture
def source(tmp_path, monkeypatch):
    path = tmp_path / "small.toml"
    path.write_text(FILE, encoding="utf-8")
    monkeypatch.setattr(Source, "read", lambda _: read_scene(path))
    monkeypatch.setattr(
        evidence, "simulations_over", lambda _: ({"smooth": SMOOTH, "rigid": RIGID}, {"x": "y"})
    )
    return Source(name="small", kind="experiment", bounds={("psi2", "rigid"): 0.4})


@pytest.mark.parametrize(
    ("difference", "ok"), [(0.1, True), (0.1000001, False), (0.0, True), (np.nan, False)]
)
def test_a_bound_is_met_up_to_itself(difference, ok):
    assert Finding(what="a", against="b", difference=difference, bound=0.1).ok is ok


def test_failed_laws_come_last(source):
    file = source.read()
    results = {
        name: simulation.sweep(Scene.nondimensional(psi1=[1.0, 8.0], chi=1.0))
        for name, simulation in (("failed", RIGID), ("smooth", SMOOTH), ("rigid", RIGID))
    }
    motion = attrs.evolve(results["failed"].motion, slip_velocity_change=np.array([np.nan, np.nan]))
    results["failed"] = attrs.evolve(results["failed"], motion=motion)
    agreement = Agreement(measured=file.measured[0], results=results)
    comparison = Comparison(scene=file.scene, varied={}, runs=(), agreements=(agreement,))
    gathered = Evidence(source=source, file=file, comparison=comparison, left_out={})
    assert gathered.laws == ["rigid", "smooth", "failed"]


@pytest.mark.parametrize(
    ("check", "most"),
    [("_no_friction", 1e-12), ("_slip_throughout", 1e-10), ("_first_slip", 1e-9),
     ("_stiff", 0.006)],
)  # fmt: skip
def test_eccentric_impacts_have_closed_forms_and_a_rigid_limit(check, most):
    found = getattr(validation, check)()
    assert found.what.startswith("fronts, two bodies: ")
    assert (found.bound, found.ok) == (pytest.approx(most), True)


def test_psi2_that_laws_are_checked_against_is_that_of_the_table():
    for chi, values in validation.REFERENCE_PSI2.items():
        assert rebound(validation.REFERENCE_PSI1, chi) == pytest.approx(values, abs=2e-10)


@pytest.mark.slow
def test_only_the_exact_law_has_ten_digits_of_psi2():
    found = {
        name: validation._reference(name, options, integrator, settings, bound)
        for name, options, integrator, settings, bound in validation.COMPOSITIONS
    }
    assert all(each.ok for each in found.values())
    exact = found.pop("fronts")
    declared = Simulation().plan(Scene.nondimensional(psi1=0.5, chi=1.4)).psi2_error
    assert exact.difference < exact.bound == pytest.approx(declared, rel=0.01)
    sizes = [each.difference for each in found.values()]
    assert min(sizes) > 1e-5
    assert len(set(sizes)) == len(sizes)


def test_a_rod_of_the_stiff_contacts_is_that_of_the_theory():
    """Theory §14: 30 degrees, mu .3, slip .5, kappa .8235294."""
    scene = rod(30.0, 0.3, 0.5, kappa=0.8235294)
    numbers = (scene.psi1, scene.chi, scene.lam, scene.eta)
    assert numbers == pytest.approx((1.372549, 0.764706, 0.222692, 2.037707), abs=1e-6)


def test_laws_are_named_with_a_normal_law_that_is_not_the_default():
    found, left_out = simulations_over({"hertz": {}, "tsuji": {"restitution": 0.98}})
    assert {"fronts", "springs", "walton, tsuji restitution=0.98"} <= set(found)
    assert found["springs, tsuji restitution=0.98"].normal.restitution == 0.98
    assert list(left_out) == ["fronts, tsuji restitution=0.98"]
    assert "elastic Hertz contact" in left_out["fronts, tsuji restitution=0.98"]
    plain, _ = simulations_over({"jkr": {}})
    assert "springs, jkr" in plain
