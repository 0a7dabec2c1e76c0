"""Checks of an installation: findings, bounds, sources; with small sources of their own."""

import itertools
from types import SimpleNamespace

import attrs
import numpy as np
import pytest

from contactlab import Scene, Simulation
from contactlab.scene_file import read_scene
from contactlab.study import validation
from contactlab.study.comparison import Agreement, Comparison
from contactlab.study.stability_eccentric import rod
from contactlab.study.validation import (
    REFERENCE_PSI1,
    REFERENCE_PSI2,
    SOURCES,
    Evidence,
    Finding,
    Source,
    gather,
    hertz_scalars,
    judged,
    simulations_over,
    validate,
)
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
        validation, "simulations_over", lambda _: ({"smooth": SMOOTH, "rigid": RIGID}, {"x": "y"})
    )
    return Source(name="small", kind="experiment", bounds={("psi2", "rigid"): 0.4})


@pytest.mark.parametrize(
    ("difference", "ok"), [(0.1, True), (0.1000001, False), (0.0, True), (np.nan, False)]
)
def test_a_bound_is_met_up_to_itself(difference, ok):
    assert Finding(what="a", against="b", difference=difference, bound=0.1).ok is ok


def test_evidence_ranks_laws_and_knows_scatter_and_bounds(source):
    found = validation._evidence(source, curves=False)
    assert found.laws == ["rigid", "smooth"]  # off by 0.36 and by 3.2
    first, second = found.comparison.agreements
    assert found.scatter(first) == pytest.approx(0.2)  # of the errors that are stated
    assert np.isnan(found.scatter(second))
    assert found.bound("psi2", "rigid") == 0.4
    assert found.bound("psi2", "smooth") is None
    assert found.bound("psi1", "rigid") is None
    assert found.left_out == {"x": "y"}
    assert found.comparison.runs == ()
    drawn = validation._evidence(source, curves=True).comparison
    assert drawn.names == ["smooth", "rigid"]
    np.testing.assert_allclose(drawn.values("psi2", "rigid"), [0.0, 0.0, 2.0], atol=1e-12)
    assert np.isnan(drawn.runs[0].run_time_per_impact)


def test_only_laws_with_a_bound_are_judged(source):
    first, second = judged(validation._evidence(source, curves=False))
    assert (first.what, first.against) == ("rigid: psi2, rms", "experiment: small")
    assert first.difference == pytest.approx(np.sqrt(0.13))
    assert first.ok
    assert (second.difference, second.bound) == (pytest.approx(0.0, abs=1e-12), 0.4)


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
    evidence = Evidence(source=source, file=file, comparison=comparison, left_out={})
    assert evidence.laws == ["rigid", "smooth", "failed"]


def test_sources_are_gathered_one_by_one(source, monkeypatch):
    monkeypatch.setattr(validation, "SOURCES", (source, source))
    seen = []
    found = gather(progress=lambda *count: seen.append(count))
    next(found)
    assert seen == []
    assert len(list(found)) == 1
    assert seen == [(1, 2), (2, 2)]
    assert all(not each.comparison.runs for each in gather())
    assert all(each.comparison.runs for each in gather(curves=True))
    assert len(list(gather())) == 2


def test_checks_are_told_as_they_are_done(monkeypatch):
    numbers = itertools.count()
    monkeypatch.setattr(validation, "_checks", lambda: [lambda: next(numbers)] * 3)
    seen = []
    assert list(validate(progress=lambda *count: seen.append(count))) == [0, 1, 2]
    assert seen == [(1, 3), (2, 3), (3, 3)]
    assert list(validate()) == [3, 4, 5]


def test_the_list_of_checks_is_that_of_the_laws_installed(monkeypatch):
    def listed():
        return [getattr(check, "func", check).__name__ for check in validation._checks()]

    full = ["_hertz", "_rigid", *["_reference"] * 5, *["_scalars"] * 6]
    full += ["_no_friction", "_slip_throughout", "_first_slip", "_stiff", *["_codes"] * 3]
    assert listed() == full
    named = [check.args for check in validation._checks() if hasattr(check, "args")]
    of_scalars = [args for args in named if isinstance(args[0], validation.Scalars)]
    assert [(case.name, names, bound) for case, names, bound in of_scalars] == [
        ("test 1, glass", ("force",), 0.003),
        ("test 1, glass", ("approach", "duration"), 0.01),
        ("test 1, limestone", ("force",), 0.003),
        ("test 2, aluminium", ("force",), 0.003),
        ("test 2, aluminium", ("approach", "duration"), 0.01),
        ("test 2, magnesium", ("force",), 0.003),
    ]
    laws = ["tangential.coulomb", "integrator.symplectic", "tangential.springs"]
    monkeypatch.setattr(validation, "REGISTRY", SimpleNamespace(names=lambda: laws))
    assert listed() == ["_hertz", "_rigid", "_reference", *["_scalars"] * 6]
    laws.remove("integrator.symplectic")
    assert "_reference" not in listed()


def test_a_finding_tells_the_largest_difference_and_its_options(monkeypatch):
    """Every reference is shifted: by 0.25 at one place of the first chi, by 0.5 at the last."""
    shifts = {chi: np.zeros(7) for chi in REFERENCE_PSI2}
    shifts[49 / 34][2], shifts[3.0][6] = 0.25, -0.5
    monkeypatch.setattr(validation, "REFERENCE_PSI2", {
        chi: tuple(np.array(values) + shifts[chi]) for chi, values in REFERENCE_PSI2.items()
    })  # fmt: skip
    found = validation._reference("fronts", {}, "events", {"tolerance": 1e-8}, 1e-9)
    assert found.difference == pytest.approx(0.5, abs=1e-7)
    assert not found.ok
    assert (found.what, found.bound) == ("fronts / events, tolerance=1e-08", 1e-9)
    assert found.against == "21 reference values of psi2"
    assert validation._reference("fronts", {}, "events", {}, 1.0).what == "fronts / events"
    assert len(REFERENCE_PSI1) == 7


def test_closed_forms_have_small_bounds_and_are_met():
    for check, words, bound in (
        (validation._hertz, "hertz: duration and restitution", 1e-9),
        (validation._rigid, "coulomb: psi2", 1e-12),
    ):
        found = check()
        assert (found.what, found.bound, found.ok) == (words, bound, True)
        assert found.difference < bound


@pytest.mark.parametrize(
    ("check", "most"),
    [("_no_friction", 1e-12), ("_slip_throughout", 1e-10), ("_first_slip", 1e-9),
     ("_stiff", 0.006)],
)  # fmt: skip
def test_eccentric_impacts_have_closed_forms_and_a_rigid_limit(check, most):
    found = getattr(validation, check)()
    assert found.what.startswith("fronts, two bodies: ")
    assert (found.bound, found.ok) == (pytest.approx(most), True)


def test_a_rod_of_the_stiff_contacts_is_that_of_the_theory():
    """Theory §14: 30 degrees, mu .3, slip .5, kappa .8235294."""
    scene = rod(30.0, 0.3, 0.5, kappa=0.8235294)
    numbers = (scene.psi1, scene.chi, scene.lam, scene.eta)
    assert numbers == pytest.approx((1.372549, 0.764706, 0.222692, 2.037707), abs=1e-6)


def hertz(case):
    """Force, approach and duration by the closed forms of two spheres, or a sphere on a plane."""
    sphere = case.scene.sphere
    young, nu = sphere.material.young_modulus, sphere.material.poisson_ratio
    mass = sphere.material.density * 4.0 / 3.0 * np.pi * sphere.radius**3
    alike = case.name.startswith("test 1")
    modulus = young / (1.0 - nu**2) / (2.0 if alike else 1.0)
    radius, reduced = (sphere.radius / 2.0, mass / 2.0) if alike else (sphere.radius, mass)
    speed = 20.0 if alike else 0.2
    stiffness = 4.0 / 3.0 * modulus * radius**0.5
    approach = (1.25 * reduced * speed**2 / stiffness) ** 0.4
    return stiffness * approach**1.5, approach, 2.9432751843247 * approach / speed


def test_published_scalars_are_those_of_hertz():
    """To the bounds of reading off a figure."""
    for case in hertz_scalars():
        force, approach, duration = hertz(case)
        assert case.force == pytest.approx(force, rel=0.003)
        if case.approach is not None:
            assert case.approach == pytest.approx(approach, rel=0.01)
            assert case.duration == pytest.approx(duration, rel=0.01)
        found = validation._scalars(case, ("force",), 0.003)
        assert found.difference == pytest.approx(abs(force / case.force - 1.0), rel=1e-6)
        assert found.what == f"hertz: {case.name}, force"


def test_two_scalars_are_judged_by_the_worse():
    case = hertz_scalars()[0]._replace(approach=hertz(hertz_scalars()[0])[1])
    found = validation._scalars(case, ("approach", "duration"), 0.01)
    off = abs(hertz(case)[2] / case.duration - 1.0)
    assert found.difference == pytest.approx(off, rel=1e-5)
    assert found.what == "hertz: test 1, glass, approach and duration"
    missing = validation._scalars(case._replace(duration=None), ("approach", "duration"), 0.01)
    assert missing.what == "hertz: test 1, glass, approach"
    assert missing.difference < 1e-9


def test_laws_are_named_with_a_normal_law_that_is_not_the_default():
    found, left_out = simulations_over({"hertz": {}, "tsuji": {"restitution": 0.98}})
    assert {"fronts", "springs", "walton, tsuji restitution=0.98"} <= set(found)
    assert found["springs, tsuji restitution=0.98"].normal.restitution == 0.98
    assert list(left_out) == ["fronts, tsuji restitution=0.98"]
    assert "elastic_hertz" in left_out["fronts, tsuji restitution=0.98"]
    plain, _ = simulations_over({"jkr": {}})
    assert "springs, jkr" in plain


def test_sources_have_the_normal_laws_and_bounds_that_are_told():
    assert [(source.name, source.kind) for source in SOURCES] == [
        ("kharaz2001", "experiment"), ("finite-elements", "finite elements"),
        ("codes-test4-oxide", "other codes"), ("codes-test4-alloy", "other codes"),
        ("codes-mfix", "other codes"),
    ]  # fmt: skip
    assert SOURCES[0].normals == {"hertz": {}, "tsuji": {"restitution": 0.98}}
    assert all(source.normals == {"hertz": {}} for source in SOURCES[1:])
    assert [sorted(set(source.bounds.values())) for source in SOURCES] == [
        [0.015], [0.06], [0.006], [0.006], [0.006]
    ]  # fmt: skip
