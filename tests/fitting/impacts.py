"""Impacts made by the laws themselves, with and without scatter."""

import numpy as np

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere

STEEL = Material(young_modulus=207e9, poisson_ratio=0.3, density=7850.0)
ANGLES = np.array([3.0, 6.0, 10.0, 14.0, 18.0, 22.0, 26.0, 30.0, 36.0, 45.0, 55.0, 65.0])


def scene(friction, angles=ANGLES, *, speed=2.0, material=STEEL):
    radians = np.radians(angles)
    ball = Sphere(0.01, material)
    speeds = speed * np.cos(radians), speed * np.sin(radians)
    return Scene(ball, HalfSpace(material), friction, *speeds)


def restitution(friction, angles=ANGLES, *, laws=None, material=STEEL):
    """Tangential restitution by the exact solution, not by the table that fits use."""
    laws = Simulation() if laws is None else laws
    return laws.sweep(scene(friction, angles, material=material)).check().tangential_restitution


def table(values, angles=ANGLES, **more):
    return {"angle_deg": angles, "speed (m/s)": np.full(len(angles), 2.0),
            "tangential_restitution": values} | more  # fmt: skip


#: A scene for fits: what the tables above say stands in place of its velocities.
BODIES = Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.1, 1.0, 1.0)
