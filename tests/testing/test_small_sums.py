"""The arithmetic of single checks: tractions of springs, work given, imbalance, unlike balls."""

import math

import numpy as np
import pytest

import contactlab
from contactlab.compose.simulation import Simulation
from contactlab.testing.accuracy import _exact, _imbalance
from contactlab.testing.energy import given_work
from contactlab.testing.integrators import (
    CHI,
    _energy,
    fitting,
    marched,
    marched_impact,
    slip_velocity,
    sound,
)
from contactlab.testing.laws import DampedHertz, PressedSpring, Slider, SlidingForEver, Yielding
from contactlab.testing.load_paths import Path, scene
from contactlab.testing.point import springs_traction
from contactlab.testing.unlike import BALL, OTHER, _gap, ball, unlike
from contactlab.testing.whole_impacts import answered_impacts
from tests.testing.fresh_sound import HardSphere

SYMPLECTIC = contactlab.create("integrator.symplectic")
EVENTS = contactlab.create("integrator.events")


@pytest.mark.parametrize("count", [3, 40])
def test_springs_that_fall_with_the_square_have_a_hemisphere_of_traction(count):
    """w = d (1 - s²/b²) has q = 2 G* d/(pi b²) sqrt(b² - r²), by Abel's integral."""
    edge, deep, modulus = 0.4, 0.01, 3.0
    places = np.linspace(0.0, 0.6, 3 * count, endpoint=False)  # a third is beyond the edge
    radii, tractions = springs_traction(places, deep * (1.0 - (places / edge) ** 2), edge, modulus)
    inside = int(np.sum(places < edge))
    assert radii.shape == tractions.shape == (inside,)
    assert np.all((places[:inside] < radii) & (radii < edge))
    hemisphere = 2.0 * modulus * deep / (math.pi * edge**2) * np.sqrt(edge**2 - radii**2)
    assert tractions == pytest.approx(hemisphere, rel=1e-12)


def test_the_work_given_is_the_sum_of_mean_force_times_slip():
    path = Path(np.array([1.0, 3.0, 2.0]), np.ones(3))
    # from no force at slip 0: 0.5 * 2 * 1, then 0.5 * (2 + 4) * 2, then 0.5 * (4 - 1) * -1
    assert given_work(path, np.array([2.0, 4.0, -1.0])).tolist() == [1.0, 7.0, 5.5]


def simulation(law, integrator):
    return Simulation(tangential=law, integrator=integrator)


def test_the_exact_change_is_four_chi_or_that_of_the_spring():
    impact = scene(2.0, CHI)
    sliding = simulation(SlidingForEver(), EVENTS)
    assert impact.psi(_exact(sliding, 2.0)) == pytest.approx(-4.0 * CHI)
    spring = simulation(PressedSpring(), SYMPLECTIC)
    rebound = PressedSpring.rebound(contactlab.create("normal.hertz").motion(impact))
    assert impact.psi(_exact(spring, 2.0)) == pytest.approx(2.0 * (rebound - 1.0))
    assert slip_velocity(2.0) == pytest.approx(2.0 * 0.3 * 0.83 / 0.823529)
    assert _energy(2.0) == pytest.approx(
        0.5 * impact.pair.tangential_mass * slip_velocity(2.0) ** 2
    )


@pytest.mark.parametrize(("psi1", "unit"), [(8.0, 64.0), (0.5, 1.0)])
def test_the_imbalance_is_over_the_energy_of_one_or_of_psi1(psi1, unit):
    """A spring that pays nothing for what it takes."""
    spring = simulation(PressedSpring(), SYMPLECTIC)
    change = scene(psi1, CHI).psi(marched_impact(spring, psi1).slip_velocity_change)
    missing = abs(change * (psi1 + 0.5 * change)) / (0.5 * unit)
    assert _imbalance(spring, psi1) == pytest.approx(missing, rel=1e-12)
    closed = simulation(SlidingForEver(), EVENTS)
    assert _imbalance(closed, psi1) == pytest.approx(0.0, abs=1e-12)


def test_laws_that_fit_an_integrator():
    laws = (PressedSpring(), Yielding(), Slider(), SlidingForEver())
    names = [type(each.tangential).__name__ for each in fitting(SYMPLECTIC, laws, "normal.hertz")]
    assert names == ["PressedSpring", "Yielding", "Slider"]
    assert [each.tangential for each in sound(SYMPLECTIC)] == list(laws[:3])
    [only] = fitting(EVENTS, laws, "normal.hertz")
    assert only.tangential == SlidingForEver()
    damped = DampedHertz()
    assert [each.normal for each in fitting(SYMPLECTIC, laws, damped)] == [damped] * 3
    assert list(fitting(EVENTS, laws, damped)) == []


def test_a_march_is_of_the_scene_that_is_asked():
    sliding = simulation(SlidingForEver(), EVENTS)
    for psi1, chi in ((2.0, CHI), (30.0, 3.0)):
        impact = scene(psi1, chi)
        motion = marched_impact(sliding, psi1, chi)
        assert impact.psi(motion.slip_velocity_change) == pytest.approx(-4.0 * chi)
        assert marched(sliding, impact).slip_velocity_change == motion.slip_velocity_change
    seen = []
    marched_impact(simulation(Slider(), SYMPLECTIC), 2.0, recorder=seen.append)
    assert len(seen) > 1


@pytest.mark.parametrize("changed", ["", *BALL])
def test_unlike_balls_differ_in_one_quantity(changed):
    one = ball(changed)
    found = {
        "radius": one.radius,
        "shear_modulus": one.material.shear_modulus,
        "poisson_ratio": one.material.poisson_ratio,
        "mass": one.mass,
    }
    assert found == {**BALL, **({changed: OTHER[changed]} if changed else {})}


def test_unlike_balls_are_exchanged_and_left_out():
    first, exchanged, pair_only = unlike("radius", 2.0)
    assert (first.sphere, first.target) == (exchanged.target, exchanged.sphere)
    assert (first.sphere.radius, first.target.radius) == (BALL["radius"], OTHER["radius"])
    assert (pair_only.sphere, pair_only.pair) == (None, first.pair)
    for given in (first, exchanged, pair_only):
        assert given.psi1 == pytest.approx(2.0)
        assert (given.normal_speed, given.friction_coefficient) == (0.83, 0.3)
    scale = float(first.psi_scale)
    assert _gap(first, 2.0, np.array(1.5)) == pytest.approx(0.5 * scale)
    assert _gap(first, 1.5, 2.0) == pytest.approx(0.5 * scale)
    assert _gap(first, 1.5, math.nan) == math.inf


def test_answered_impacts_are_told_by_psi1_chi_and_reason():
    answered = list(answered_impacts(HardSphere()))
    central = [each for each in answered if each.psi1 == 0.0]
    assert {each.answer.reason for each in central} == {"central impact, no slip velocity"}
    assert {each.answer.reason for each in answered if each.psi1} == {"hard spheres"}
    assert sorted({each.chi for each in answered}) == [0.4, 1.4411764706, 3.0]
    psi1 = {each.psi1 for each in answered if each.chi == 3.0}
    assert {0.0, 0.01, 40.0, -0.3, -6.0, 12.0} < psi1
    for each in answered:
        assert each.scene.psi1 == pytest.approx(each.psi1)
        assert each.scene.chi == pytest.approx(each.chi)
    assert str(answered[1]).startswith("psi1 = 0.01, chi = 0.4, 'hard spheres'")
    damped = DampedHertz()
    assert next(answered_impacts(HardSphere(), damped)).normal.law == damped
