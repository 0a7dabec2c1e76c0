"""An impact whose numbers are written out, for tests of the moving picture.

The sphere of radius 2 comes at (3, 4) m/s with a spin of -1 rad/s and leaves at (1, 2) m/s with
1 rad/s; the contact lasts 4 s. The greater speed is 5 m/s.
"""

from types import SimpleNamespace

import numpy as np

FIELDS = {
    # Two rings of radius 0.5 and 1.5; the boundary is at 1.
    "radius": np.tile([0.5, 1.5], (4, 1)),
    "stuck": np.array([[True, True], [True, False], [False, False], [False, False]]),
    "slipping": np.array([[0, 0], [0, 1], [-1, 1], [0, -1]]),
}
BLUE, GREY, RED, WHITE = (0, 114, 178), (196, 196, 196), (213, 94, 0), (255, 255, 255)


def impact(*, slip=(2.0, 1.0, 0.0, -2.0), fields=FIELDS, sphere=True, after=(1.0, -2.0), **motion):
    history = SimpleNamespace(
        time=np.array([0.0, 1.0, 2.0, 4.0]), slip_velocity=np.array(slip),
        approach=np.array([0.0, 0.5, 1.0, 0.0]), normal_force=np.array([0.0, 5.0, 10.0, 0.0]),
        tangential_force=np.array([0.0, 1.0, 2.0, -0.5]), fields=fields,
        contact_radius=np.array([0.9, 1.8, 2.0, 1.2]),
    )  # fmt: skip
    scene = SimpleNamespace(
        sphere=SimpleNamespace(radius=2.0) if sphere else None, tangential_velocity=3.0,
        pair=SimpleNamespace(axis_ratio=1.0),
        normal_speed=4.0, spin=-1.0, shape=(), friction_coefficient=0.2,
    )  # fmt: skip
    numbers = {"duration": 4.0, "maximum_force": 10.0, "maximum_radius": 2.0} | motion
    return SimpleNamespace(
        history=history, scene=scene, motion=SimpleNamespace(**numbers), rebound_spin=1.0,
        rebound_tangential_velocity=after[0], rebound_normal_velocity=after[1],
    )  # fmt: skip
