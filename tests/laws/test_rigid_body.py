"""Section 4.3: the rigid-body theory, exact whatever the step."""

import re

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.impact.hertz import rigid_body_rebound

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


@pytest.mark.parametrize("steps", [1, 2, 7, 100])
@pytest.mark.parametrize("psi1", [-7.0, -2.0, 1e-9, 0.3, 1.2, 4.0, 5.7, 5.77, 9.0])
def test_slip_then_rolling_is_exact_whatever_the_step(steps, psi1):
    """psi2 = 0 for |psi1| < 4 chi, else psi1 - 4 chi."""
    chi = 1.4411764706
    sim = Simulation(
        tangential="coulomb", integrator=contactlab.create("integrator.symplectic", steps=steps)
    )
    result = sim.run(Scene.nondimensional(psi1=psi1, chi=chi)).check()
    assert result.psi2 == pytest.approx(rigid_body_rebound(psi1, chi), abs=1e-14)


@pytest.mark.parametrize(("poisson_ratio", "chi"), [(0.5, 7 / 6), (0.3, 49 / 34), (0.0, 7 / 4)])
def test_the_caution_tells_how_far_off_a_rigid_solid_sphere_is(poisson_ratio, chi):
    assert chi == pytest.approx(3.5 * (1.0 - poisson_ratio) / (2.0 - poisson_ratio))
    psi1 = np.linspace(0.0, 4.0 * chi, 300)
    largest = np.max(np.abs(contactlab.rebound(psi1, chi) - rigid_body_rebound(psi1, chi)))
    plan = Simulation(tangential="coulomb").plan(Scene.nondimensional(psi1=1.0, chi=chi))
    (told,) = re.findall(r"psi2 is off by up to (\d\.\d)\.", str(plan))
    assert largest == pytest.approx(float(told), abs=0.12)


def test_no_chatter_once_the_sphere_rolls():
    """After the change from slip to rolling the force is exactly zero at every instant."""
    sim = Simulation(tangential="coulomb", integrator="symplectic")
    history = sim.run(Scene.nondimensional(psi1=2.0, chi=1.4411764706), history=True).history
    sliding = history.tangential_force != 0.0
    last = int(np.flatnonzero(sliding)[-1])
    assert 0 < last < len(sliding) - 50
    assert sliding[1 : last + 1].all()  # at first touch there is no load yet
    assert (np.diff(sliding[1:].astype(int)) != 0).sum() == 1
    assert history.slip_velocity[last + 1 :] == pytest.approx(0.0, abs=1e-15)


def test_rolling_sphere_of_steel_keeps_five_sevenths():
    """A solid sphere that reaches rolling keeps 5/7 of its tangential velocity (billiards)."""
    scene = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.2, 1.0, 0.5)
    result = Simulation(tangential="coulomb", integrator="symplectic").run(scene)
    assert result.tangential_restitution == pytest.approx(5 / 7, rel=1e-12)
    assert result.rebound_spin * 0.01 == pytest.approx(
        -result.rebound_tangential_velocity, rel=1e-12
    )


def test_friction_work_is_the_energy_lost():
    for psi1 in (0.5, 2.0, 5.0, 7.0):
        energy = (
            Simulation(tangential="coulomb", integrator="symplectic")
            .run(Scene.nondimensional(psi1=psi1, chi=1.4411764706))
            .energy
        )
        assert energy.friction_work > 0
        assert abs(energy.relative_imbalance) < 1e-12


@pytest.mark.parametrize(
    ("psi1", "chi", "lam"),
    [
        ((0.936831, 0.775975), ((1.035001, 0.00086), (0.00086, 1.708060)), (0.223682, 0.0)),
        ((0.826561, -0.513001), ((1.166988, -0.279707), (-0.279707, 1.607568)), (0.23826, 0.0)),
    ],
)
def test_a_slip_that_friction_hardly_stops_stops(psi1, chi, lam):
    """Two of a thousand dropped boxes: friction of 0.3 holds what needs 0.297, in 8 ms, not ever.

    A contact that is held keeps no slip: in units of theory §14 it needs abs(chi^-1 lam) <= 2 rho.
    """
    rho = 0.109286
    assert np.linalg.norm(np.linalg.solve(chi, lam)) < 2.0 * rho
    scene = Scene.nondimensional(psi1=np.array(psi1), chi=np.array(chi), lam=np.array(lam), rho=rho)
    result = Simulation(tangential="coulomb").run(scene).check()
    assert np.linalg.norm(result.psi2) < 1e-8
