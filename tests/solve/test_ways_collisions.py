"""Collisions: what holds for spheres holds for bodies, by the same row."""

from __future__ import annotations

import attrs
import numpy as np
import pytest

from contactlab import (
    Collision,
    Sphere,
    collide,
    load_path,
)
from contactlab.contracts.status import Status
from tests.solve.any_scene import (
    DOWN,
    EXACT,
    FEW,
    FLOOR,
    OFF_CENTRE,
    SPHERES,
    STEEL,
    each_batch,
    meeting,
    one_scene,
)

ELSEWHERE = meeting(
    velocity=(5.0, 0.0, -1.0), contact=(0.05, 0.0, -0.1), friction_coefficient=0.9
)  # fmt: skip


@pytest.mark.parametrize(
    "met", [SPHERES, meeting(), meeting(contact=(0.02, 0, -0.1)), OFF_CENTRE],
    ids=["sphere", "central", "planar", "space"],
)  # fmt: skip
def test_a_collision_of_a_foreign_result_is_refused(met):
    own = Collision.of(met, EXACT.run(met.scene))
    assert own.velocity == pytest.approx(collide(met).velocity, rel=1e-9)
    faster = attrs.evolve(met, velocity=1.5 * met.velocity)
    for other in (ELSEWHERE, faster):
        with pytest.raises(ValueError, match=r"must be the result of encounter.scene"):
            Collision.of(met, EXACT.run(other.scene))
    with pytest.raises(ValueError, match=r"must be the result of encounter.scene"):
        Collision.of(met, collide(met))


@pytest.mark.parametrize(
    "met", [SPHERES, meeting(), OFF_CENTRE], ids=["sphere", "central", "space"]
)
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
    assert made.normal_velocity == pytest.approx(away.meeting().approach)
    assert "pass through untouched" in str(made.plan)
    assert "passed through" in repr(made)
    assert made.cautions == []


@pytest.mark.parametrize("target", [FLOOR, Sphere(0.1, STEEL)], ids=["floor", "ball"])
@pytest.mark.parametrize(
    "met", [SPHERES, meeting(), meeting(contact=(0.02, 0, -0.1)), OFF_CENTRE],
    ids=["sphere", "central", "planar", "space"],
)  # fmt: skip
def test_surfaces_part_and_slip_as_the_result_says(met, target):
    """Contact velocities of both bodies, of their centres and spins, are those of the scene."""
    made = collide(attrs.evolve(met, target=target, spin=(1.0, 2.0, 3.0)))
    relative = made.contact_velocity - made.target_contact_velocity
    approach = relative @ np.array(DOWN)
    assert approach == pytest.approx(made.normal_velocity, abs=1e-12)
    slip = np.linalg.norm(relative - approach * np.array(DOWN))
    size = np.linalg.norm(made.result.rebound_slip_velocity)
    assert slip == pytest.approx(size, abs=1e-4 if made.known is None else 1e-12)


@each_batch
def test_a_kept_sweep_is_taken_up(scene, tmp_path):
    """And another scene is refused."""
    result = FEW.sweep(scene, keep=tmp_path)
    assert FEW.sweep(scene, keep=tmp_path) == result == FEW.sweep(scene)
    slower = attrs.evolve(scene, normal_speed=0.5 * scene.normal_speed)
    with pytest.raises(ValueError, match="holds another sweep"):
        FEW.sweep(slower, keep=tmp_path)


@one_scene
def test_a_load_path_takes_any_scene(scene):
    """The law alone along a path asks for mu and stiffness, not for the masses."""
    depth = np.linspace(0.0, 1.0, 40)
    central = attrs.evolve(scene.central, pair=scene.pair)
    forces, expected = (load_path(each, depth, 0.3 * depth) for each in (scene, central))
    assert forces.check().friction_force == pytest.approx(expected.friction_force, rel=1e-9)
    assert forces.normal_force[-1] > 0.0
