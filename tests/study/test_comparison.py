"""Laws side by side: values, differences, agreement with measurements, timing, interruption.

A rigid body has psi2 = 0 up to psi1 = 4 chi and psi1 - 4 chi beyond; without friction it is psi1.
"""

import itertools
from types import SimpleNamespace

import attrs
import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create, rebound
from contactlab.contracts.status import Status
from contactlab.scene_file import read_scene
from contactlab.study import comparison as study
from contactlab.study.agreement import Agreement
from contactlab.study.comparison import compare
from tests.study.made_up import LAWS, SERIES, SWEEP

PSI1 = [0.5, 2.0, 6.0]
SCENES = Scene.nondimensional(psi1=PSI1, chi=1.0)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "measured.toml"
    path.write_text(SWEEP + SERIES, encoding="utf-8")
    return read_scene(path)


@pytest.fixture(scope="module")
def both():
    return compare(SCENES, LAWS)


def failed(run, *places):
    """The run of a law, of which the impacts at ``places`` failed."""
    status = np.array([Status.SUCCESS] * 3, dtype=object)
    status[list(places)] = Status.UNSETTLED
    motion = attrs.evolve(run.result.motion, status=status, detail=np.array(["odd"] * 3))
    return attrs.evolve(run, result=attrs.evolve(run.result, motion=motion))


def test_values_and_differences_are_those_of_the_laws(both):
    assert both.names == ["rigid", "smooth"]
    np.testing.assert_allclose(both.values("psi2", "rigid"), [0.0, 0.0, 2.0], atol=1e-12)
    np.testing.assert_allclose(both.difference("psi2", "smooth"), [0.5, 2.0, 4.0])
    assert (both.difference("psi2", "rigid") == 0.0).all()
    assert both.failures() == []
    assert not both.interrupted
    assert list(both.varied) == ["psi1"]
    np.testing.assert_array_equal(both.varied["psi1"], PSI1)


def test_a_law_is_exact_elastic_or_rigid_by_what_it_claims_and_declares():
    names = {"fronts": "exact", "springs": "elastic", "coulomb": "rigid", "walton": ""}
    found = compare(SCENES, {name: Simulation(tangential=name) for name in names})
    assert {name: found.model(name) for name in names} == names
    exact = rebound(np.array(PSI1), 1.0)
    assert np.abs(found.values("psi2", "fronts") - exact).max() < study.EXACT
    assert np.abs(found.values("psi2", "springs") - exact).max() > study.EXACT


def test_some_of_the_laws_are_taken_with_their_agreements(file):
    found = compare(file, LAWS).only(["smooth", "no such law"])
    assert found.names == ["smooth"]
    assert list(found.agreements[0].results) == ["smooth"]


def test_agreement_is_predicted_less_measured(file):
    """psi2 of the rigid law is 0 and 4: off by -0.1 and 0.5."""
    (agreement,) = compare(file, LAWS).agreements
    np.testing.assert_allclose(agreement.difference("rigid"), [-0.1, 0.5], atol=1e-12)
    assert agreement.rms("rigid") == pytest.approx(np.sqrt(0.13))
    assert agreement.largest("rigid") == pytest.approx(0.5)
    assert agreement.where_largest("rigid") == 8.0
    assert agreement.largest("smooth") == pytest.approx(4.5)
    assert agreement.unit == "1"
    other = attrs.evolve(agreement.measured, values=np.array([0.9, 3.5]))
    below = Agreement(measured=other, results=agreement.results)
    assert below.where_largest("rigid") == 1.0
    assert below.largest("rigid") == pytest.approx(0.9)


def test_where_an_impact_failed_is_not_a_number(both):
    found = attrs.evolve(both, runs=(both.runs[0], failed(both.runs[1], 1)))
    np.testing.assert_array_equal(found.values("psi2", "smooth"), [0.5, np.nan, 6.0])
    (sentence,) = found.failures()
    assert sentence.startswith("smooth (1 of 3): The tangential law found no division")
    agreement = Agreement(
        measured=SimpleNamespace(quantity="psi2", values=np.zeros(3), x=np.array(PSI1)),
        results={"smooth": found.runs[1].result},
    )
    assert np.isnan(agreement.where_largest("smooth"))
    assert np.isnan(agreement.rms("smooth"))
    told = attrs.evolve(found, agreements=(agreement,)).failures()
    assert told[0] == sentence
    assert told[1].startswith("smooth, at the measured values of psi2 (1 of 3): The tan")


def test_a_point_without_a_number_takes_none_of_the_others_with_it():
    """Without tangential velocity e_t is 0/0; a failed impact has an e_t that is not known."""
    steel = Material.named("steel")
    angles = np.array([0.0, 40.0, 60.0])
    scene = Scene.at_angle(Sphere(0.01, steel), HalfSpace(steel), 0.1, speed=1.0, angle_deg=angles)
    result = Simulation(tangential="coulomb").run(scene)
    measured = SimpleNamespace(
        quantity="tangential_restitution", x=angles,
        values=np.nan_to_num(result.tangential_restitution) + np.array([0.8, 0.01, -0.03]),
    )  # fmt: skip
    found = Agreement(measured=measured, results={"rigid": result})
    assert found.defined.tolist() == [False, True, True]
    assert found.rms("rigid") == pytest.approx(np.sqrt(5e-4))
    assert (found.largest("rigid"), found.where_largest("rigid")) == (pytest.approx(0.03), 60.0)
    assert not found.opposite
    first = Agreement(
        measured=SimpleNamespace(
            **vars(measured) | {"values": measured.values[:1], "x": angles[:1]}
        ),
        results={"rigid": Simulation(tangential="coulomb").run(scene.take(slice(0, 1)))},
    )
    assert np.isnan(
        [first.rms("rigid"), first.largest("rigid"), first.where_largest("rigid")]
    ).all()


def test_the_numerical_error_is_estimated_or_else_declared(both):
    run = both.runs[1]
    plan = run.result.plan.change(psi2_error=np.array([0.1, 0.2, 0.3]))
    declared = attrs.evolve(run, result=attrs.evolve(run.result, plan=plan))
    estimate = np.array([0.01, np.nan, 0.03])
    result = attrs.evolve(declared.result, psi2_error_estimate=estimate)
    found = attrs.evolve(both, runs=(both.runs[0], declared))
    np.testing.assert_array_equal(found.numerical_error("smooth"), [0.1, 0.2, 0.3])
    found = attrs.evolve(both, runs=(both.runs[0], attrs.evolve(run, result=result)))
    np.testing.assert_array_equal(found.numerical_error("smooth"), [0.01, 0.2, 0.03])
    # A band of psi2 is that error; of psi2/psi1, over psi1; of the normal restitution, none.
    np.testing.assert_allclose(found.band("psi2", "smooth"), [0.01, 0.2, 0.03])
    np.testing.assert_allclose(found.band("beta0", "smooth"), [0.02, 0.1, 0.005])
    np.testing.assert_allclose(found.band("normal_restitution", "smooth"), 0.0)


def test_a_band_in_si_has_the_scale_of_psi():
    """The slip velocity is off by the error of psi2 over the scale of psi."""
    steel = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
    scene = Scene(Sphere(0.01, steel), HalfSpace(steel), 0.2, 1.0, np.array([0.1, 0.5]))
    laws = {"rough": Simulation(tangential=create("tangential.annulus", annuli=3))}
    found = compare(scene, laws, estimate_error=True)
    error = found.numerical_error("rough")
    assert (error > 1e-3).all()
    kappa = scene.pair.stiffness_ratio
    np.testing.assert_allclose(
        found.band("rebound_slip_velocity", "rough"), error * 0.2 / kappa, rtol=1e-9
    )


def test_progress_counts_every_law_and_series(file):
    seen = []
    compare(file, LAWS, progress=lambda *count: seen.append(count))
    assert seen == [(1, 4), (2, 4), (3, 4), (4, 4)]


@pytest.mark.parametrize(("after", "kept"), [(0, None), (1, None), (2, ["rigid"]), (3, ["rigid"])])
def test_interrupted_laws_are_left_out(file, after, kept, monkeypatch):
    """Each law runs the sweep, then the measured points; the first must be done."""
    calls = itertools.count()
    run = study._run

    def interrupted(*words):
        if next(calls) == after:
            raise KeyboardInterrupt
        return run(*words)

    monkeypatch.setattr(study, "_time", lambda name, simulation, scene, **_: study.LawRun(
        name=name, result=interrupted(simulation, scene), run_time_per_impact=1.0))  # fmt: skip
    monkeypatch.setattr(study, "_run", interrupted)
    if kept is None:
        with pytest.raises(KeyboardInterrupt):
            compare(file, LAWS)
        return
    found = compare(file, LAWS)
    assert found.interrupted
    assert found.names == list(found.agreements[0].results) == kept


def test_only_a_single_impact_has_a_history():
    one = Scene.nondimensional(psi1=1.0, chi=1.0)
    law = {"springs": Simulation(tangential="springs")}
    assert compare(one, law, history=True).runs[0].result.history
    assert not compare(one, law).runs[0].result.history
    assert not compare(SCENES, law, history=True).runs[0].result.history


def test_a_single_impact_varies_nothing_and_a_grid_its_axes():
    assert compare(Scene.nondimensional(psi1=1.0, chi=1.0), LAWS).varied == {}
    scene = Scene.grid(psi1=[1.0, 2.0], chi=[1.0, 1.5, 2.0])
    varied = compare(scene, LAWS).varied
    np.testing.assert_array_equal(varied["psi1"], [1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
    np.testing.assert_array_equal(varied["chi"], [1.0, 1.5, 2.0] * 2)


@pytest.mark.parametrize(
    ("simulations", "told"),
    [
        ([Simulation()], "simulations = .*must be simulations by name; such as"),
        ({}, "simulations = {}: must be simulations by name"),
        ({"a": "coulomb"}, r"simulations\['a'\] = 'coulomb': must be a Simulation; such as"),
    ],
)
def test_what_are_no_simulations_by_name_is_refused(simulations, told):
    with pytest.raises(ValueError, match=told):
        compare(Scene.nondimensional(psi1=1.0, chi=1.4), simulations)


def test_a_law_that_is_not_compared_is_refused():
    found = compare(
        Scene.nondimensional(psi1=1.0, chi=1.4), {"rigid": Simulation(tangential="coulomb")}
    )
    told = "law = 'rigd': is not in the comparison; did you mean 'rigid'[?] known: rigid"
    for asked in (found.result, found.model, lambda law: found.values("psi2", law)):
        with pytest.raises(ValueError, match=told):
            asked("rigd")


def test_what_is_no_scene_is_refused():
    with pytest.raises(ValueError, match="scene = 3: must be a Scene or a SceneFile"):
        compare(3, LAWS)
