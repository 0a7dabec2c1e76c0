"""Other readings of a measurement: the whole list, and the impacts and numbers of each."""

import math

import attrs
import numpy as np
import pytest

from contactlab.fitting import read_measurements
from contactlab.fitting.model import Model, scene_of
from contactlab.fitting.parameters import Setup, parameter_named
from contactlab.fitting.problem import Problem
from contactlab.fitting.readings import readings, turned
from tests.fitting.impacts import BODIES

TURN = 2.0 * math.pi
COUNT = 6


def problem_of(columns):
    """Return the problem of steel balls, and the columns before the impact."""
    table = read_measurements(columns)
    setup = Setup(scene_of(BODIES, table.given, len(table)), None)
    model = Model(setup=setup, parameters=(parameter_named("friction_coefficient", setup),))
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
SPEED = ["in mm/s", "in cm/s", "in km/h", "in m/s under a heading in mm/s",
         "in m/s under a heading in cm/s"]  # fmt: skip
SPINS = [
    "in rpm",
    "in rad/s under a heading in rpm",
    "in rev/s",
    "in deg/s",
    "of the opposite sign (--column HEADING=-spin turns it)",
]
SURFACE = "measured from the surface, not from the normal"


def turned_by(name):
    return f"of the opposite sign (--column HEADING=-{name} turns it)"


def ways(name, listed):
    return [f"{name} looks as if {way}" for way in listed]


def shifts(names, look="look"):
    return [f"{names} {look} as if written a row too {way}" for way in ("low", "high")]


def test_every_reading_of_a_restitution_over_angles():
    assert list(read(POLAR | E_T)) == [
        *ways("angle_deg", ["in radians", SURFACE]),
        *ways("speed", SPEED),
        *BALL,
        *ways("tangential_restitution", ["in percent", turned_by("tangential_restitution")]),
        "tangential_restitution looks as if its numbers were those of slip_restitution",
        *shifts("tangential_restitution", "looks"),
    ]


def test_every_reading_of_velocities_with_spin():
    columns = CARTESIAN | SPUN | {"rebound_tangential_velocity (m/s)": np.linspace(1.0, 2.0, COUNT),
                                  "contact_time (s)": np.full(COUNT, 1e-5)}  # fmt: skip
    assert list(read(columns)) == [
        *ways("the angle of incidence", [SURFACE]),  # of up to 56 degrees: not in radians
        "normal_speed and tangential_velocity look as if exchanged",
        *(f"{name} looks as if {way}" for way in SPEED
          for name in ("normal_speed", "tangential_velocity")),
        *ways("spin", SPINS),
        *BALL,
        *ways("rebound_tangential_velocity", [*SPEED, turned_by("rebound_tangential_velocity")]),
        "rebound_tangential_velocity looks as if its numbers were those of rebound_slip_velocity",
        *ways("contact_time", ["in ms", "in µs", "in s under a heading in ms",
                               "in ms under a heading in µs", "in s under a heading in µs",
                               turned_by("contact_time")]),
        *shifts("rebound_tangential_velocity and contact_time"),
    ]  # fmt: skip


def test_every_reading_of_angles_and_of_a_pair_of_them():
    out = {"rebound_angle (rad)": np.linspace(0.1, 1.0, COUNT),
           "local_rebound_angle (rad)": np.linspace(-0.5, 1.0, COUNT)}  # fmt: skip
    degrees = ["in radians", "in degrees under a heading in rad"]
    found = list(read(POLAR | out))
    assert found[10:] == [
        *(word for name in ("rebound_angle", "local_rebound_angle")
          for word in ways(name, [*degrees, turned_by(name), SURFACE])),
        "rebound_angle and local_rebound_angle look as if exchanged",
        *shifts("rebound_angle and local_rebound_angle"),
        *(f"angle_deg and rebound_angle and local_rebound_angle look as if {way}"
          for way in ("in radians", SURFACE)),
    ]  # fmt: skip


def test_fewer_than_six_numbers_show_no_shift():
    short = {name: values[:5] for name, values in (POLAR | E_T).items()}
    assert not [words for words in read(short) if "row" in words]
    gap = E_T | {"slip_restitution": np.array([0.1, np.nan, *[0.1] * 4])}
    assert not [words for words in read(POLAR | gap) if "row" in words]
    assert [words for words in read(POLAR | E_T) if "row" in words]


@pytest.mark.parametrize(
    ("words", "angle", "speed"),
    [
        ("angle_deg looks as if in radians", np.degrees(POLAR["angle_deg"]), POLAR["speed (m/s)"]),
        (f"angle_deg looks as if {SURFACE}", 90.0 - POLAR["angle_deg"], POLAR["speed (m/s)"]),
        ("speed looks as if in mm/s", POLAR["angle_deg"], 1e-3 * POLAR["speed (m/s)"]),
        ("speed looks as if in cm/s", POLAR["angle_deg"], 1e-2 * POLAR["speed (m/s)"]),
        ("speed looks as if in km/h", POLAR["angle_deg"], POLAR["speed (m/s)"] / 3.6),
        (
            "speed looks as if in m/s under a heading in mm/s",
            POLAR["angle_deg"],
            1e3 * POLAR["speed (m/s)"],
        ),
        (
            "speed looks as if in m/s under a heading in cm/s",
            POLAR["angle_deg"],
            1e2 * POLAR["speed (m/s)"],
        ),
    ],
)
def test_the_impacts_of_another_angle_or_speed(words, angle, speed):
    reading = read(POLAR | E_T)[words]
    scene = reading.problem.model.setup.scene
    assert scene.normal_speed == pytest.approx(speed * np.cos(np.radians(angle)))
    assert scene.tangential_velocity == pytest.approx(speed * np.sin(np.radians(angle)))
    assert reading.problem.measured["tangential_restitution"] is not None
    assert (dict(reading.factors), reading.rest) == ({}, None)


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
        ("rebound_spin (rad/s)", turned_by("rebound_spin"), -1.0, 0.0),
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


def test_quantities_under_other_names_keep_their_order_and_errors():
    errors = {"tangential_restitution_error": np.full(COUNT, 0.1)}
    twin = read(POLAR | E_T | errors)[
        "tangential_restitution looks as if its numbers were those of slip_restitution"
    ].problem
    assert list(twin.measured) == list(twin.errors) == ["slip_restitution"]
    np.testing.assert_array_equal(twin.measured["slip_restitution"], E_T["tangential_restitution"])
    two = E_T | errors | {"normal_restitution": np.full(COUNT, 0.8)}
    words = "tangential_restitution and normal_restitution look as if exchanged"
    swapped = read(POLAR | two)[words].problem
    assert list(swapped.measured) == ["normal_restitution", "tangential_restitution"]
    assert list(swapped.errors) == ["normal_restitution"]
    assert swapped.measured["tangential_restitution"].tolist() == [0.8] * COUNT


def test_impacts_are_turned_at_the_speed_that_was_measured():
    angle = np.array([0.3, 1.0])
    scene = attrs.evolve(BODIES, normal_speed=[3.0, 3.0], tangential_velocity=[4.0, -4.0])
    free = turned(scene, angle, ["speed"])
    assert free.normal_speed == pytest.approx(5.0 * np.cos(angle))
    assert free.tangential_velocity == pytest.approx(5.0 * np.sin(angle))
    bound = turned(scene, angle, ["normal_speed"])
    assert bound.normal_speed == pytest.approx([3.0, 3.0])
    assert bound.tangential_velocity == pytest.approx(3.0 * np.tan(angle))
