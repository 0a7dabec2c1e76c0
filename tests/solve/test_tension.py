"""Contacts that pull: Coulomb's limit is of the friction load, and both directions are alike."""

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from tests.laws.outside_laws import Adhesive
from tests.longer import longer

STEEL = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)
LAWS = {
    "springs": {"springs": 30},
    "annulus": {"annuli": 20},
    "mindlin_cap": {},
    "thornton_yin": {},
    "linear_spring": {"damping": 0.1},
    "coulomb": {},
}


def scene(slip):
    return Scene(Sphere(0.005, STEEL), HalfSpace(STEEL), 0.2, 1.0, slip)


def simulation(name, integrator="symplectic", pull=200.0, reach=2e-7):
    return Simulation(
        normal=Adhesive(pull=pull, reach=reach),
        tangential=contactlab.create(f"tangential.{name}", **LAWS.get(name, {})),
        integrator=contactlab.create(f"integrator.{integrator}"),
    )


@pytest.mark.parametrize("integrator", ["symplectic", "paper", *longer("adaptive")])
@pytest.mark.parametrize("name", [*LAWS, *longer("mindlin_deresiewicz")])
@pytest.mark.parametrize("slip", [0.05, 2.0, *longer(0.3)])
def test_odd_to_the_last_bit(name, integrator, slip):
    """With the limit mu P a pull made clip(-mu P, mu P) one-sided: 2 and -2 m/s differed."""
    sim = simulation(name, integrator)
    forth, back = sim.run(scene(slip)).check(), sim.run(scene(-slip)).check()
    assert forth.psi2 == -back.psi2
    assert forth.motion.friction_work == back.motion.friction_work
    both = sim.run(scene(np.array([slip, -slip, 1.1 * slip]))).check()
    assert both.psi2[0] == -both.psi2[1]
    assert both.psi2[0] == pytest.approx(forth.psi2, abs=1e-8 * max(1.0, abs(forth.psi1)))


@pytest.mark.parametrize("integrator", ["symplectic", "paper"])
@pytest.mark.parametrize("name", [*LAWS, "mindlin_deresiewicz"])
@pytest.mark.parametrize("slip", [2.0, -2.0, 0.05])
def test_force_stays_below_the_limit_of_the_friction_load(name, integrator, slip):
    sim = simulation(name, integrator)
    result = sim.run(scene(slip), history=True).check()
    history = result.history
    assert history.normal_force.min() < 0.0, "the contact never pulls: nothing is tested"
    load = history.normal_force + sim.normal.pull  # the Hertz part
    limit = 0.2 * np.where(history.contact_radius > 0.0, load, 0.0)
    # The load is the mean over a step: no more than the greatest in it and its neighbours.
    padded = np.concatenate(([limit[0]], limit, [limit[-1]]))
    limit = np.maximum(np.maximum(padded[:-2], padded[1:-1]), padded[2:])
    allowed = 1.0 + (1.0 / 20 if name == "annulus" else 1e-9)  # its own error, declared as 1/n
    assert (np.abs(history.tangential_force) <= limit * allowed).all()
    pulled = (history.normal_force < 0.0) & (load > 0.0) & (history.contact_radius > 0.0)
    if abs(slip) > 1.0:
        assert (np.abs(history.tangential_force[pulled]) > 0.5 * limit[pulled]).any()


@pytest.mark.parametrize("name", ["springs", "coulomb"])
def test_gross_slip_is_mu_times_the_load_impulse(name):
    """Not mu times the momentum: the pull is on the normal motion, and not on friction."""
    sim = simulation(name)
    result = sim.run(scene(30.0)).check()
    normal = sim.normal_motion(scene(30.0))
    momentum = normal.scene.pair.normal_mass * (1.0 - normal.final_rate)
    assert normal.total_load_impulse > 1.01 * momentum
    change = -0.2 * normal.total_load_impulse / normal.scene.pair.tangential_mass
    assert result.motion.slip_velocity_change == pytest.approx(change, rel=1e-6)
