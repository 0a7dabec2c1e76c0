"""Bodies whose impact is central: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contactlab import (
    Encounter,
    RigidBody,
    Scene,
    collide,
    rebound,
)
from tests.solve.any_scene import (
    BALL,
    DOWN,
    EXACT,
    FLOOR,
    SPRINGS,
    STEEL,
    meeting,
)


@pytest.mark.parametrize("along", [0, 1])
def test_a_rod_on_its_end_is_answered_by_the_table(along):
    """W does not couple, W_tt is uneven, slip lies along a principal axis: M_t = 1/W_11."""
    velocity = [0.0, 0.0, -1.0]
    velocity[along] = 0.5
    scene = meeting(velocity=velocity).scene
    result = EXACT.run(scene).check()
    assert result.counters == {"tabulated": 1}
    moment = (0.014, 0.01)[along]
    inverse = 1.0 + 0.1**2 / moment
    kappa = 2.0 * (1.0 - STEEL.poisson_ratio) / (2.0 - STEEL.poisson_ratio)
    psi1, chi = kappa * 0.5 / 0.3, 0.5 * kappa * inverse
    assert abs(result.psi1) == pytest.approx(psi1, rel=1e-12)
    psi2 = math.copysign(1.0, float(result.psi1)) * rebound(psi1, chi)
    assert result.psi2 == pytest.approx(psi2, abs=1e-9)
    assert result.normal_restitution == 1.0


def test_a_rod_on_its_end_with_slip_between_its_axes_turns():
    scene = meeting(velocity=(0.5, 0.3, -1.0)).scene
    assert not scene.planar
    assert EXACT.run(scene).check().psi2[1] != 0.0


@pytest.mark.parametrize(("restitution", "room"), [(1.0, 1e-13), (0.7, 1e-9)])
def test_a_sphere_given_as_a_body_is_that_sphere(restitution, room):
    """The relaxation time of a restitution gives it to 2e-10."""
    moment = 0.4 * BALL.mass * BALL.radius**2
    same = RigidBody(
        mass=BALL.mass, principal=3 * (moment,), material=STEEL, curvature_radius=BALL.radius
    )
    numbers = {"normal": DOWN, "velocity": (0.5, 0.3, -1.0), "spin": (3.0, 1.0, 0.0)}
    sphere = collide(Encounter(BALL, FLOOR, 0.3, **numbers), restitution=restitution)
    made = collide(
        Encounter(same, FLOOR, 0.3, contact=(0.0, 0.0, -BALL.radius), **numbers),
        restitution=restitution,
    )
    assert made.velocity == pytest.approx(sphere.velocity, abs=room)
    assert made.spin == pytest.approx(sphere.spin, abs=100.0 * room)
    lost = made.energy.friction_work + made.energy.shear_loss  # of a sphere both are one number
    assert lost == pytest.approx(sphere.energy.friction_work, rel=1e-8)
    assert made.result.counters == sphere.result.counters
    assert made.result.laws == sphere.result.laws


@pytest.mark.parametrize("coupling", [1e-14, 1e-12, 1.1e-12, 1e-11, 1e-10])
def test_elastic_laws_are_continuous_across_the_border(coupling):
    psi1 = np.linspace(-3.0, 3.0, 13) + 0.01
    near = Scene.nondimensional(psi1=psi1, chi=1.4, lam=coupling, eta=coupling)
    central = Scene.nondimensional(psi1=psi1, chi=1.4)
    one_side, other = EXACT.run(near).check(), EXACT.run(central).check()
    assert np.abs(one_side.psi2 - other.psi2).max() < 1e-9
    assert np.abs(one_side.normal_restitution - 1.0).max() < 1e-9
    assert np.abs(one_side.energy.friction_work - other.energy.friction_work).max() < 1e-9


@pytest.mark.parametrize("name", ["planar", "space"])
def test_springs_are_continuous_across_the_border_within_their_error(name):
    """Their grids differ on both sides: they differ by no more than both estimates say."""
    psi1 = np.linspace(-3.0, 3.0, 13) + 0.01
    central = Scene.nondimensional(psi1=psi1, chi=1.4)
    near = Scene.nondimensional(psi1=psi1, chi=1.4, lam=1e-11, eta=1e-11)
    if name == "space":
        slips = np.stack((psi1, 0.0 * psi1), axis=-1)
        chi = [[1.4, 1e-11], [1e-11, 1.0]]
        near = Scene.nondimensional(psi1=slips, chi=chi, lam=(0.0, 0.0), rho=1.0)
    one_side, other = (SPRINGS.run(each, estimate_error=True) for each in (near, central))
    found = np.asarray(one_side.psi2)
    found = found if found.ndim == 1 else found[:, 0]
    both = one_side.psi2_error_estimate + other.psi2_error_estimate
    assert (np.abs(found - other.psi2) <= 2.0 * both).all()
    assert np.abs(found - other.psi2).max() < 1e-3
