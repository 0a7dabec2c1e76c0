"""What a fit says of a measurement: against closed forms, and nothing of a sound one."""

import re

import numpy as np
import pytest
from scipy.stats import chi2

from contactlab import Simulation
from contactlab_fit import fit
from contactlab_fit.diagnosis import describe_outlying, error_notes
from contactlab_fit.fit_result import Estimate
from tests.fitting.impacts import ANGLES, BODIES, restitution, scene, table
from tests.fitting.lines import line, option
from tests.longer import longer

SCATTER = 0.004 * np.random.default_rng(5).standard_normal(len(ANGLES))
SLIPPING = np.linspace(45.0, 70.0, 12)
SLOPE = 2.0 / np.tan(np.radians(SLIPPING))


def spins(sign):
    spin = Simulation().sweep(scene(0.12)).check().rebound_spin
    values = restitution(0.12) + SCATTER
    return table(values, **{"rebound_spin (rad/s)": sign * spin + 250.0 * SCATTER})


def test_a_spin_without_its_sign_is_found():
    (note,) = fit(spins(-1.0), BODIES).notes
    assert note.startswith("rebound_spin looks as if of the opposite sign")
    assert fit(spins(1.0), BODIES).notes == ()


@pytest.mark.slow
def test_a_slip_is_told_under_any_law():
    """Tried by the table of the exact law, and judged by the law of the fit."""
    laws = Simulation(tangential="coulomb")
    spin = laws.sweep(scene(0.12)).check().rebound_spin
    values = restitution(0.12, laws=laws) + SCATTER
    found = fit(table(values, **{"rebound_spin (rpm)": spin * (1.0 + SCATTER)}), BODIES,
                simulation=laws)  # fmt: skip
    assert "rebound_spin looks as if in rad/s under a heading in rpm" in str(found)


def test_an_impact_far_from_the_others_is_found():
    values = restitution(0.12) + SCATTER
    values[4] += 0.15
    found = fit(table(values), BODIES)
    (note,) = found.notes
    assert "tangential_restitution: impact 5 is off by up to 0.15" in note
    one = found.parameters["friction_coefficient"]
    assert abs(one.robust - 0.12) < abs(one.value - 0.12)


@pytest.mark.slow
def test_without_the_outliers_the_fit_is_the_one_that_the_sentence_gives():
    values = restitution(0.12) + SCATTER
    values[[2, 7]] += 0.2, -0.1
    (note,) = fit(table(values), BODIES).notes
    kept = np.delete(np.arange(len(values)), [2, 7])
    mu = fit(table(values[kept], ANGLES[kept]), BODIES)["friction_coefficient"]
    assert "impacts 3 and 8 are off" in note
    assert f"friction_coefficient {mu:.4g}" in note


def test_a_number_that_decides_alone_is_told():
    """Two parameters; all but one impact are alike: the other one decides."""
    angles = np.array([60.0] * 7 + [4.0])
    values = restitution(0.12, angles) + SCATTER[:8]
    names = ["friction_coefficient", "stiffness_ratio"]
    notes = fit(table(values, angles), BODIES, parameters=names).notes
    assert any("impact 8 alone decides the fit" in note for note in notes)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"speed (m/s)": np.full(12, 2000.0)}, "speed of about 2e+03 is unlikely"),
        ({"tangential_restitution": np.linspace(40.0, 90.0, 12)}, "12 numbers lie outside"),
    ],
)
def test_numbers_that_nobody_measures_are_told(change, words):
    data = table(restitution(0.12) + SCATTER) | change
    try:
        told = " ".join(fit(data, BODIES).notes)
    except ValueError as error:
        told = str(error)
    assert words in told


@pytest.mark.parametrize("times", [2, *longer(3)])
def test_copies_of_a_table_are_told(times):
    once = table(restitution(0.12) + SCATTER)
    copied = fit({name: np.tile(values, times) for name, values in once.items()}, BODIES)
    assert [note for note in copied.notes if f"occurs {times} times" in note]
    first = np.r_[0, 0:12]  # one impact twice may be chance
    assert fit({name: values[first] for name, values in once.items()}, BODIES).notes == ()


def test_a_column_that_is_fitted_is_told():
    data = table(restitution(0.12) + SCATTER, friction_coefficient=np.full(12, 0.3))
    assert fit(data, BODIES).notes == (
        "the column friction_coefficient is not used, as friction_coefficient is fitted",
    )


def test_an_unlikely_friction_is_told():
    (note,) = fit(table(1.0 - 0.0012 * SLOPE + 0.01 * SCATTER, SLIPPING), BODIES).notes
    assert note.startswith("friction_coefficient from 0.001")
    assert "check the units of tangential_restitution" in note


def test_errors_in_another_unit_are_told():
    data = table(restitution(0.12) + SCATTER, tangential_restitution_error=np.full(12, 0.08))
    (note,) = fit(data, BODIES).notes
    assert "errors are too large" in note
    assert "unit of tangential_restitution_error" in note


@pytest.mark.parametrize("count", [8, *longer(12, 40)])
def test_sound_measurements_are_not_accused(count):
    rng = np.random.default_rng(count)
    angles = np.linspace(5.0, 65.0, count)
    true = restitution(0.12, angles)
    for _ in range(2):
        assert fit(table(true + 0.01 * rng.standard_normal(count), angles), BODIES).notes == ()


@pytest.mark.parametrize("e", [0.6, *longer(0.9, 1.0)])
def test_one_loss_is_fitted_by_its_table(e):
    """Data by the closed form of gross slip, psi2 = psi1 - 2 chi (1 + e), and e itself."""
    angles = np.array([70.0, 74.0, 78.0, 80.0, 82.0, 84.0])
    values = 1.0 - 0.1 * (1.0 + e) / np.tan(np.radians(angles))
    data = table(values, angles, normal_restitution=np.full(6, e))
    found = fit(data, BODIES, parameters=["friction_coefficient", "restitution"])
    assert found["friction_coefficient"] == pytest.approx(0.1, rel=1e-4)
    assert found["normal.restitution"] == pytest.approx(e, abs=1e-4)
    assert "tabulated rebound" in found.laws


def test_other_laws_than_the_table_s_are_marched():
    laws = Simulation(normal="tsuji", tangential="coulomb")
    values = restitution(0.12, laws=laws)
    found = fit(table(values), BODIES, simulation=laws)
    assert "coulomb" in found.laws
    assert found["friction_coefficient"] == pytest.approx(0.12, abs=1e-6)


def test_a_robust_value_outside_of_its_interval_is_told():
    def estimate(robust):
        return Estimate(name="a", unit="1", value=1.0, standard_error=0.1, interval=(0.5, 1.5),
                        robust=robust)  # fmt: skip

    inside = {str(robust): estimate(robust) for robust in (None, 0.5, 1.0, 1.5)}
    assert describe_outlying(inside) == []
    told = describe_outlying(inside | {"low": estimate(0.49), "high": estimate(1.51234)})
    assert [re.search(r"gives (\w+ = [\d.]+), outside", text)[1] for text in told] == [
        "low = 0.49", "high = 1.512"
    ]  # fmt: skip


def noted(ratio, count, *, values=None):
    """Return the notes on residuals whose rms per degree of freedom is ``ratio`` errors."""
    pulls = np.resize([1.0, -1.0], count) * ratio * np.sqrt((count - 1) / count)
    y = pulls if values is None else values
    off = line({"y": y, "z": np.full(count, 0.0)}, option("a"), errors={"y": np.ones(count)},
               x=np.zeros(count))  # fmt: skip
    return error_notes(off, np.array([0.0]))


@pytest.mark.parametrize(
    ("ratio", "count", "expected"),
    [
        (1.0, 40, ""),
        (1.41, 40, ""),  # chi square per degree of freedom 1.99
        (1.42, 40, "1.4 times the errors given. The errors are too small"),
        (2.0, 4, ""),  # chance does it once in 140 times
        (3.0, 4, "3 times the errors given. The errors are too small"),
        (0.51, 40, ""),
        (0.49, 40, "0.49 times the errors given. The errors are too large"),
        (0.49, 8, ""),
        (0.2, 8, "0.2 times the errors given. The errors are too large"),
        (9.0, 1, ""),  # no degree of freedom
        (9.0, 2, "9 times the errors given. The errors are too small"),
    ],
)
def test_errors_that_the_scatter_contradicts(ratio, count, expected):
    """Beyond a factor of two in the square, or below one half, and beyond chance."""
    freedom = count - 1
    if freedom:
        square = freedom * ratio**2
        unlikely = (
            chi2.sf(square, freedom) < 1e-3 if ratio > 1 else chi2.cdf(square, freedom) < 1e-3
        )
        assert bool(expected) == (unlikely and (ratio**2 > 2.0 or ratio < 0.5))
    notes = noted(ratio, count)
    assert len(notes) == bool(expected)
    assert expected in "".join(notes)


def test_equal_numbers_do_not_show_their_scatter():
    assert noted(0.0, 20, values=np.full(20, 0.01)) == []
    assert "too small" in noted(0.0, 20, values=np.full(20, 9.0))[0]
    assert "too large" in noted(0.0, 20, values=np.array([0.01, *[0.0] * 19]))[0]
