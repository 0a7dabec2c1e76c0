"""A loss that depends on the speed is found from measured restitutions."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, create
from contactlab_fit import fit
from tests.laws.test_restitution_of_speed import SCENE


@pytest.mark.slow
def test_the_loss_is_found_from_measured_restitutions():
    speeds = np.array([0.2, 0.5, 1.0, 2.0, 3.0, 4.0])
    angles = np.array([10.0, 20.0, 30.0, 40.0, 50.0, 60.0])
    normal = speeds * np.cos(np.radians(angles))
    e = 1.0 - 0.05 * normal**0.2
    scene = Scene.at_angle(SCENE.sphere, SCENE.target, 0.1, speed=speeds, angle_deg=angles)
    psi2 = contactlab.rebound(scene.psi1, scene.chi, restitution=e)
    slip = psi2 / scene.psi_scale
    data = {"speed (m/s)": speeds, "angle_deg": angles, "normal_restitution": e,
            "rebound_slip_velocity (m/s)": slip}  # fmt: skip
    laws = Simulation(normal=create("normal.viscoelastic", speed_loss=0.02))
    names = ["friction_coefficient", "speed_loss"]
    found = fit(data, SCENE.take(0), parameters=names, simulation=laws)
    assert found["normal.speed_loss"] == pytest.approx(0.05, rel=1e-3)
    assert found["friction_coefficient"] == pytest.approx(0.1, rel=5e-3)
