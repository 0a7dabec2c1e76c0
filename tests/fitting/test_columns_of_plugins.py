"""A column of a plug-in is a measured quantity, with what it needs of an impact."""

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, fit
from contactlab.outcome.columns import QUANTITIES
from contactlab.plugin import Column
from tests.present import column

STEEL = Material.named("steel")
BALL, PLATE = Sphere(0.01, Material.named("soda-lime glass")), HalfSpace(STEEL)
ANGLES = np.array([20.0, 40.0, 60.0, 75.0])
#: Errors of the measured numbers, as shares.
NOISE = 2e-3 * np.array([1.0, -1.0, 0.5, -0.3])
BODIES = Scene.at_angle(BALL, PLATE, 0.1, speed=2.0, angle_deg=30.0)


def heat(result):
    """Friction work over the volume of a hemisphere on the contact, J/m³."""
    return result.energy.friction_work / (2.0 / 3.0 * np.pi * result.motion.maximum_radius**3)


def measured(name, friction=0.17, noise=NOISE):
    """Return noisy numbers of a column at angles of impacts, by closed forms or another law."""
    scene = Scene.at_angle(BALL, PLATE, friction, speed=2.0, angle_deg=ANGLES)
    values = QUANTITIES[name].of(Simulation().run(scene)) * (1.0 + noise)
    return {"angle_deg": ANGLES, "speed (m/s)": np.full(4, 2.0), f"{name} (J/m3)": values}


@pytest.mark.parametrize("laws", [None, Simulation()], ids=["default", "named"])
def test_friction_is_found_from_what_reads_the_motion(laws):
    with column(Column("heat", "J/m3", value=heat, needs=("sizes", "motion"))):
        found = fit(measured("heat"), BODIES, simulation=laws)
    assert found["friction_coefficient"] == pytest.approx(0.17, abs=3e-4)
    told = "heat: read from the motion of an impact, so the fit follows"
    assert any(note.startswith(told) for note in found.notes) == (laws is None)


def test_a_column_that_says_nothing_of_the_motion_is_refused_with_what_to_write():
    with column(Column("heat", "J/m3", value=heat)):
        with pytest.raises(ValueError, match=r"has no number .*needs=\('motion',\)"):
            fit(measured("heat"), BODIES)
        named = fit(measured("heat"), BODIES, simulation=Simulation())
    assert named["friction_coefficient"] == pytest.approx(0.17, abs=3e-4)


def peak(result):
    """The largest friction force in a history, N."""
    return float(np.max(np.abs(result.history.tangential_force)))


def test_friction_is_found_from_what_reads_the_history():
    """Gross slip: the largest friction is mu times the largest normal force, which is Hertz's."""
    angles, friction = np.array([70.0, 75.0, 80.0]), 0.17
    force = (
        Simulation()
        .run(Scene.at_angle(BALL, PLATE, friction, speed=2.0, angle_deg=angles))
        .motion.maximum_force
    )
    data = {"angle_deg": angles, "speed (m/s)": np.full(3, 2.0),
            "peak (N)": friction * force * (1.0 + 1e-3 * np.array([1.0, -1.0, 0.2]))}  # fmt: skip
    with column(Column("peak", "N", value=peak, needs=("history",))):
        found = fit(data, BODIES)
    assert found["friction_coefficient"] == pytest.approx(friction, rel=3e-3)
    assert any("the history of an impact" in note for note in found.notes)


def radius(result):
    """The largest radius of the contact, m."""
    return result.motion.maximum_radius


def test_sizes_are_tabulated_beside_a_restitution():
    """A contact's size knows no friction; the spin does."""
    scene = Scene.at_angle(BALL, PLATE, 0.17, speed=2.0, angle_deg=ANGLES)
    run = Simulation().run(scene)
    data = {"angle_deg": ANGLES, "speed (m/s)": np.full(4, 2.0),
            "rebound_spin (rad/s)": run.rebound_spin * (1.0 + NOISE),
            "radius (m)": run.motion.maximum_radius * (1.0 + NOISE)}  # fmt: skip
    with column(Column("radius", "m", value=radius, needs=("sizes",))):
        found = fit(data, BODIES)
    assert found["friction_coefficient"] == pytest.approx(0.17, rel=1e-2)
    assert not any("followed" in note for note in found.notes)
