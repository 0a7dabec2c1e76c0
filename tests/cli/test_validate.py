"""`contactlab validate`: bounds met, evidence told with its scatter, pictures drawn."""

import json

import attrs
import numpy as np
import pytest

import contactlab
from contactlab.registration import bring
from contactlab.scene_file import read_scene
from contactlab.study import evidence, validation
from tests.cli.conftest import EXAMPLES

SOURCES = {source.name: source for source in evidence.SOURCES}


@pytest.fixture(scope="module")
def gathered():
    return {one.source.name: one for one in evidence.gather()}


def rms(one, law, series=0):
    return one.comparison.agreements[series].rms(law)


@pytest.mark.parametrize("chi", validation.REFERENCE_PSI2)
def test_the_reference_values_are_those_of_the_exact_law(chi):
    """Of theory §5, to ten digits."""
    integrator = contactlab.create("integrator.events", tolerance=1e-12)
    scene = contactlab.Scene.nondimensional(psi1=validation.REFERENCE_PSI1, chi=chi)
    result = contactlab.Simulation(integrator=integrator).run(scene).check()
    assert result.psi2 == pytest.approx(validation.REFERENCE_PSI2[chi], abs=6e-11)


def test_the_mean_readings_are_those_of_the_example():
    packaged = SOURCES["kharaz2001"].read()
    example = read_scene(EXAMPLES / "kharaz2001.toml")
    for one, other in zip(packaged.measured, example.measured, strict=True):
        assert (one.quantity, one.against) == (other.quantity, other.against)
        assert one.x == pytest.approx(other.x, abs=1e-4)
        assert one.values == pytest.approx(other.values, abs=1e-5)
        assert one.error == pytest.approx(np.nan_to_num(other.error), abs=1e-5)
    assert packaged.scene.pair == example.scene.pair


@pytest.mark.slow
def test_every_installed_law_is_told(gathered):
    for one in gathered.values():
        told = set(one.laws) | set(one.left_out)
        assert {"fronts", "springs", "annulus", "mindlin_cap", "coulomb"} <= told
        assert np.isfinite([rms(one, law) for law in one.laws]).all()


@pytest.mark.slow
def test_the_experiment_is_met_to_its_bound_by_partial_slip_alone(gathered):
    one = gathered["kharaz2001"]
    damped = (f"springs, {normal} restitution=0.98" for normal in ("tsuji", "viscoelastic"))
    for law in ("fronts", *damped):
        assert rms(one, law) <= 0.015
        assert rms(one, law) < 0.3 * min(rms(one, "coulomb"), rms(one, "mindlin_cap"))
    assert 0.0 < one.scatter(one.comparison.agreements[0]) < 0.002


@pytest.mark.slow
def test_a_superball_does_not_favour_the_loss_in_shear(gathered):
    """Its contact is deep; the numbers are those of the notes and of theory §15."""
    one = gathered["superball"]
    assert rms(one, "springs, viscoelastic restitution=0.9") == pytest.approx(0.20, abs=5e-3)
    assert rms(one, "fronts") == pytest.approx(0.19, abs=5e-3)
    assert rms(one, "annulus, viscoelastic restitution=0.9") == pytest.approx(0.144, abs=5e-3)
    slip, along, normal = (series.measured for series in one.comparison.agreements)
    assert 0.42 <= slip.values[:10].min() < slip.values[:10].max() <= 0.68
    no_spin = 1.0 - (2.0 / 7.0) * (1.0 + slip.values)  # a ball that came without spin
    assert along.values == pytest.approx(no_spin, abs=0.07)
    friction = (1.0 - along.values) * np.tan(np.radians(along.x)) / (1.0 + normal.values)
    assert np.mean(friction[-3:]) == pytest.approx(0.39, abs=5e-3)


@pytest.mark.slow
def test_what_is_said_of_the_experiment_holds(gathered):
    """e_t tan(angle)/tan(rebound angle) is the restitution; the two figures have it near 1."""
    one = gathered["kharaz2001"]
    tangential, angle, _ = (series.measured for series in one.comparison.agreements)
    known = angle.x > 20.0
    at = np.interp(angle.x[known], tangential.x, tangential.values)
    slopes = np.tan(np.radians(angle.x[known])) / np.tan(np.radians(angle.values[known]))
    assert np.median(at * slopes) == pytest.approx(1.0, abs=0.01)
    assert rms(one, "springs", 1) < rms(one, "springs, tsuji restitution=0.98", 1)
    assert 0.02 < one.comparison.agreements[0].largest("fronts") < 0.035


@pytest.mark.slow
def test_finite_elements_are_nearest_to_the_exact_law_and_miss_it_about_psi1_1(gathered):
    one = gathered["finite-elements"]
    series = one.comparison.agreements[0]
    psi1 = series.results["fronts"].psi1
    assert rms(one, "fronts") == pytest.approx(0.050, abs=0.001)
    assert rms(one, "mindlin_cap") > 5.0 * rms(one, "fronts")
    assert psi1[np.argmax(np.abs(series.difference("fronts")))] == pytest.approx(1.0, abs=0.1)
    assert 0.1 < series.largest("fronts") < 0.13
    # Theory §9: 4 chi less at the end, to the reading.
    assert series.difference("fronts")[-3:] == pytest.approx([-0.03] * 3, abs=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["codes-test4-oxide", "codes-test4-alloy", "codes-mfix"])
def test_curves_of_codes_are_those_of_the_capped_spring(gathered, name):
    """Simulations, not experiments: the cap is right by construction, to the reading."""
    one = gathered[name]
    assert one.source.kind == "other codes"
    assert rms(one, "mindlin_cap") < 0.005
    assert 0.055 < rms(one, "fronts") < 0.1


@pytest.mark.slow
def test_scalars_of_hertz_are_the_codes(monkeypatch):
    monkeypatch.setattr(validation, "COMPOSITIONS", ())
    bounds = [validation.FORCE_READING, validation.OTHER_READING]
    found = [one for one in validation.validate() if one.what.startswith("hertz: test")]
    assert len(found) == 6
    assert all(one.ok and one.bound in bounds for one in found)
    monkeypatch.setattr(validation, "FORCE_READING", 1e-6)
    assert not all(one.ok for one in validation.validate() if "force" in one.what)


@pytest.mark.slow
def test_one_loss_is_that_of_the_theory(monkeypatch):
    """56 numbers that other programs found, to the error of 50 springs."""
    monkeypatch.setattr(validation, "COMPOSITIONS", ())
    (found,) = (one for one in validation.validate() if one.what.startswith("viscoelastic"))
    assert found.ok
    assert found.difference > 1e-4
    monkeypatch.setattr(validation, "LOSS_SPRINGS", 6)
    assert not next(one for one in validation.validate() if "viscoelastic" in one.what).ok


@pytest.fixture
def short(monkeypatch):
    """Validate against one source of few laws, and no reference values."""
    monkeypatch.setattr(validation, "COMPOSITIONS", validation.COMPOSITIONS[:1])
    monkeypatch.setattr(bring, "_KEPT", {})
    monkeypatch.setattr(evidence, "SOURCES", (SOURCES["codes-test4-alloy"],))
    monkeypatch.setattr(
        validation.REGISTRY,
        "names",
        lambda kind=None: [f"{kind or 'tangential'}.{name}" for name in ("coulomb", "mindlin_cap")],
    )


@pytest.mark.slow
def test_tables_pictures_and_json(run, short, tmp_path):
    ran = run("validate", "--out", tmp_path / "pictures")
    assert ran.status == 0
    assert "capped" not in ran.err
    assert "Simulations by other codes" in ran.out
    assert "right here by construction" in " ".join(ran.out.split())
    assert (tmp_path / "pictures" / "codes-test4-alloy.png").read_bytes().startswith(b"\x89PNG")
    content = json.loads(run("validate", "--json").out)
    assert all(row["ok"] and row["difference"] <= row["bound"] for row in content["checks"])
    laws = content["sources"][0]["series"][0]["laws"]
    assert list(laws) == ["mindlin_cap", "coulomb"]
    assert laws["mindlin_cap"]["rms"] < 0.005


def test_a_folder_that_cannot_be(run, tmp_path):
    ran = run("validate", "--out", tmp_path / "no" / "pictures")
    assert (ran.status, ran.out) == (2, "")
    assert "there is no folder" in ran.err


def test_a_law_that_misses_an_experiment_fails(run, short, monkeypatch):
    (source,) = evidence.SOURCES
    quantity = source.read().measured[0].quantity
    bounds = {(quantity, law): 1e-2 for law in ("mindlin_cap", "coulomb")}
    monkeypatch.setattr(bring, "_KEPT", {})
    monkeypatch.setattr(evidence, "SOURCES", (attrs.evolve(source, bounds=bounds),))
    ran = run("validate", "--json")
    content = json.loads(ran.out)
    told = {row["what"]: row["ok"] for row in content["checks"]}
    assert (ran.status, content["complete"]) == (1, True)
    assert told[f"mindlin_cap: {quantity}, rms"]
    assert not told[f"coulomb: {quantity}, rms"]


def test_a_wrong_value_fails(run, monkeypatch):
    wrong = {
        chi: tuple(value + 1e-6 for value in row) for chi, row in validation.REFERENCE_PSI2.items()
    }
    monkeypatch.setattr(validation, "REFERENCE_PSI2", wrong)
    monkeypatch.setattr(validation, "COMPOSITIONS", validation.COMPOSITIONS[:1])
    laws = ["tangential.fronts", "integrator.events"]  # those of that composition
    monkeypatch.setattr(validation.REGISTRY, "names", lambda: laws)
    monkeypatch.setattr(bring, "_KEPT", {})
    monkeypatch.setattr(evidence, "SOURCES", ())
    ran = run("validate")
    assert ran.status == 1
    assert "FAILS" in ran.out


def test_laws_over_several_normal_laws_are_told_apart():
    normals = {"hertz": {}, "tsuji": {"restitution": 0.9}, "jkr": {}}
    found, left_out = evidence.simulations_over(normals)
    assert found["springs"].normal.__class__.__name__ == "Hertz"
    assert found["springs, tsuji restitution=0.9"].normal.restitution == 0.9
    assert "springs, jkr" in found
    assert "fronts, jkr" in left_out
    assert "fronts" in found
