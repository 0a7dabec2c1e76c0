"""What is said of the experiment of Kharaz et al. and of MFiX's simulation of it."""

import re
from pathlib import Path

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.study.evidence import SOURCES

FILES = {source.name: source.read() for source in SOURCES}
KHARAZ, MFIX = FILES["kharaz2001"], FILES["codes-mfix"]
E_T, ANGLE, SPIN = KHARAZ.measured
RADIUS, SPEED = 2.5e-3, 3.9
NOTES = " ".join(KHARAZ.notes.split())


def restitutions(file, series, law=None, **entries):
    """Return e_t at the places of a series."""
    scene = file.scene_at(**{series.against: series.x}, **entries)
    simulation = Simulation() if law is None else Simulation(tangential=law)
    return simulation.sweep(scene).tangential_restitution


def rms(difference):
    return float(np.sqrt(np.mean(difference**2)))


def test_seven_of_eleven_points_slip_throughout():
    """There e_t follows from friction alone; on six of them the rigid law is the exact one."""
    scene = KHARAZ.scene_at(angle_deg=E_T.x)
    exact, rigid = (restitutions(KHARAZ, E_T, law) for law in (None, "coulomb"))
    slips = np.abs(scene.psi1) >= np.maximum(1.0, 4.0 * scene.chi - 1.0)
    assert (int(np.sum(slips)), len(slips)) == (7, 11)
    assert (E_T.x[slips] > 30.0).all()
    friction_alone = 1.0 - 2.0 * 0.092 / np.tan(np.radians(E_T.x[slips]))
    assert exact[slips] == pytest.approx(friction_alone, abs=1e-9)
    assert int(np.sum(np.abs(exact - rigid) < 1e-9)) == 6
    assert "seven of the eleven points" in NOTES
    assert "six of them are the rigid law's too" in NOTES


def test_the_distances_are_those_that_are_told():
    sticks = E_T.x < 25.0
    difference = restitutions(KHARAZ, E_T) - E_T.values
    assert rms(difference[sticks]) == pytest.approx(0.019, abs=1e-4)
    assert rms(difference) == pytest.approx(0.0121, abs=5e-5)
    other = restitutions(KHARAZ, E_T, **{"target.material.poisson_ratio": 0.20}) - E_T.values
    assert rms(other) == pytest.approx(0.0099, abs=5e-5)
    assert rms(other[sticks]) == pytest.approx(0.015, abs=5e-4)
    assert contactlab.Material.named("soda-lime glass").poisson_ratio == 0.20
    for told in ("0.019", "0.0099", "0.015"):
        assert told in NOTES


def moments(angle, spin):
    """Return the e_t that a spin after the rebound makes: (2/5) omega R = (1 - e_t) v_t."""
    return 1.0 + 0.4 * RADIUS * spin / (SPEED * np.sin(np.radians(angle)))


@pytest.mark.parametrize("law", ["fronts", "coulomb", "mindlin_cap", "stronge"])
def test_the_balance_of_moments_holds_under_any_law(law):
    scene = KHARAZ.scene_at(angle_deg=SPIN.x)
    result = Simulation(tangential=law).sweep(scene)
    expected = moments(SPIN.x, result.rebound_spin)
    assert result.tangential_restitution == pytest.approx(expected, abs=1e-12)


def test_spin_and_restitution_contradict_each_other():
    """By up to 0.048, at 6 degrees; a reading is good to 0.002."""
    of_spin = moments(SPIN.x, SPIN.values)
    of_figure = np.interp(SPIN.x, E_T.x, E_T.values)
    assert of_spin[:2] == pytest.approx([0.671, 0.643], abs=5e-4)
    assert of_figure[:2] == pytest.approx([0.719, 0.664], abs=5e-4)
    assert restitutions(KHARAZ, SPIN)[:2] == pytest.approx([0.720, 0.622], abs=6e-4)
    assert np.max(np.abs(of_spin - of_figure)) == pytest.approx(0.048, abs=5e-4)
    assert np.max(moments(SPIN.x, SPIN.values + SPIN.error) - of_spin) < 0.003
    for told in ("0.671", "0.643", "0.719", "0.664", "0.720", "0.622"):
        assert told in NOTES


def test_the_first_point_is_the_limit_without_slip():
    """At 2 degrees every finite friction makes less than the measured e_t, 0.7946."""
    chi = float(np.asarray(KHARAZ.scene_at(angle_deg=2.0).chi))
    ratio = float(Simulation().run(Scene.nondimensional(psi1=1e-6, chi=chi)).psi2) / 1e-6
    assert 1.0 - (2.0 / 7.0) * (1.0 - ratio) == pytest.approx(0.795, abs=5e-4)
    assert E_T.values[0] == pytest.approx(0.795, abs=5e-4)


def test_readings_and_means_of_the_spin_agree():
    example = contactlab.read_scene(Path(__file__).parents[2] / "examples" / "kharaz2001.toml")
    series = example.measured[2]
    assert series.quantity == SPIN.quantity == "rebound_spin"
    assert series.x == pytest.approx(SPIN.x, abs=1e-4)
    assert series.values == pytest.approx(SPIN.values, abs=1e-4)
    assert series.error == pytest.approx(SPIN.error, abs=1e-4)


def test_mfix_has_the_whole_stiffness_of_mindlin():
    """By its own constants, 0.41968e10 and 0.54084e10 N/m^1.5, and by its curve."""
    pair = MFIX.scene.pair
    assert 4.0 / 3.0 * pair.effective_modulus * pair.radius**0.5 == pytest.approx(
        0.41968e10, rel=2e-5
    )
    assert 2.0 * pair.effective_shear_modulus * pair.radius**0.5 == pytest.approx(
        0.54084e10, rel=2e-5
    )
    (series,) = MFIX.measured
    found = {}
    for factor in (1.0, 2.0 / 3.0):
        law = contactlab.create("tangential.mindlin_cap", stiffness_factor=factor)
        found[factor] = rms(restitutions(MFIX, series, law) - series.values)
    assert found[1.0] == pytest.approx(0.0034, abs=5e-5)
    assert found[2.0 / 3.0] == pytest.approx(0.119, abs=5e-4)
    for told in ("0.0034", "0.119", "0.41968e10", "0.54084e10"):
        assert told in MFIX.notes


def test_the_table_of_the_theory_page_is_that_of_the_figures():
    page = Path(contactlab.__file__).parent / "guide" / "theory-coupling.md"
    pattern = r"^\| ([\d.]+)° \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$"
    rows = re.findall(pattern, page.read_text(encoding="utf-8"), re.MULTILINE)
    told = np.array([[float(number) for number in row] for row in rows if float(row[1]) > 1.0])
    first = slice(0, 3)
    expected = (
        (SPIN.x, 0.05),
        (-SPIN.values, 0.06),
        (moments(SPIN.x, SPIN.values), 5.1e-4),
        (np.interp(SPIN.x, E_T.x, E_T.values), 5.1e-4),
        (restitutions(KHARAZ, SPIN), 6e-4),
    )
    assert told.shape == (3, 5)
    for column, (values, half) in zip(told.T, expected, strict=True):
        assert column == pytest.approx(values[first], abs=half)
