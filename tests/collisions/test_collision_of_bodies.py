"""Collisions: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import pickle

import attrs
import numpy as np
import pytest

from contactlab import Collision, Sphere, collide
from contactlab.contracts.status import Status
from tests.solve.any_scene import DOWN, EXACT, FEW, FLOOR, OFF_CENTRE, SPHERES, STEEL, meeting

MET = {
    "sphere": SPHERES,
    "central": meeting(),
    "planar": meeting(contact=(0.02, 0, -0.1)),
    "space": OFF_CENTRE,
}
each_met = pytest.mark.parametrize("met", MET.values(), ids=MET)
ELSEWHERE = meeting(
    velocity=(5.0, 0.0, -1.0), contact=(0.05, 0.0, -0.1), friction_coefficient=0.9
)  # fmt: skip


@each_met
def test_a_collision_of_a_foreign_result_is_refused(met):
    own = Collision.of(met, EXACT.run(met.scene))
    assert own.velocity == pytest.approx(collide(met).velocity, rel=1e-9)
    faster = attrs.evolve(met, velocity=1.5 * met.velocity)
    for other in (ELSEWHERE, faster):
        with pytest.raises(ValueError, match=r"must be the result of encounter.scene"):
            Collision.of(met, EXACT.run(other.scene))
    with pytest.raises(ValueError, match=r"must be the result of encounter.scene"):
        Collision.of(met, collide(met))


@each_met
@pytest.mark.parametrize("options", [{}, {"restitution": 0.5}, {"simulation": FEW}], ids=str)
def test_a_single_encounter_that_does_not_approach_passes(met, options):
    away = attrs.evolve(met, velocity=(0.5, 0.0, 1.0), spin=(1.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="separating='pass'"):
        collide(away, **options)
    made = collide(away, separating="pass", **options)
    assert not made.collided
    assert made.velocity.tolist() == [0.5, 0.0, 1.0]
    assert made.spin.tolist() == [1.0, 0.0, 0.0]
    assert made.impulse.tolist() == [0.0, 0.0, 0.0]
    assert made.status is Status.SUCCESS
    assert made.energy.friction_work == 0.0
    assert made.to_dict()["energy"]["relative_imbalance"] == 0.0
    assert made.normal_velocity == pytest.approx(away.meeting().approach)
    assert "pass through untouched" in str(made.plan)
    assert "passed through" in repr(made)
    assert made.cautions == []
    both = attrs.evolve(met, velocity=[(0.5, 0.0, 1.0), (0.5, 0.0, -1.0)])
    books = collide(both, separating="pass", **options).energy
    assert books.relative_imbalance[0] == 0.0
    assert books.start[1] > 0.0


@pytest.mark.parametrize("target", [FLOOR, Sphere(0.1, STEEL)], ids=["floor", "ball"])
@each_met
def test_surfaces_part_and_slip_as_the_result_says(met, target):
    """Contact velocities of both bodies, of their centres and spins, are those of the scene."""
    made = collide(attrs.evolve(met, target=target, spin=(1.0, 2.0, 3.0)))
    relative = made.contact_velocity - made.target_contact_velocity
    approach = relative @ np.array(DOWN)
    assert approach == pytest.approx(made.normal_velocity, abs=1e-12)
    slip = np.linalg.norm(relative - approach * np.array(DOWN))
    size = np.linalg.norm(made.result.rebound_slip_velocity)
    assert slip == pytest.approx(size, abs=1e-4 if made.known is None else 1e-12)


@pytest.mark.parametrize("met", [meeting(), OFF_CENTRE], ids=["central", "space"])
def test_a_misspelt_attribute_of_a_collision(met):
    with pytest.raises(AttributeError, match="did you mean 'velocity'"):
        _ = collide(met).velocty


def test_a_pickled_collision_has_the_same_vectors():
    made = collide(OFF_CENTRE, FEW)
    again = pickle.loads(pickle.dumps(made))
    assert again.to_dict() == made.to_dict()
    assert again.result == made.result
