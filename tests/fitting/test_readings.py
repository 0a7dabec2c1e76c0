"""Other readings of a measurement: the whole list, and the impacts and numbers of each."""

import math

import attrs
import numpy as np
import pytest

from contactlab_fit import read_measurements
from contactlab_fit.model import Model, scene_of
from contactlab_fit.parameters import Setup, find_parameter
from contactlab_fit.problem import Problem
from contactlab_fit.readings import readings, turn_scene
from tests.fitting.impacts import BODIES

TURN = 2.0 * math.pi
COUNT = 6


def problem_of(columns):
    """Return the problem of steel balls, and the columns before the impact."""
    table = read_measurements(columns)
    setup = Setup(scene_of(BODIES, table.given, len(table)), None)
    model = Model(setup=setup, parameters=(find_parameter("friction_coefficient", setup),))
    return Problem(model=model, measured=table.measured, errors=table.errors), list(table.given)


def read(columns):
    """Return the readings by their words."""
    problem, given = problem_of(columns)
    found = list(readings(problem, given))
    words = {reading.words: reading for reading in found}
    assert len(words) == len(found)
    return words


POLAR = {"angle_deg": np.linspace(0.1, 1.5, COUNT), "speed (m/s)": np.linspace(1.0, 2.0, COUNT)}
CARTESIAN = {"normal_speed (m/s)": np.full(COUNT, 2.0),
             "tangential_velocity (m/s)": np.linspace(0.5, 3.0, COUNT)}  # fmt: skip
SPUN = {"spin (rad/s)": np.linspace(-10.0, 40.0, COUNT)}
E_T = {"tangential_restitution": np.linspace(0.5, 0.9, COUNT)}
BALL = [f"the radius of the sphere looks as if {way}" for way in ("in mm", "in cm", "the diameter")]
SPINS = [
    "in rpm",
    "in rad/s under a heading in rpm",
    "in rev/s",
    "in deg/s",
    "of the opposite sign",
]
SURFACE = "measured from the surface, not from the normal"


def test_the_impacts_of_exchanged_velocities_other_spins_and_balls():
    found = read(CARTESIAN | SPUN | E_T)
    scenes = {words: reading.problem.model.setup.scene for words, reading in found.items()}
    swapped = scenes["normal_speed and tangential_velocity look as if exchanged"]
    np.testing.assert_array_equal(swapped.normal_speed, CARTESIAN["tangential_velocity (m/s)"])
    np.testing.assert_array_equal(swapped.tangential_velocity, CARTESIAN["normal_speed (m/s)"])
    slower = scenes["normal_speed looks as if in cm/s"]
    np.testing.assert_allclose(slower.normal_speed, 0.02)
    np.testing.assert_array_equal(
        slower.tangential_velocity, CARTESIAN["tangential_velocity (m/s)"]
    )
    factors = dict(zip(SPINS, (TURN / 60, 60 / TURN, TURN, TURN / 360, -1.0), strict=True))
    for way, factor in factors.items():
        spin = scenes[f"spin looks as if {way}"].spin
        assert spin == pytest.approx(factor * SPUN["spin (rad/s)"])
    for words, radius in zip(BALL, (1e-5, 1e-4, 5e-3), strict=True):
        assert scenes[words].sphere.radius == pytest.approx(radius)
    assert "normal_speed and tangential_velocity look as if exchanged" not in read(
        CARTESIAN | {"tangential_velocity (m/s)": np.linspace(0.0, 3.0, COUNT)} | E_T
    )


@pytest.mark.parametrize(
    ("heading", "way", "factor", "offset"),
    [
        ("tangential_restitution", "in percent", 1e-2, 0.0),
        ("rebound_angle_deg", "in radians", 360.0 / TURN, 0.0),
        ("rebound_angle_deg", "in degrees under a heading in rad", TURN / 360.0, 0.0),
        ("rebound_angle_deg", SURFACE, -1.0, 90.0),
        ("rebound_angle (rad)", SURFACE, -1.0, TURN / 4.0),
        ("rebound_angle (rad)", "in radians", 360.0 / TURN, 0.0),
        ("rebound_spin (rad/s)", "in rpm", TURN / 60.0, 0.0),
        ("rebound_spin (rad/s)", "in rad/s under a heading in rpm", 60.0 / TURN, 0.0),
        ("rebound_spin (rad/s)", "of the opposite sign", -1.0, 0.0),
        ("contact_time (s)", "in ms", 1e-3, 0.0),
        ("contact_time (s)", "in µs", 1e-6, 0.0),
        ("contact_time (s)", "in s under a heading in ms", 1e3, 0.0),
        ("contact_time (s)", "in ms under a heading in µs", 1e3, 0.0),
        ("contact_time (s)", "in s under a heading in µs", 1e6, 0.0),
    ],
)
def test_the_numbers_of_a_quantity_read_another_way(heading, way, factor, offset):
    values, name = np.linspace(0.2, 0.7, COUNT), heading.partition(" ")[0]
    reading = read(POLAR | {heading: values})[f"{name} looks as if {way}"]
    assert reading.problem.measured[name] == pytest.approx(offset + factor * values, rel=1e-14)
    expected = {} if way == SURFACE else {name: abs(factor)}
    assert dict(reading.factors) == pytest.approx(expected)


def test_quantities_exchanged_and_taken_for_each_other():
    one, other = E_T["tangential_restitution"], np.linspace(0.7, 0.6, COUNT)
    found = read(POLAR | E_T | {"normal_restitution": other})
    exchanged = found["tangential_restitution and normal_restitution look as if exchanged"]
    assert list(exchanged.problem.measured) == ["normal_restitution", "tangential_restitution"]
    np.testing.assert_array_equal([*exchanged.problem.measured.values()], [one, other])
    words = "{} looks as if its numbers were those of {}".format
    for names in (("tangential_restitution", "beta0"),
                  ("beta0", "tangential_restitution")):  # fmt: skip
        taken = read(POLAR | {names[0]: one})[words(*names)].problem.measured
        assert list(taken) == [names[1]]
        np.testing.assert_array_equal(taken[names[1]], one)


def test_both_angles_read_another_way():
    out = np.linspace(0.1, 1.0, COUNT)
    found = read(POLAR | {"rebound_angle_deg": out})
    for way, values, factor in (
        ("in radians", np.degrees(out), 360 / TURN),
        (SURFACE, 90 - out, 1),
    ):
        both = found[f"angle_deg and rebound_angle_deg look as if {way}"]
        alone = found[f"angle_deg looks as if {way}"]
        assert both.problem.model.setup.scene == alone.problem.model.setup.scene
        assert both.problem.measured["rebound_angle_deg"] == pytest.approx(values)
        assert dict(both.factors) == pytest.approx({"rebound_angle_deg": factor})


def test_impacts_are_turned_at_the_speed_that_was_measured():
    angle = np.array([0.3, 1.0])
    scene = attrs.evolve(BODIES, normal_speed=[3.0, 3.0], tangential_velocity=[4.0, -4.0])
    free = turn_scene(scene, angle, ["speed"])
    assert free.normal_speed == pytest.approx(5.0 * np.cos(angle))
    assert free.tangential_velocity == pytest.approx(5.0 * np.sin(angle))
    bound = turn_scene(scene, angle, ["normal_speed"])
    assert bound.normal_speed == pytest.approx([3.0, 3.0])
    assert bound.tangential_velocity == pytest.approx(3.0 * np.tan(angle))
