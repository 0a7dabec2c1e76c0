"""One scene of each way, alone and in batches, with bodies and laws that the tests share."""

from __future__ import annotations

import numpy as np
import pytest

from contactlab import (
    Encounter,
    HalfSpace,
    Material,
    RigidBody,
    Scene,
    Simulation,
    Sphere,
    create,
    shapes,
)

STEEL = Material.named("steel")
FLOOR = HalfSpace(STEEL)
DOWN = (0.0, 0.0, -1.0)
EXACT = Simulation()
SPRINGS = Simulation(tangential="springs", integrator="symplectic")
FEW = Simulation(
    tangential=create("tangential.springs", springs=10),
    integrator=create("integrator.symplectic", steps=40),
)
TURNING = {"chi": [[0.6, 0.1], [0.1, 0.8]], "lam": (-0.2, 0.1), "rho": 0.1}
PSI1 = np.array([0.5, 1.5, 3.0])
#: One impact of spheres, one in which friction changes the approach, and one in which slip turns.
ONES = {
    "central": Scene.nondimensional(psi1=1.5, chi=1.4),
    "planar": Scene.nondimensional(psi1=1.5, chi=1.4, lam=0.2, eta=0.5),
    "space": Scene.nondimensional(psi1=(0.8, 1.6), **TURNING),
}
#: Three impacts alike, and one of each in one batch.
BATCHES = {
    "central": Scene.nondimensional(psi1=PSI1, chi=1.4),
    "planar": Scene.nondimensional(psi1=PSI1, chi=1.4, lam=0.2, eta=0.5),
    "space": Scene.nondimensional(psi1=np.stack((PSI1, 0.3 * PSI1), axis=-1), **TURNING),
    "mixed": Scene.stack(list(ONES.values())),
}
#: The table of ways: each alone, and all in one batch, two impacts of each. What holds for spheres
#: holds for bodies by the same row; batches of one kind are tested where they could differ.
WAYS = ONES | {"batch": Scene.stack([*ONES.values()] * 2)}
COUPLED = {name: scene for name, scene in WAYS.items() if name != "central"}
every_way = pytest.mark.parametrize("scene", WAYS.values(), ids=WAYS)
coupled_way = pytest.mark.parametrize("scene", COUPLED.values(), ids=COUPLED)
one_scene = pytest.mark.parametrize("scene", ONES.values(), ids=ONES)
each_batch = pytest.mark.parametrize("scene", BATCHES.values(), ids=BATCHES)


def body(inertia=(0.01, 0.014, 0.005), **changes):
    return RigidBody(
        mass=1.0, inertia=np.diag(inertia), material=STEEL, curvature_radius=0.01, **changes
    )


def meeting(one=None, *, velocity=(0.5, 0.0, -1.0), contact=(0.0, 0.0, -0.1), **changes):
    """Return a body that meets the floor; with its contact below its centre W does not couple."""
    numbers = {"friction_coefficient": 0.3, "normal": DOWN, "velocity": velocity} | changes
    return Encounter(body() if one is None else one, FLOOR, contact=contact, **numbers)


OFF_CENTRE = meeting(velocity=(0.5, 0.3, -1.0), contact=(0.02, 0.01, -0.1))
BALL = Sphere(0.01, STEEL)


def statuses(result):
    return [status.name for status in np.ravel(np.array(result.status, dtype=object))]


def many(name, count=2000):
    """Return a batch of equal impacts of one kind, or of three kinds by turns."""
    psi1, zero = np.full(count, 1.5), np.zeros(count)
    if name == "central":
        return Scene.nondimensional(psi1=psi1, chi=1.4)
    if name == "planar":
        return Scene.nondimensional(psi1=psi1, chi=1.4, lam=0.2, eta=0.5)
    vectors = np.stack((psi1, zero if name == "mixed" else psi1), axis=-1)
    if name == "space":
        return Scene.nondimensional(psi1=vectors, **TURNING)
    lam = np.zeros((count, 2))
    lam[1::3], lam[2::3] = (0.2, 0.0), (0.2, 0.1)
    return Scene.nondimensional(psi1=vectors, chi=0.7 * np.eye(2), lam=lam, rho=0.1)


def one(kind, **changes):
    numbers = {
        "central": {"psi1": 1.5, "chi": 1.4},
        "planar": {"psi1": 1.5, "chi": 1.4, "lam": 0.2, "eta": 0.5},
        "space": {"psi1": (0.8, 1.6), **TURNING},
    }[kind]
    return Scene.nondimensional(**(numbers | changes))


WITH_BODIES = Scene(BALL, FLOOR, 0.3, 1.0, 0.5)
BY_SPRINGS = {"tangential": "springs", "integrator": "symplectic"}
SPHERES = Encounter(BALL, FLOOR, 0.3, normal=DOWN, velocity=(0.5, 0.3, -1.0))


AXES = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
BODIES = {
    "inertia": body(),
    "principal": RigidBody(
        mass=1.0, principal=(0.01, 0.014, 0.005), material=STEEL, curvature_radius=0.01
    ),
    "axes": RigidBody(
        mass=1.0, principal=(0.01, 0.014, 0.005), axes=AXES, material=STEEL, curvature_radius=0.01
    ),
    "turned": RigidBody(
        mass=1.0, principal=(0.01, 0.014, 0.005), axes=np.eye(3)[[1, 0, 2]], material=STEEL,
        curvature_radius=0.01,
    ),
    "batch": RigidBody(
        mass=1.0, principal=np.array([(0.01, 0.014, 0.005), (0.02, 0.02, 0.02)]), axes=AXES,
        material=STEEL, curvature_radius=0.01,
    ),
    "rod": shapes.rod(length=1.0, radius=0.02, material=STEEL, normal=DOWN, axis=(0.5, 0, 0.8))[0],
    "box": shapes.box(
        sides=(0.1, 0.2, 0.3), corner_radius=0.01, material=STEEL, normal=DOWN, axes=AXES
    )[0],
    "ellipsoid": shapes.ellipsoid(semi_axes=(0.02, 0.03, 0.04), material=STEEL, normal=DOWN)[0],
}  # fmt: skip
