"""Estimates and their errors against closed forms, exact answers, and chance."""

import attrs
import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Simulation, Sphere
from contactlab.numeric.checks import POSITIVE, quantity
from contactlab_fit import fit, rank
from contactlab_fit.model import Model, scene_of
from contactlab_fit.parameters import Setup, find_parameter
from tests.fitting.impacts import ANGLES, BODIES, STEEL, restitution, scene, table
from tests.laws.outside_laws import Walton
from tests.longer import longer

SLIPPING = np.array([45.0, 50.0, 55.0, 60.0, 65.0, 70.0])
BOTH = ("friction_coefficient", "stiffness_ratio")


def scattered(values, size, seed=1):
    return values + np.random.default_rng(seed).normal(0.0, size, len(values))


@pytest.mark.parametrize("poisson", [0.0, *longer(0.3), 0.45])
def test_friction_and_stiffness_that_made_the_data_are_found(poisson):
    """By the exact solution, event by event; the fit goes by the table and from steel."""
    material = Material(young_modulus=70e9, poisson_ratio=poisson, density=2500.0)
    found = fit(table(restitution(0.17, material=material)), BODIES, parameters=BOTH)
    assert found["friction_coefficient"] == pytest.approx(0.17, abs=1e-6)
    kappa = 2.0 * (1.0 - poisson) / (2.0 - poisson)
    assert found["stiffness_ratio"] == pytest.approx(kappa, abs=1e-6)
    assert found.rms["tangential_restitution"] < 1e-7


@pytest.mark.parametrize("start", [0.001, *longer(0.1), 5.0])
def test_the_start_does_not_matter(start):
    bodies = attrs.evolve(BODIES, friction_coefficient=start)
    assert fit(table(restitution(0.3)), bodies)["friction_coefficient"] == pytest.approx(0.3, 1e-6)


def test_gross_slip_is_a_straight_line_through_the_origin():
    """e_t = 1 - 2 mu/tan(angle): slope and standard error in closed form."""
    slope = 2.0 / np.tan(np.radians(SLIPPING))
    measured = scattered(1.0 - 0.1 * slope, 0.004)
    mu = slope @ (1.0 - measured) / (slope @ slope)
    off = 1.0 - measured - mu * slope
    error = np.sqrt(off @ off / (len(off) - 1) / (slope @ slope))
    found = fit(table(measured, SLIPPING), BODIES)
    one = found.parameters["friction_coefficient"]
    assert one.value == pytest.approx(mu, rel=1e-6)
    assert one.standard_error == pytest.approx(error, rel=1e-4)
    assert one.interval == pytest.approx((mu - 2.5706 * error, mu + 2.5706 * error), rel=1e-4)
    assert found.residuals["tangential_restitution"] == pytest.approx(-off, abs=1e-8)
    assert found.rms["tangential_restitution"] == pytest.approx(np.sqrt(np.mean(off**2)))


@pytest.mark.parametrize("wrong", [1.0, 0.5, 2.0])
def test_known_errors_weigh_and_are_widened_if_too_small(wrong):
    slope = 2.0 / np.tan(np.radians(SLIPPING))
    true = np.linspace(0.002, 0.01, len(SLIPPING))
    pulls = np.array([1.0, -1.2, 0.9, -0.8, 1.1, -1.0])
    measured, errors = 1.0 - 0.1 * slope + true * pulls, true / wrong
    weights = 1.0 / errors**2
    mu = np.sum(weights * slope * (1.0 - measured)) / np.sum(weights * slope**2)
    chi_square = np.sum(weights * (1.0 - measured - mu * slope) ** 2) / (len(SLIPPING) - 1)
    error = np.sqrt(max(chi_square, 1.0) / np.sum(weights * slope**2))
    data = table(measured, SLIPPING, tangential_restitution_error=errors)
    found = fit(data, BODIES)
    assert found["friction_coefficient"] == pytest.approx(mu, rel=1e-6)
    assert found.parameters["friction_coefficient"].standard_error == pytest.approx(error, 1e-4)
    assert found.reduced_chi_square == pytest.approx(chi_square, rel=1e-4)
    assert any("times the errors given" in note for note in found.notes) == (chi_square > 2.0)


def test_errors_of_one_quantity_alone_are_no_errors_of_all():
    slope = 2.0 / np.tan(np.radians(SLIPPING))
    pulls = 0.002 * np.array([1.0, -1.2, 0.9, -0.8, 1.1, -1.0])
    errors = np.full(len(SLIPPING), 0.002)
    data = table(1.0 - 0.1 * slope + pulls, SLIPPING, tangential_restitution_error=errors)
    assert fit(data, BODIES).reduced_chi_square is not None
    data["beta0"] = -(1.0 - 0.35 * slope + pulls)
    assert fit(data, BODIES).reduced_chi_square is None


def test_a_law_s_restitution_is_the_mean_of_those_measured():
    measured = np.array([0.81, 0.84, 0.79, 0.83, 0.82])
    data = {
        "angle_deg": np.zeros(5),
        "speed (m/s)": np.full(5, 1.0),
        "normal_restitution": measured,
    }
    laws = Simulation(normal="tsuji", tangential="coulomb")
    for name in ("restitution", "normal.restitution"):
        one = fit(data, BODIES, parameters=[name], simulation=laws).parameters["normal.restitution"]
        assert one.value == pytest.approx(measured.mean(), rel=1e-6)
        assert one.standard_error == pytest.approx(measured.std(ddof=1) / np.sqrt(5.0), rel=1e-3)


def test_any_law_is_fitted_by_its_steps():
    laws, angles = Simulation(tangential="springs"), ANGLES[::3]
    found = fit(table(restitution(0.2, angles, laws=laws), angles), BODIES, simulation=laws)
    assert found["friction_coefficient"] == pytest.approx(0.2, abs=1e-5)
    exact = fit(table(restitution(0.2, angles), angles), BODIES, simulation=laws)
    assert exact["friction_coefficient"] == pytest.approx(0.2, abs=2e-4)  # its numerical error


def test_an_option_of_somebody_s_law_is_fitted_by_its_name():
    """Walton: rolling with the share beta of the slip given back, (1 + beta) M_t v_x."""
    angles = np.array([2.0, 4.0, 6.0, 8.0, 40.0, 50.0, 60.0])
    values = restitution(0.2, angles, laws=Simulation(tangential=Walton(beta=0.37)))
    laws = Simulation(tangential=Walton())
    names = ["beta", "friction_coefficient"]
    found = fit(table(values, angles), BODIES, parameters=names, simulation=laws)
    assert found["tangential.beta"] == pytest.approx(0.37, abs=1e-6)
    assert found["friction_coefficient"] == pytest.approx(0.2, abs=1e-6)


@attrs.frozen(kw_only=True)
class InPascals(Walton):
    """Walton's law, its restitution by way of a pressure."""

    pressure: float = quantity("Pa", rule=POSITIVE, default=2e9)

    def whole_impacts(self, scene, normal):
        return Walton(beta=self.pressure / 1e10).whole_impacts(scene, normal)


def test_a_parameter_may_be_of_any_size():
    values = restitution(0.2, ANGLES[:5], laws=Simulation(tangential=Walton(beta=0.37)))
    laws = Simulation(tangential=InPascals())
    found = fit(table(values, ANGLES[:5]), BODIES, parameters=["pressure"], simulation=laws)
    assert found["tangential.pressure"] == pytest.approx(3.7e9, rel=1e-6)


def test_many_points_are_predicted_as_one_by_one():
    setup = Setup(scene_of(scene(0.1), {}, len(ANGLES)), None)
    model = Model(setup=setup, parameters=tuple(find_parameter(name, setup) for name in BOTH))
    points = np.array([[0.1, 0.8], [0.2, 0.7], [0.05, 1.2]])
    many = model.predict(points, ["tangential_restitution"])["tangential_restitution"]
    for row, point in zip(many, points, strict=True):
        alone = model.predict(point[None], ["tangential_restitution"])["tangential_restitution"]
        assert row == pytest.approx(alone[0], abs=1e-12)


def test_the_stiffness_ratio_leaves_normal_contact_as_it_is():
    glass = Material(young_modulus=70e9, poisson_ratio=0.22)
    before = attrs.evolve(scene(0.1), target=HalfSpace(glass))
    setup = Setup(before, None)
    after = find_parameter("stiffness_ratio", setup).apply(setup, 0.93).scene
    assert after.pair.stiffness_ratio == pytest.approx(0.93, rel=1e-12)
    assert after.pair.effective_modulus == pytest.approx(before.pair.effective_modulus, rel=1e-12)
    assert after.pair.normal_mass == before.pair.normal_mass


@pytest.mark.slow
def test_every_quantity_of_a_rebound_says_the_same():
    result = Simulation().sweep(scene(0.13)).check()
    given = {"normal_speed (m/s)": result.scene.normal_speed,
             "tangential_velocity (m/s)": result.scene.tangential_velocity}  # fmt: skip
    found = {
        "tangential_restitution (1)": result.tangential_restitution,
        "beta0": result.beta0,
        "rebound_angle (deg)": np.degrees(result.rebound_angle),
        "rebound_angle (rad)": result.rebound_angle,
        "rebound_spin (rpm)": result.rebound_spin * 60.0 / (2.0 * np.pi),
        "rebound_tangential_velocity (mm/s)": result.rebound_tangential_velocity * 1e3,
        "rebound_slip_velocity (m/s)": result.rebound_slip_velocity,
    }
    for heading, values in found.items():
        mu = fit(given | {heading: values}, BODIES)["friction_coefficient"]
        assert mu == pytest.approx(0.13, abs=1e-6), heading


def test_two_quantities_are_weighted_by_their_own_scatter():
    """One is ten times as sharp: together they are as sharp as the sharp one, or sharper."""
    result = Simulation().sweep(scene(0.13)).check()
    sharp = scattered(result.tangential_restitution, 0.002)
    blunt = scattered(np.degrees(result.rebound_angle), 3.0, seed=2)
    data = table(sharp) | {"rebound_angle_deg": blunt}
    both = fit(data, BODIES).parameters["friction_coefficient"]
    one = fit(table(sharp), BODIES).parameters["friction_coefficient"]
    assert both.value == pytest.approx(one.value, abs=one.standard_error)
    assert both.standard_error == pytest.approx(one.standard_error, rel=0.15)


def test_gaps_are_left_out():
    values = restitution(0.13)
    some = np.array(values)
    some[::3] = np.nan
    data = table(some) | {"beta0": np.where(np.isnan(some), 0.2, np.nan)}
    found = fit(data, BODIES, quantities=["tangential_restitution"])
    assert found["friction_coefficient"] == pytest.approx(0.13, abs=1e-6)
    assert len(found.measurements) == np.isfinite(some).sum()


@pytest.mark.slow
def test_standard_errors_are_the_spread_of_estimates():
    true, estimates, errors = restitution(0.12), [], []
    for seed in range(25):
        found = fit(table(scattered(true, 0.01, seed)), BODIES, parameters=BOTH)
        estimates.append([one.value for one in found.parameters.values()])
        errors.append([one.standard_error for one in found.parameters.values()])
    spread = np.std(estimates, axis=0, ddof=1)
    assert np.mean(errors, axis=0) == pytest.approx(spread, rel=0.4)  # 15 % by chance
    assert np.mean(estimates, axis=0) == pytest.approx([0.12, 14 / 17], abs=0.005)


@pytest.mark.slow
def test_intervals_of_the_bootstrap_cover_the_truth():
    """The bootstrap of few numbers is somewhat narrow: 12 impacts, 0.8 and more."""
    true, covered = restitution(0.12), 0
    for seed in range(30):
        data = table(scattered(true, 0.01, seed))
        low, high = fit(data, BODIES, bootstrap=60).parameters["friction_coefficient"].bootstrap
        covered += low <= 0.12 <= high
    assert covered / 30 >= 0.8


@pytest.mark.slow
def test_the_bootstrap_is_as_wide_as_the_covariance_and_the_same_each_time():
    angles = np.linspace(8.0, 60.0, 20)
    data = table(scattered(restitution(0.12, angles), 0.01), angles)
    calls = []
    found = fit(data, BODIES, bootstrap=40, progress=lambda *done: calls.append(done))
    one = found.parameters["friction_coefficient"]
    assert np.ptp(one.bootstrap) == pytest.approx(np.ptp(one.interval), rel=0.35)
    assert calls == [(done, 40) for done in range(1, 41)]
    ends = [
        fit(data, BODIES, bootstrap=3, seed=seed).parameters["friction_coefficient"].bootstrap
        for seed in (1, 1, 2)
    ]
    assert ends[0] == ends[1]
    assert ends[0] != ends[2]


@pytest.mark.slow
def test_laws_are_ranked_by_their_fit():
    laws = {"exact": None, "coulomb": Simulation(tangential="coulomb")}
    three = laws | {"walton": Simulation(tangential="walton")}
    for name, law in laws.items():
        data = table(scattered(restitution(0.1, laws=law), 0.003))
        ranked = rank(data, BODIES, three)
        assert ranked[0].name == name
        assert ranked[0].fit["friction_coefficient"] == pytest.approx(0.1, abs=0.01)
        assert ranked[1].fit.aic - ranked[0].fit.aic > 10.0
    data = table(scattered(restitution(0.1), 0.003))
    ranked = rank(data, BODIES, laws, parameters=["stiffness_ratio"])
    assert [one.name for one in ranked] == ["exact", "coulomb"]
    assert ranked[1].fit is None
    assert "no rebound of these laws depends" in ranked[1].refusal


def test_a_spinning_sphere_of_two_bodies():
    spins = np.linspace(-300.0, 300.0, 9)
    made = attrs.evolve(scene(0.1, np.full(9, 20.0)), spin=spins, target=Sphere(0.02, STEEL))
    result = Simulation().sweep(made).check()
    bodies = attrs.evolve(BODIES, target=Sphere(0.02, STEEL))
    data = {"speed (m/s)": np.full(9, 2.0), "angle (deg)": np.full(9, 20.0), "spin (rad/s)": spins,
            "rebound_spin (rad/s)": result.rebound_spin}  # fmt: skip
    assert fit(data, bodies)["friction_coefficient"] == pytest.approx(0.1, abs=1e-6)


def test_a_scene_without_bodies_has_options_of_laws_alone():
    psi1 = np.linspace(0.5, 5.0, 8)
    batch = contactlab.Scene.nondimensional(psi1=psi1, chi=1.4412)
    laws = Simulation(
        normal=contactlab.create("normal.tsuji", restitution=0.7), tangential="coulomb"
    )
    psi2 = laws.sweep(batch).check().psi2
    found = fit({"psi2": psi2}, batch, parameters=["restitution"],
                simulation=Simulation(normal="tsuji", tangential="coulomb"))  # fmt: skip
    assert found["normal.restitution"] == pytest.approx(0.7, abs=1e-5)
    with pytest.raises(ValueError, match="no such number"):
        fit({"psi2": psi2}, batch)


def test_the_criterion_is_akaikes():
    """n log(mean squared residual) + 2 (parameters + unknown scatter), up to a constant."""
    data = table(scattered(restitution(0.1), 0.003))
    one = fit(data, BODIES)
    two = fit(data, BODIES, parameters=["friction_coefficient", "stiffness_ratio"])
    numbers = one.counts["tangential_restitution"]
    logs = [2.0 * numbers * np.log(each.rms["tangential_restitution"]) for each in (one, two)]
    assert two.aic - one.aic == pytest.approx(logs[1] - logs[0] + 2.0, abs=1e-6)
