"""What a fit says of a measurement: against closed forms, and nothing of a sound one."""

import numpy as np
import pytest
from scipy.stats import f as f_distribution

from contactlab import Simulation, fit
from contactlab.fitting import outliers, patterns
from contactlab.fitting.measurements import read_measurements
from contactlab.fitting.model import Model, scene_of
from contactlab.fitting.parameters import Setup, parameter_named
from contactlab.fitting.problem import Problem
from contactlab.fitting.readings import readings
from tests.fitting.impacts import ANGLES, BODIES, restitution, scene, table

SCATTER = 0.004 * np.random.default_rng(5).standard_normal(len(ANGLES))
SLIPPING = np.linspace(45.0, 70.0, 12)
SLOPE = 2.0 / np.tan(np.radians(SLIPPING))


def problem_of(measurements):
    read = read_measurements(measurements)
    setup = Setup(scene_of(BODIES, read.given, len(read)), None)
    model = Model(setup=setup, parameters=(parameter_named("friction_coefficient", setup),))
    return Problem(model=model, measured=read.measured, errors=read.errors)


def square(columns, numbers):
    """Return the sum of squares that a straight fit leaves."""
    found = np.linalg.lstsq(columns, numbers, rcond=None)[0]
    return float(np.sum((numbers - columns @ found) ** 2))


def spins(sign):
    spin = Simulation().sweep(scene(0.12)).check().rebound_spin
    values = restitution(0.12) + SCATTER
    return table(values, **{"rebound_spin (rad/s)": sign * spin + 250.0 * SCATTER})


def test_a_spin_without_its_sign_is_found():
    (note,) = fit(spins(-1.0), BODIES).notes
    assert note.startswith("rebound_spin looks as if of the opposite sign")
    assert fit(spins(1.0), BODIES).notes == ()


def test_a_shift_by_a_row_is_judged_by_the_same_rows_as_the_table():
    """Each way drops one row at an end; the table that it is compared with drops the same."""
    problem = problem_of(table(restitution(0.12)))
    shifts = [each for each in readings(problem, ["angle_deg"]) if "a row too" in each.words]
    (before,) = problem.measured.values()
    for low, shift in zip((True, False), shifts, strict=True):
        (values,), (rest,) = shift.problem.measured.values(), shift.rest.values()
        held, dropped = (slice(1, None), 0) if low else (slice(None, -1), -1)
        assert np.isnan(rest[dropped])
        assert np.array_equal(rest[held], before[held])
        shifted = before[1:] if low else before[:-1]
        assert np.array_equal(values[~np.isnan(values)], shifted)


def test_an_impact_far_from_the_others_is_found():
    values = restitution(0.12) + SCATTER
    values[4] += 0.15
    found = fit(table(values), BODIES)
    (note,) = found.notes
    assert "tangential_restitution: impact 5 is off by up to 0.15" in note
    one = found.parameters["friction_coefficient"]
    assert abs(one.robust - 0.12) < abs(one.value - 0.12)


def test_without_the_outliers_the_fit_is_the_one_that_the_sentence_gives():
    values = restitution(0.12) + SCATTER
    values[[2, 7]] += 0.2, -0.1
    (note,) = fit(table(values), BODIES).notes
    kept = np.delete(np.arange(len(values)), [2, 7])
    mu = fit(table(values[kept], ANGLES[kept]), BODIES)["friction_coefficient"]
    assert "impacts 3 and 8 are off" in note
    assert f"friction_coefficient is {mu:.4g}" in note


def test_the_chance_of_outliers_is_that_of_the_f_test():
    """In gross slip the law is a straight line: a column for each number that is left out."""
    values = 1.0 - 0.1 * SLOPE + SCATTER
    values[[3, 9]] += 0.05
    problem = problem_of(table(values, SLIPPING))
    best, scales = outliers.robust(problem, np.array([0.1]))
    found = outliers.outliers(problem, best, scales)
    assert found.places["tangential_restitution"].tolist() == [3, 9]
    plain = square(SLOPE[:, None], 1.0 - values)
    left = square(np.column_stack([SLOPE, np.eye(12)[:, [3, 9]]]), 1.0 - values)
    chance = f_distribution.sf((plain - left) / 2.0 / (left / 9.0), 2, 9) * 66.0
    assert found.chance == pytest.approx(chance, rel=0.05)


def test_the_chance_of_a_pattern_is_that_of_the_f_test():
    """Of a curve over the angle, which varies alone: one test of a cubic, seven of a change."""
    rank = np.linspace(-1.0, 1.0, 12)
    values = 1.0 - 0.1 * SLOPE + SCATTER + 0.03 * (2.5 * rank**3 - 1.5 * rank)
    problem = problem_of(table(values, SLIPPING))
    best = np.array([fit(table(values, SLIPPING), BODIES)["friction_coefficient"]])
    columns = {"angle_deg": SLIPPING, "speed": np.full(12, 2.0)}
    found = patterns.pattern(problem, best, problem.sizes(), columns)
    plain = square(SLOPE[:, None], 1.0 - values)
    terms = (rank, 1.5 * rank**2 - 0.5, 2.5 * rank**3 - 1.5 * rank)
    curves = np.column_stack([SLOPE, *terms])
    left = square(curves, 1.0 - values)
    chance = f_distribution.sf((plain - left) / 3.0 / (left / 8.0), 3, 8)
    assert "follow angle_deg" in found.words
    assert found.chance == pytest.approx(chance * (1 + 7), rel=0.05)


def test_a_number_that_decides_alone_is_told():
    """Two parameters; all but one impact are alike: the other one decides."""
    angles = np.array([60.0] * 7 + [4.0])
    values = restitution(0.12, angles) + SCATTER[:8]
    names = ["friction_coefficient", "stiffness_ratio"]
    notes = fit(table(values, angles), BODIES, parameters=names).notes
    assert any("runs through impact 8 whatever was measured there" in note for note in notes)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"speed (m/s)": np.full(12, 2000.0)}, "speed of about 2e+03 is unlikely"),
        ({"tangential_restitution": np.linspace(40.0, 90.0, 12)}, "12 numbers lie beyond"),
    ],
)
def test_numbers_that_nobody_measures_are_told(change, words):
    data = table(restitution(0.12) + SCATTER) | change
    try:
        told = " ".join(fit(data, BODIES).notes)
    except ValueError as error:
        told = str(error)
    assert words in told


def test_an_unlikely_friction_is_told():
    (note,) = fit(table(1.0 - 0.0012 * SLOPE + 0.01 * SCATTER, SLIPPING), BODIES).notes
    assert note.startswith("friction_coefficient from 0.001")
    assert "look at the units of tangential_restitution" in note


def test_errors_in_another_unit_are_told():
    data = table(restitution(0.12) + SCATTER, tangential_restitution_error=np.full(12, 0.08))
    (note,) = fit(data, BODIES).notes
    assert "times the errors given: these are too large" in note
    assert "look at the unit of tangential_restitution_error" in note


@pytest.mark.parametrize("count", [8, 12, 40])
def test_sound_measurements_are_not_accused(count):
    rng = np.random.default_rng(count)
    angles = np.linspace(5.0, 65.0, count)
    true = restitution(0.12, angles)
    for _ in range(4):
        assert fit(table(true + 0.01 * rng.standard_normal(count), angles), BODIES).notes == ()


@pytest.mark.parametrize("e", [0.6, 0.9, 1.0])
def test_tsuji_s_law_is_fitted_by_its_table(e):
    """Data by the closed form of gross slip, psi2 = psi1 - 2 chi (1 + e), and e itself."""
    laws = Simulation(normal="tsuji")
    angles = np.array([70.0, 74.0, 78.0, 80.0, 82.0, 84.0])
    values = 1.0 - 0.1 * (1.0 + e) / np.tan(np.radians(angles))
    data = table(values, angles, normal_restitution=np.full(6, e))
    names = ["friction_coefficient", "restitution"]
    found = fit(data, BODIES, parameters=names, simulation=laws)
    assert found["friction_coefficient"] == pytest.approx(0.1, rel=2e-3)
    assert found["normal.restitution"] == pytest.approx(e, abs=1e-4)
    assert "tabulated rebound" in found.laws


def test_other_laws_than_the_table_s_are_marched():
    laws = Simulation(normal="tsuji", tangential="coulomb")
    values = restitution(0.12, laws=laws)
    found = fit(table(values), BODIES, simulation=laws)
    assert "Coulomb" in found.laws
    assert found["friction_coefficient"] == pytest.approx(0.12, abs=1e-6)
