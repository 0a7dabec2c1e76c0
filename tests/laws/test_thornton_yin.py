"""Thornton and Yin's turning points: closed forms, springs, and the exact law."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab.testing.load_paths import Bench, Path, drive, straight
from tests.laws.exact_laws import CHI, order, rms
from tests.longer import longer

LAW = contactlab.create("tangential.thornton_yin")
#: Fine enough that its own error is 1e-3 of mu P_max and less.
SPRINGS = contactlab.create("tangential.springs", springs=400)


def psi2(psi1, chi, steps):
    march = contactlab.create("integrator.symplectic", steps=steps)
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    return Simulation(tangential=LAW, integrator=march).run(scene).check().psi2


@pytest.mark.parametrize("steps", [3, 40])
def test_cattaneo_and_mindlin_at_any_step(steps):
    """F/(mu P) = 1 - (1 - xi)^1.5 at a fixed load, to rounding: a branch is exact."""
    level = 0.8
    path = straight((0.0, level), (1.3 * level, level), steps=steps)
    found = drive(LAW, Bench.of(), path).force[steps:] / level**1.5
    xi = np.minimum(path.slip[steps:] / level, 1.0)
    assert found == pytest.approx(1.0 - (1.0 - xi) ** 1.5, abs=1e-12)


def test_a_sheared_contact_that_grew_in_proportion():
    """Mindlin & Deresiewicz's oblique load: T = h M stuck, then slip within (1 - h) of p."""
    share, steps = 0.6, 50
    grown = straight((share, 1.0), steps=200)  # slip = h zeta, so that it sticks
    shear = np.linspace(share, 1.2, steps + 1)[1:]
    path = Path(np.append(grown.slip, shear), np.append(grown.level, np.ones(steps)))
    force = drive(LAW, Bench.of(), path).force
    assert force[: len(grown.slip)] == pytest.approx(share * grown.level**1.5, abs=1e-9)
    xi = np.minimum((shear - share) / (1.0 - share), 1.0)
    slipped = 1.0 - (1.0 - xi) ** 1.5
    assert force[len(grown.slip) :] == pytest.approx(share + (1.0 - share) * slipped, abs=1e-3)


@pytest.mark.parametrize(
    "knots",
    [
        [(0.0, 0.6), (0.3, 0.6), (-0.2, 0.6), (0.5, 0.6)],
        [(0.0, 0.6), (0.35, 0.6), (0.55, 0.75)],  # pressed more, sheared faster
        [(0.0, 0.9), (0.5, 0.9), (0.1, 0.4)],  # let go while the load falls
        [(0.0, 0.9), (2.0, 0.9), (1.8, 0.6), (1.2, 0.6)],
        [(0.0, 0.9), (0.3, 0.9), (0.3, 0.2)],  # the load falls alone
    ],
)
def test_paths_that_two_turning_points_describe(knots):
    """The bundle of springs, which keeps the whole traction, goes the same way."""
    path, bench = straight(*knots, steps=120), Bench.of()
    gap = drive(LAW, bench, path).force - drive(SPRINGS, bench, path).force
    assert np.max(np.abs(gap)) < 4e-3


def test_what_two_turning_points_leave_out():
    """After gross slip the contact grows, stuck: its traction is no share of p alike everywhere."""
    path, bench = straight((0.0, 0.3), (1.0, 0.3), (1.3, 0.9), (2.5, 0.9)), Bench.of()
    gap = drive(LAW, bench, path).force - drive(SPRINGS, bench, path).force
    assert 0.01 < np.max(np.abs(gap)) < 0.04


def errors(chi, steps):
    """Rms of psi2 against four times the most steps."""
    psi1 = np.linspace(0.1, 4.0 * chi, 12)
    limit = psi2(psi1, chi, 4 * max(steps))
    return [rms(psi2(psi1, chi, count) - limit) for count in steps]


@pytest.mark.parametrize("chi", [0.4, *longer(1.0, CHI)])
def test_second_order_in_steps(chi):
    steps = (50, 100, 200, 400)
    assert order(steps, errors(chi, steps)) == pytest.approx(2.0, abs=0.35)


@pytest.mark.slow
def test_order_where_slip_zones_vanish():
    """At chi = 3 the branch of a step in which a slip zone vanishes is chosen at its end."""
    steps = (200, 400, 800, 1600)
    assert 0.7 < order(steps, errors(3.0, steps)) < 2.0


def test_nearer_to_the_exact_law_than_a_capped_spring():
    """The caution's figure holds, and every form of the capped spring is three times as far."""
    psi1 = np.linspace(0.05, 6.0, 20)
    exact = Simulation().run(Scene.nondimensional(psi1=psi1, chi=CHI)).check().psi2
    apart = psi2(psi1, CHI, 200) - exact
    assert np.max(np.abs(apart)) < 0.15
    for form in ("displacement", "displacement_rescaled", "increment", "increment_rescaled"):
        spring = contactlab.create("tangential.mindlin_cap", form=form)
        scene = Scene.nondimensional(psi1=psi1, chi=CHI)
        found = Simulation(tangential=spring).run(scene).check().psi2
        assert rms(found - exact) > 3.0 * rms(apart)


def test_slip_throughout_from_first_touch_is_exact():
    psi1 = np.array([4.8, 5.5, 7.0])  # 4 chi - 1 is 4.76
    assert psi2(psi1, CHI, 50) == pytest.approx(psi1 - 4.0 * CHI, abs=1e-12)


def test_huge_friction():
    """mu = 1e12: the stuck contact to some digits, though the limit is 1e12 of the force."""
    ball = contactlab.Sphere(0.01, contactlab.Material(
        young_modulus=208e9, poisson_ratio=0.3, density=7850.0))  # fmt: skip
    found = []
    for friction in (1e4, 1e12):
        scene = Scene(ball, contactlab.HalfSpace(ball.material), friction, 1.0, 0.5)
        result = Simulation(tangential=LAW).run(scene).check()
        found.append(float(result.motion.slip_velocity_change))
        assert result.motion.friction_work >= 0.0
    assert found[1] == pytest.approx(found[0], rel=1e-4)
