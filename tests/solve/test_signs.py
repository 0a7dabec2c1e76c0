"""Slip, spin and axes reversed: quantities of a result keep their size, and signs are known."""

from __future__ import annotations

import re

import attrs
import numpy as np
import pytest

from contactlab import Encounter, RigidBody, Scene, Simulation, Sphere, collide
from contactlab.impact import kinetics
from contactlab.impact.normal_spin import shift_and_loss
from contactlab.outcome.columns import columns
from tests.solve.any_scene import BALL, DOWN, EXACT, FEW, FLOOR, STEEL, WAYS

RIGID = Simulation(tangential="coulomb")
#: Columns that change sign with the slip; of an impulse the components along the surface do.
ODD = {
    "psi1", "psi2", "w1", "w2", "lam", "eta", "tangential_velocity", "spin", "normal_spin",
    "slip_velocity", "rebound_tangential_velocity", "rebound_spin", "rebound_normal_spin",
    "target_rebound_tangential_velocity", "target_rebound_spin", "target_rebound_normal_spin",
    "rebound_slip_velocity", "incidence_angle", "rebound_angle", "local_rebound_angle",
    "impulse_2", "impulse_3",
}  # fmt: skip
#: Scenes of spheres with spin about the normal: psi1 below, at and beyond gross slip.
SPEEDS = np.array([0.1, 0.5, 4.0])
SPINNING = [Scene(BALL, FLOOR, 0.3, 1.0, speed, 7.0, normal_spin=100.0) for speed in SPEEDS]
SPINNING += [Scene(BALL, FLOOR, 0.3, 1.0, SPEEDS, 7.0, normal_spin=100.0 * SPEEDS)]
SCENES = [*WAYS.values(), *SPINNING]
IDS = [*WAYS, *(f"spinning {place}" for place in SPEEDS), "spinning batch"]


def reversed_along_the_surface(scene):
    """Return the scene with slip and both spins reversed, and with the coupling of that axis."""
    inverse = scene.inverse_mass
    return attrs.evolve(
        scene,
        tangential_velocity=-np.asarray(scene.tangential_velocity),
        spin=-np.asarray(scene.spin),
        normal_spin=-np.asarray(scene.normal_spin),
        inverse_mass=None if inverse is None else inverse * np.outer((1, -1, -1), (1, -1, -1)),
    )


def read(result):
    """Return the numbers of a result by name: its columns, and those of its motion."""
    values = {name: value for name, _, value in columns(result)}
    motion = {name: getattr(result.motion, name) for name in type(result.motion).numbers()}
    values |= {f"motion.{name}": value for name, value in motion.items()}
    return {name: value for name, value in values.items() if value is not None and name != "status"}


def is_odd(name, scene):
    """The angle of slip in space is counted from the slip before."""
    if name == "local_rebound_angle" and kinetics.slip_axes(scene):
        return False
    return name in ODD or re.sub(r"_\d$", "", name) in ODD or name == "motion.slip_velocity_change"


@pytest.mark.parametrize("laws", [EXACT, FEW, RIGID], ids=["default", "springs", "rigid"])
@pytest.mark.parametrize("scene", SCENES, ids=IDS)
def test_slip_and_spin_reversed(scene, laws):
    one, other = laws.run(scene).check(), laws.run(reversed_along_the_surface(scene)).check()
    there = read(other)
    for name, value in read(one).items():
        sign = -1.0 if is_odd(name, scene) else 1.0
        assert there[name] == pytest.approx(
            sign * np.asarray(value), rel=1e-12, abs=1e-13, nan_ok=True
        ), name
    assert other.cautions == one.cautions
    assert str(other.plan) == str(one.plan)


TILT = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
#: A body whose principal axes lie across the normal, and one that turns about the normal.
TILTED = RigidBody(
    mass=1.0, inertia=TILT @ np.diag((0.01, 0.014, 0.009)) @ TILT.T, material=STEEL,
    curvature_radius=0.01,
)  # fmt: skip
ROUND = attrs.evolve(TILTED, inertia=np.diag((0.01, 0.01, 0.005)))
HELD = {"friction_coefficient": 0.3, "normal": DOWN}
SPUN = {"velocity": (0.5, 0.2, -1.0), "spin": (3.0, -2.0, 60.0), "target_spin": (1.0, 5.0, -9.0)}
#: Each may turn about the normal; the planar one keeps to its plane.
MET = {
    "spheres": Encounter(BALL, Sphere(0.02, STEEL), **HELD, **SPUN),
    "central": Encounter(ROUND, Sphere(0.02, STEEL), contact=(0.0, 0.0, -0.1), **HELD, **SPUN),
    "planar": Encounter(
        ROUND, FLOOR, contact=(0.02, 0.0, -0.1), velocity=(0.5, 0.0, -1.0), **HELD
    ),
    "space": Encounter(TILTED, Sphere(0.02, STEEL), contact=(0.02, 0.01, -0.1), **HELD, **SPUN),
}  # fmt: skip
#: Mirrors of one axis each, and of all three.
MIRRORS = {"x": (-1, 1, 1), "y": (1, -1, 1), "z": (1, 1, -1), "all": (-1, -1, -1)}
POLAR = ("velocity", "target_velocity", "impulse", "contact_velocity", "target_contact_velocity")
AXIAL = ("spin", "target_spin")


def seen_in(mirror, met):
    """Return the encounter in a mirror: a velocity is a polar vector, a spin an axial one."""
    turn = np.prod(mirror) * mirror
    body, bodies = met.body, {}
    if isinstance(body, RigidBody):
        inertia = body.inertia * np.outer(mirror, mirror)
        bodies = {"body": attrs.evolve(body, inertia=inertia), "contact": met.contact * mirror}
    return attrs.evolve(
        met, normal=met.normal * mirror, velocity=met.velocity * mirror, spin=met.spin * turn,
        target_velocity=met.target_velocity * mirror, target_spin=met.target_spin * turn, **bodies,
    )  # fmt: skip


@pytest.mark.parametrize("laws", [None, FEW, RIGID], ids=["default", "springs", "rigid"])
@pytest.mark.parametrize("batch", [False, True], ids=["one", "batch"])
@pytest.mark.parametrize("name", MET)
@pytest.mark.parametrize("mirror", MIRRORS)
def test_a_collision_in_a_mirror(mirror, name, batch, laws):
    met, mirror = MET[name], np.array(MIRRORS[mirror])
    if batch:
        slower = np.array([1.0, 0.5, 2.0])[:, None]
        met = attrs.evolve(met, velocity=slower * met.velocity, spin=met.spin / slower)
    one, other = collide(met, laws), collide(seen_in(mirror, met), laws)
    for names, sign in ((POLAR, mirror), (AXIAL, np.prod(mirror) * mirror)):
        for each in names:
            value = sign * getattr(one, each)
            assert getattr(other, each) == pytest.approx(value, rel=1e-9, abs=1e-12, nan_ok=True), (
                each
            )
    there = read(other.result)
    for each, value in read(one.result).items():
        assert np.abs(there[each]) == pytest.approx(
            np.abs(value), rel=1e-9, abs=1e-12, nan_ok=True
        ), each
    assert other.cautions == one.cautions
    assert other.result.counters == one.result.counters


def test_the_shift_by_spin_has_the_sign_of_slip_and_the_loss_that_of_spin():
    one = shift_and_loss(SPEEDS, 1.4, 0.3, 0.01)
    for slip, spin in ((1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)):
        shift, loss = shift_and_loss(slip * SPEEDS, 1.4, spin * 0.3, 0.01)
        assert shift.tolist() == (slip * one[0]).tolist()
        assert loss.tolist() == (spin * one[1]).tolist()
