"""Fits of one loss: from soft data to what is missing, one bounce, laws that fit what they have."""

import re

import attrs
import numpy as np
import pytest

from contactlab import HalfSpace, Material, Simulation, Sphere, create
from contactlab_fit import fit, rank
from tests.fitting.impacts import BODIES, STEEL, table
from tests.longer import longer

#: A nylon ball on steel at 20 m/s, made with mu .35, e .75 and beta0 .1.
SOFT = {
    "angle_deg": np.array([10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 68.0, 74.0]),
    "speed (m/s)": np.full(8, 20.0),
    "rebound_normal_velocity (m/s)": -np.array(
        [14.77, 14.10, 12.99, 11.49, 9.64, 7.50, 5.62, 4.13]
    ),
    "rebound_tangential_velocity (m/s)": np.array(
        [2.38, 4.69, 6.86, 8.82, 10.51, 11.88, 13.95, 15.85]
    ),
}
MASS, RADIUS = 0.0459, 0.02134
DENSITY = MASS / (4.0 / 3.0 * np.pi * RADIUS**3)
NYLON = Material(young_modulus=2.7e9, poisson_ratio=0.41, density=DENSITY)
BALL = attrs.evolve(BODIES, sphere=Sphere(RADIUS, NYLON), target=HalfSpace(STEEL))
MU, E, G = "friction_coefficient", "restitution", "shear_loss"


def told(parameters, **more):
    """Return a fit's notes, or its refusal."""
    try:
        return " ".join(fit(SOFT, BALL, parameters=parameters, **more).notes)
    except ValueError as error:
        return str(error)


@pytest.mark.slow
def test_the_notes_lead_from_soft_data_to_the_friction_it_was_made_with():
    first = told([MU])
    assert "fit restitution too: that of normal=viscoelastic" in first
    then = told([MU, E])
    assert "rebounded less than these laws give" in then
    assert "Fit shear_loss" in then
    assert "if Poisson's ratios and friction are known" in then
    mu = float(re.search(r"friction_coefficient ([\d.]+)", then)[1])
    assert mu == pytest.approx(0.35, rel=0.03)


@pytest.mark.slow
def test_the_loss_in_shear_of_soft_data():
    """Springs with it meet what hard spheres made; neither accuses the data."""
    found = fit(SOFT, BALL, parameters=[MU, E, G])
    assert found[MU] == pytest.approx(0.35, rel=0.03)
    assert found["normal.restitution"] == pytest.approx(0.75, abs=1e-3)
    assert found.rms["rebound_tangential_velocity"] < 0.05  # .56 without
    assert found.notes == ()
    assert any("Poisson's ratios and friction must be known" in text for text in found.cautions)


@pytest.mark.slow
def test_residuals_that_climb_with_the_angle_are_told_with_their_size():
    laws = Simulation(normal="tsuji", tangential="walton")
    note = told([MU, E], simulation=laws)
    ends = re.search(r"climb with angle_deg, from \+(\S+) to \+(\S+) m/s between 10 and 50:", note)
    residuals = fit(SOFT, BALL, parameters=[MU, E], simulation=laws).residuals
    off = residuals["rebound_tangential_velocity"][[0, 4]]
    assert [float(end) for end in ends.groups()] == pytest.approx(off, abs=0.05)


@pytest.mark.parametrize("loss", longer(0.5, 2.0))
def test_a_loss_in_shear_comes_back(loss):
    """Made by springs; nothing is lost in shear alone."""
    laws = Simulation(
        normal=create("normal.tsuji", restitution=0.8),
        tangential=create("tangential.springs", shear_loss=loss),
    )
    angles = np.array([5.0, 12.0, 20.0, 30.0, 70.0])
    scene = attrs.evolve(
        BODIES, friction_coefficient=0.3,
        normal_speed=2.0 * np.cos(np.radians(angles)),
        tangential_velocity=2.0 * np.sin(np.radians(angles)),
    )  # fmt: skip
    data = table(laws.sweep(scene).check().tangential_restitution, angles)
    given = Simulation(normal=create("normal.tsuji", restitution=0.8))
    found = fit(data, BODIES, parameters=[MU, G], simulation=given)
    assert found["tangential.shear_loss"] == pytest.approx(loss, rel=1e-3)
    assert found[MU] == pytest.approx(0.3, rel=1e-4)


def test_one_bounce_gives_two_numbers_without_intervals():
    """In gross slip e_t = 1 - mu (1 + e)/tan(angle)."""
    data = {"angle_deg": [70.0], "speed (m/s)": [2.0], "normal_restitution": [0.6],
            "tangential_restitution": [1.0 - 0.1 * 1.6 / np.tan(np.radians(70.0))]}  # fmt: skip
    found = fit(data, BODIES, parameters=[MU, E])
    assert found[MU] == pytest.approx(0.1, rel=1e-6)
    assert found["normal.restitution"] == pytest.approx(0.6, rel=1e-6)
    assert all(np.isnan(one.interval).all() for one in found.parameters.values())
    assert found.notes == ("as many numbers as parameters: the scatter cannot be estimated",)


@pytest.mark.parametrize(
    ("e", "words", "velocity"),
    [
        ([1.04, 1.05, 1.03, 1.06], "above 1, but no law gains energy", False),
        ([1.2, np.nan, np.nan, np.nan], "above 1, but no law gains energy", True),
        ([0.74, 0.75, 0.76, 0.75], "normal=viscoelastic", True),
        ([1.01, 0.99, 1.02, 0.985], "", False),
        *longer(
            ([1.04, 1.05, 1.03, 1.06], "above 1, but no law gains energy", True),
            ([1.2, np.nan, np.nan, np.nan], "above 1, but no law gains energy", False),
            ([0.74, 0.75, 0.76, 0.75], "normal=viscoelastic", False),
            ([1.01, 0.99, 1.02, 0.985], "", True),
        ),
    ],
)
def test_a_restitution_that_the_laws_do_not_have_is_told(e, words, velocity):
    angles = np.array([50.0, 58.0, 64.0, 70.0])
    column = {"normal_restitution": np.array(e)}
    if velocity:
        speed = 2.0 * np.cos(np.radians(angles))
        column = {"rebound_normal_velocity (m/s)": -speed * np.array(e)}
    data = table(1.0 - 0.2 / np.tan(np.radians(angles)), angles, **column)
    notes = " ".join(fit(data, BODIES).notes)
    assert words in notes
    assert words or "the restitution is" not in notes


@pytest.mark.slow
def test_laws_fit_what_they_have_over_the_same_numbers():
    laws = {
        "hertz": None,
        "walton": Simulation(normal="tsuji", tangential="walton"),
        "coulomb": Simulation(normal="tsuji", tangential="coulomb"),
    }
    ranked = rank(SOFT, BALL, laws, parameters=[MU, E, "beta0"])
    assert [one.name for one in ranked] == ["walton", "coulomb", "hertz"]
    walton, coulomb, hertz = ranked
    assert walton.fit["tangential.beta0"] == pytest.approx(0.1, abs=0.002)
    assert walton.fit[MU] == pytest.approx(0.35, rel=0.01)
    assert list(coulomb.fit.parameters) == [MU, "normal.restitution"]
    assert "do not determine friction_coefficient" in hertz.refusal
    # AIC over all numbers: where a quantity is left out, its scatter is that about e = 1
    fitted = rank(SOFT, BALL, {"walton": Simulation(tangential="walton"), "lossy": laws["walton"]},
                  parameters=[MU, "beta0", E])  # fmt: skip
    first, second = fitted
    assert first.name == "lossy"
    normal = 20.0 * np.cos(np.radians(SOFT["angle_deg"]))
    out = -SOFT["rebound_normal_velocity (m/s)"]
    off = [np.mean((out - e * normal) ** 2) for e in (0.75, 1.0)]
    rms = "rebound_tangential_velocity"
    gain = 8.0 * (np.log(off[1] / off[0]) + 2.0 * np.log(second.fit.rms[rms] / first.fit.rms[rms]))
    assert second.fit.aic - first.fit.aic == pytest.approx(gain - 2.0, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("parameters", "scatter", "apart"),
    [([MU, "tangential.shear_loss"], 0.01, 0.06), (["tangential.shear_loss"], 0.03, 2e-3)],
    ids=["by polynomials", "which the laws contradict"],
)
def test_samples_of_the_bootstrap_are_fits_of_the_numbers_drawn(parameters, scatter, apart):
    """Of a loss in shear: where its interval is narrow, and where one sample needs the laws."""

    def laws(loss):
        return Simulation(
            normal=create("normal.tsuji", restitution=0.8),
            tangential=create("tangential.springs", springs=20, shear_loss=loss),
            integrator=create("integrator.symplectic", steps=80),
        )

    angles, count = np.array([5.0, 12.0, 20.0, 30.0, 40.0, 50.0, 60.0]), 7
    bodies = attrs.evolve(BODIES, friction_coefficient=0.2)
    scene = attrs.evolve(
        bodies,
        normal_speed=np.cos(np.radians(angles)),
        tangential_velocity=np.sin(np.radians(angles)),
    )
    scattered = scatter * np.random.default_rng(5).standard_normal(count)
    e_t = laws(1.5).run(scene).check().tangential_restitution + scattered
    columns = {"angle_deg": angles, "speed (m/s)": np.ones(count)}

    def fitted(e_t, **more):
        whole = columns | {"tangential_restitution": e_t}
        return fit(whole, bodies, parameters=parameters, simulation=laws(1.0), **more)

    found = fitted(e_t, bootstrap=3)
    residuals, generator = found.residuals["tangential_restitution"], np.random.default_rng(1976)
    wider, samples = np.sqrt(count / (count - len(parameters))), []
    for _ in range(3):
        signs = wider * generator.choice([-1.0, 1.0], count)
        again = fitted(e_t + (signs - 1.0) * residuals)
        samples.append([again[name] for name in parameters])
    ends = np.quantile(samples, [0.025, 0.975], axis=0)
    told = np.transpose([found.parameters[name].bootstrap for name in parameters])
    assert (np.abs(told - ends) <= 0.5 * apart * (ends[1] - ends[0])).all()
