"""The inverse mass of bodies at their contact."""

import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Material, RigidBody


@pytest.mark.parametrize("size", [3, 4])
def test_a_contact_that_all_bodies_of_a_batch_share(size):
    """Of as many bodies as there are axes, an inverse inertia of them all is no vector."""
    moments = np.linspace(1.0, 2.0, size)[:, None, None] * np.diag([0.01, 0.014, 0.005])
    steel = Material.named("steel")
    body = RigidBody(mass=1.0, inertia=moments, material=steel, curvature_radius=0.01)
    spin = np.tile((0.0, 0.0, 3.0), (size, 1))
    motion = {"normal": (0.0, 0.0, -1.0), "velocity": (0.5, 0.0, -1.0), "spin": spin}
    contact = (0.02, 0.01, -0.1)
    many = Encounter(body, HalfSpace(steel), 0.3, contact=contact, **motion).scene.inverse_mass
    for place, moment in enumerate(moments):
        r = np.array(contact)
        K = np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])
        W = np.eye(3) - K @ np.linalg.inv(moment) @ K
        assert many[place][0, 0] == pytest.approx(W[2, 2], rel=1e-12)
        assert np.linalg.eigvalsh(many[place]) == pytest.approx(np.linalg.eigvalsh(W), rel=1e-12)
