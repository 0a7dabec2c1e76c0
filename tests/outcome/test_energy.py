"""The energy books where the normal motion loses energy of its own, and where it makes some."""

import attrs
import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status
from contactlab.outcome.energy import judge_books
from tests.laws.normal_laws import Damped
from tests.laws.tangential_laws import Creator, Slinger

STEEL = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)


def scene(speed=0.5, slip=0.15):
    return Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.2, speed, slip, 0.0)


def restitution_of_hunt_and_crossley(damping, speed):
    """Solve the law's own first integral, y + ln(1 - y) from -d e v to d v, for e.

    With v dv/dz = -k z^1.5 (1 + d v)/m the energy of the spring is gone at both ends, so
    the integral of v/(1 + d v) over v from -e v to v vanishes.
    """
    from scipy.optimize import brentq

    def held(rate):
        return damping * rate - np.log1p(damping * rate)

    return brentq(lambda e: held(-e * speed) - held(speed), 0.1, 1.0)


def test_damping_is_booked_as_a_loss_of_the_normal_motion():
    speed = 0.5
    law = Damped()
    result = Simulation(normal=law, tangential="coulomb", integrator="symplectic").run(scene(speed))
    e = restitution_of_hunt_and_crossley(law.damping, speed)
    assert e == pytest.approx(0.935, abs=0.005)
    lost = 0.5 * result.scene.pair.normal_mass * speed**2 * (1 - e**2)
    assert result.check().energy.normal_loss == pytest.approx(lost, rel=1e-3)
    assert abs(result.energy.relative_imbalance) < 1e-12


@pytest.mark.parametrize("integrator", ["symplectic", "paper", "adaptive"])
def test_the_loss_is_the_work_of_the_normal_force(integrator):
    """So a history's normal velocity is that at the instant of its force."""
    simulation = Simulation(normal=Damped(), tangential="springs", integrator=integrator)
    result = simulation.run(scene(), history=True)
    course = result.check().history
    power = course.normal_force * course.normal_velocity
    work = np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(course.time))
    assert result.energy.normal_loss == pytest.approx(work, rel=2e-3)


@pytest.mark.parametrize("law", ["annulus", "springs"])
def test_a_damped_impact_is_no_breach_of_the_books(law):
    """Laws that declare a bound declare it of friction alone."""
    simulation = Simulation(normal=Damped(damping=1.0), tangential=law, integrator="symplectic")
    result = simulation.run(scene()).check()
    assert result.normal_restitution < 0.8
    books = result.energy
    lost = books.start - books.end
    assert lost == pytest.approx(books.normal_loss + books.friction_work, rel=0.01)


@pytest.mark.parametrize("batch", [False, True])
def test_bodies_that_part_faster_than_they_met_are_a_status(batch):
    given = scene(np.array([0.5, 0.6]), np.array([0.1, 0.2])) if batch else scene()
    makes_energy = Simulation(
        normal=Damped(damping=-0.3), tangential="coulomb", integrator="symplectic"
    )
    result = makes_energy.run(given)
    assert np.all(np.array(result.status, dtype=object) == Status.UNBALANCED)
    told = np.ravel(np.array(result.motion.detail, dtype=object))
    normal = np.ravel(makes_energy.normal_motion(given).final_rate / given.normal_speed)
    for item, e in zip(told, -normal, strict=True):
        assert item == f"Without friction the bodies part {e:.4g} times as fast as they met."


def statuses(result):
    return [status.name for status in result.status]


def test_of_a_batch_only_those_that_part_too_fast_have_the_status():
    """What damping of the wrong sign makes grows with the speed."""
    makes_energy = Simulation(
        normal=Damped(damping=-0.3), tangential="coulomb", integrator="symplectic"
    )
    result = makes_energy.run(scene(np.array([1e-11, 0.5]), np.array([0.1, 0.2])))
    assert statuses(result) == ["SUCCESS", "UNBALANCED"]
    assert result[1].motion.detail.startswith("Without friction the bodies part")
    assert np.isnan(result.normal_restitution[1])
    assert result.normal_restitution[0] == pytest.approx(1.0, abs=1e-3)


def test_of_a_batch_only_those_that_slip_too_fast_have_the_status():
    """Friction that drives the slip on adds 4 chi to psi: little to much slip, much to little."""
    sim = Simulation(tangential=Slinger(), integrator="symplectic")
    result = sim.run(Scene.nondimensional(psi1=[100.0, 0.5], chi=1.44))
    assert "Slinger is the cause" in str(result)
    assert statuses(result) == ["SUCCESS", "UNBALANCED"]
    assert result[1].motion.detail == "The contact slips 12.52 times as fast as it met."


def test_of_a_batch_only_those_whose_books_miss_have_the_status():
    sim = Simulation(tangential=Creator(), integrator="symplectic")
    result = sim.run(Scene.nondimensional(psi1=[1e4, 6.0], chi=1.44))
    assert statuses(result) == ["SUCCESS", "UNBALANCED"]
    start = 0.5 + 36.0 / (4.0 * 1.44)
    assert result.energy.start[1] == pytest.approx(start)
    assert np.isnan(result.energy.relative_imbalance[1])
    change = 0.4 * 1.44  # psi grows by a tenth of 4 chi, and the law tells no work
    share = change * (6.0 + 0.5 * change) / (2.0 * 1.44) / start
    assert f"Off by {share:.2g} of the energy at the start" in result[1].motion.detail


def test_slip_out_of_none_is_energy_from_nothing():
    """A factor of infinity, and no error, though one impact is in plain numbers."""
    met = scene(slip=0.0)
    motion = Simulation(tangential="coulomb").run(met).motion
    slung = attrs.evolve(motion, slip_velocity_change=1e-3)
    found, _ = judge_books(slung, met, np.inf)
    assert found.status is Status.UNBALANCED
    assert found.detail == "The contact slips inf times as fast as it met."
