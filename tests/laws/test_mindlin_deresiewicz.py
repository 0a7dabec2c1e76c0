"""The sum of irreducible components: Mindlin & Deresiewicz with the whole history."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.testing.load_paths import Bench, Path, drive, straight
from tests.laws.exact_laws import CHI, order, rms
from tests.longer import longer

LAW = contactlab.create("tangential.mindlin_deresiewicz")
MERGED = contactlab.create("tangential.mindlin_deresiewicz", components=64)
#: Without loss in shear, as the law, and fine enough that their own error is 1e-6 of mu P_max.
SPRINGS = contactlab.create("tangential.springs", springs=800, shear_loss=0.0)
PSI1 = np.array([0.1, 0.2, 0.4, 0.6, 0.8, 0.95, 1.05, 1.2, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6])


def simulation(law=LAW, steps=200, normal="hertz", integrator="symplectic"):
    march = contactlab.create(f"integrator.{integrator}", steps=steps)
    return Simulation(normal=normal, tangential=law, integrator=march)


def psi2(law, psi1, chi, steps, integrator="symplectic"):
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    return simulation(law, steps, integrator=integrator).run(scene).check().psi2


def exact(psi1, chi):
    return Simulation().run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2


def test_second_order_towards_the_exact_law():
    steps, psi1 = (25, 50, 100), PSI1[::3]
    errors = [rms(psi2(LAW, psi1, CHI, count) - exact(psi1, CHI)) for count in steps]
    assert order(steps, errors) == pytest.approx(2.0, abs=0.15)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("chi", "worst"), [(1.17, (5.2e-3, 8e-5, 5.1e-6)), (CHI, (7.8e-3, 1.3e-4, 7.6e-6)),
                       (1.75, (1.28e-2, 1.9e-4, 1.1e-5))],
)  # fmt: skip
def test_second_order_up_to_800_steps(chi, worst):
    steps = (25, 50, 100, 200, 400, 800)
    errors = {count: psi2(LAW, PSI1, chi, count) - exact(PSI1, chi) for count in steps}
    assert order(steps, [rms(each) for each in errors.values()]) == pytest.approx(2.0, abs=0.15)
    for count, most in zip((25, 200, 800), worst, strict=True):
        assert np.max(np.abs(errors[count])) < most


@pytest.mark.slow
@pytest.mark.parametrize("chi", [1.17, CHI, 1.75])
def test_the_two_methods_agree_closely(chi):
    """Maw, Barber & Fawcett, introduction: of annuli and of the sum of components."""
    psi1 = np.append(PSI1, [0.3, 0.5, 0.7, 0.9, 1.0, 1.1, 1.3, 1.75])
    annuli = psi2("annulus", psi1, chi, 200, "paper")
    components = psi2(LAW, psi1, chi, 200, "paper")
    assert np.max(np.abs(components - annuli)) < 5.2e-3
    assert rms(components - annuli) < 2.8e-3
    # The distance is the annuli's own: the components are ten times as near to the exact law.
    assert rms(components - exact(psi1, chi)) < 0.1 * rms(annuli - exact(psi1, chi))


@pytest.mark.parametrize("steps", [3, 40])
def test_cattaneo_and_mindlin_at_any_step(steps):
    level = 0.8
    path = straight((0.0, level), (1.3 * level, level), steps=steps)
    found = drive(LAW, Bench.of(), path).force[steps:] / level**1.5
    xi = np.minimum(path.slip[steps:] / level, 1.0)
    assert found == pytest.approx(1.0 - (1.0 - xi) ** 1.5, abs=1e-12)


@pytest.mark.parametrize("steps", [3, 40])
def test_an_oblique_load_is_exact_at_any_step(steps):
    """Mindlin & Deresiewicz: T = h M stuck, then slip within (1 - h) of p."""
    share = 0.6
    path = straight((share, 1.0), (1.2, 1.0), steps=steps)  # slip = h zeta, so that it sticks
    force = drive(LAW, Bench.of(), path).force
    xi = np.minimum((path.slip[steps:] - share) / (1.0 - share), 1.0)
    assert force[:steps] == pytest.approx(share * path.level[:steps] ** 1.5, abs=1e-12)
    assert force[steps:] == pytest.approx(share + (1 - share) * (1 - (1 - xi) ** 1.5), abs=1e-12)


def random_path(draws):
    """Return straight stretches of 20 steps between levels and slips that wander."""
    level = 0.2 + np.abs(np.cumsum(draws.normal(size=12)) * 0.3)
    slip = np.cumsum(draws.normal(size=12)) * 0.3
    knots, fine = np.arange(12), np.arange(221) / 20
    return Path(np.interp(fine, knots, slip), np.interp(fine, knots, level / level.max()))


@pytest.mark.parametrize("paths", [3, *longer(60)])
def test_random_load_paths_beside_springs(paths):
    draws, bench = np.random.default_rng(1), Bench.of()
    for _ in range(paths):
        path = random_path(draws)
        gap = drive(LAW, bench, path).force - drive(SPRINGS, bench, path).force
        assert np.max(np.abs(gap)) < 1e-5  # over mu N_max


@pytest.mark.slow
@pytest.mark.parametrize(
    "normal",
    ["hertz", "linear", "tsuji", "hunt_crossley", "kuwabara_kono", "viscoelastic", "walton_braun",
     "thornton", "jkr", "dmt"],
)  # fmt: skip
def test_the_limit_of_springs_under_any_normal_law(normal):
    ball = contactlab.Sphere(0.005, contactlab.Material.named("steel"))
    psi1 = np.linspace(0.03, 1.8, 8)
    scene = Scene(ball, contactlab.HalfSpace(ball.material), 0.1, 1.0, psi1)
    springs = contactlab.create("tangential.springs", springs=200, shear_loss=0.0)
    found = simulation(steps=400, normal=normal).sweep(scene).check().psi2
    limit = simulation(springs, steps=400, normal=normal).sweep(scene).check().psi2
    assert found == pytest.approx(limit, abs=3e-5)


def most_components(law, psi1, steps):
    """Return the most components in an impact, and those at its end."""
    history = simulation(law, steps).run(
        Scene.nondimensional(psi1=psi1, chi=CHI), history="fields"
    ).check().history  # fmt: skip
    counts = history.fields["components"]
    return counts.max(), counts[-1]


def test_the_history_grows_with_the_steps_while_the_contact_sticks():
    few, many = (most_components(LAW, 0.3, steps) for steps in (100, 400))
    assert 3.5 < many[0] / few[0] < 4.5
    assert many[1] < 0.1 * 400  # overtaken by slip, and merged


@pytest.mark.parametrize("steps", [400, *longer(3_200)])
@pytest.mark.parametrize("psi1", [0.3, *longer(0.1, 0.8, 1.2)])
def test_merging_ends_the_growth(psi1, steps):
    """So the number of steps has no limit: time follows the components."""
    assert most_components(MERGED, psi1, steps)[0] <= 64
    apart = psi2(MERGED, psi1, CHI, steps) - psi2(LAW, psi1, CHI, steps)
    assert abs(apart) < 1e-4


@pytest.mark.parametrize("value", [0, 7, 64.5, True, 100_000_000])
def test_a_number_of_components_out_of_range(value):
    with pytest.raises(ValueError, match="components"):
        contactlab.create("tangential.mindlin_deresiewicz", components=value)


def test_the_traction_carries_the_force():
    scene = Scene.nondimensional(psi1=1.2, chi=CHI)
    history = simulation().run(scene, history="fields").check().history
    radius, traction = history.fields["radius"], history.fields["traction"]
    width = radius[:, 1] - radius[:, 0]
    carried = 2.0 * np.pi * (radius * traction).sum(axis=1) * width
    assert carried == pytest.approx(history.tangential_force, abs=1e-2 * carried.max())
