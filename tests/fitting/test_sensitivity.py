"""What a fit says beside its intervals: cautions of its scenes, and shifts by its assumptions."""

import json

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, create, fit
from contactlab.fitting import read_measurements

STEEL, GLASS = Material.named("steel"), Material.named("soda-lime glass")
BALL, ANGLES = Sphere(0.005, STEEL), np.array([5, 10, 15, 20, 25, 30, 40, 50.0])


def scene(ball=BALL, plate=STEEL, friction=0.1):
    return Scene.at_angle(ball, HalfSpace(plate), friction, speed=2.0, angle_deg=20.0)


def measured(friction=0.12, *, plate=STEEL, ball=BALL, restitution=1.0, tilt=0.0, seed=0):
    """Return tangential restitutions with a scatter of 0.005."""
    impacts = Scene.at_angle(ball, HalfSpace(plate), friction, speed=2.0, angle_deg=ANGLES)
    laws = Simulation()
    if restitution < 1.0:
        laws = Simulation(normal=create("normal.tsuji", restitution=restitution))
    scatter = 0.005 * np.random.default_rng(seed).normal(size=ANGLES.size)
    e_t = laws.run(impacts).tangential_restitution + scatter
    return {"angle_deg": ANGLES + tilt, "tangential_restitution": e_t}


def shift(fitted, cause):
    """Return the shift of friction by a cause, from the caution about it."""
    told = next(text for text in fitted.cautions if cause in text)
    return float(told.rpartition("friction_coefficient by ")[2])


def test_a_yielding_ball_and_unlike_bodies_are_cautioned_of_as_run_does():
    lead = Sphere(0.005, Material.named("lead"))
    fitted = fit(measured(ball=lead), scene(lead))
    assert any("yield" in text for text in fitted.cautions)
    assert any("unlike bodies" in text for text in fitted.cautions)
    assert "caution: yield" in repr(fitted)
    assert json.loads(json.dumps(fitted.to_dict()))["cautions"] == list(fitted.cautions)


@pytest.mark.parametrize("seed", range(10))
def test_lossy_data_under_the_elastic_law_miss_but_never_in_silence(seed):
    fitted = fit(measured(restitution=0.85, seed=seed), scene())
    found = fitted["friction_coefficient"]
    # what e = 0.9 would move explains two thirds of what e = 0.85 moves
    assert found + 1.5 * shift(fitted, "restitution of 0.9") == pytest.approx(0.12, abs=0.006)


@pytest.mark.parametrize("tilt", [-3.0, 3.0])
def test_a_tilted_protractor_is_told_by_its_size(tilt):
    fitted = fit(measured(tilt=tilt), scene())
    per_degree = shift(fitted, "1 degree greater")
    assert fitted["friction_coefficient"] - per_degree * tilt == pytest.approx(0.12, abs=0.006)


def test_coupling_is_told_as_a_shift_of_the_parameter():
    """The half-space law with coupling is the other source: its data give another friction."""
    glass = HalfSpace(GLASS)
    impacts = Scene.at_angle(BALL, glass, 0.12, speed=2.0, angle_deg=ANGLES)
    coupled = Simulation(tangential=create("tangential.halfspace", coupling="one_way"))
    e_t = coupled.run(impacts).tangential_restitution
    fitted = fit({"angle_deg": ANGLES, "tangential_restitution": e_t}, scene(plate=GLASS))
    found, by = fitted["friction_coefficient"], shift(fitted, "which is left out")
    assert found + by == pytest.approx(0.12, abs=0.6 * abs(found - 0.12))
    assert by * (0.12 - found) > 0.0


def test_a_measured_restitution_names_the_laws_that_would_serve():
    content = measured(restitution=0.85) | {"normal_restitution": np.full(ANGLES.size, 0.85)}
    fitted = fit(content, scene())
    note = next(text for text in fitted.notes if "would serve" in text)
    assert "tsuji" in note
    assert "hunt_crossley" in note
    found = float(note.rpartition("friction_coefficient = ")[2])
    assert found == pytest.approx(0.12, abs=0.003)
    assert not any("would serve" in text for text in fit(measured(), scene()).notes)


def test_a_column_with_the_other_sign_is_mended_by_its_name():
    content = {"angle_deg": [10.0, 20.0], "spin of ball (rpm)": [60.0, -30.0], "e_t": [0.5, 0.6]}
    names = {"spin of ball (rpm)": "-rebound_spin", "e_t": "tangential_restitution"}
    table = read_measurements(content, columns=names)
    assert table.measured["rebound_spin"] == pytest.approx([-2.0 * np.pi, np.pi])


def test_a_remark_in_brackets_is_no_unit():
    content = {"impact angle (from normal)": [10.0, 20.0], "tangential_restitution": [0.5, 0.6]}
    table = read_measurements(content, columns={"impact angle (from normal)": "angle_deg"})
    assert table.given["angle_deg"].tolist() == [10.0, 20.0]
