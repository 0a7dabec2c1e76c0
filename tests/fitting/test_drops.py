"""Restitutions of a ball that is dropped: by its heights, and by the times of its taps."""

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Sphere, fit
from contactlab_fit import read_measurements

GLASS = Material(shear_modulus=28e9, poisson_ratio=0.23, density=2500.0)
BALL = Scene(
    sphere=Sphere(radius=8e-3, material=GLASS), target=HalfSpace(GLASS),
    friction_coefficient=0.1, normal_speed=1.0, tangential_velocity=0.0,
)  # fmt: skip
HEIGHTS = {
    "drop_height (cm)": [100, 80, 60, 40, 20],
    "bounce_height (cm)": [61, 50, 38, 25.5, 13.1],
}
TAPS = {"t_bounce (s)": [0.0, 0.563, 1.045, 1.46, 1.815, 2.12]}


@pytest.mark.parametrize(
    ("table", "expected"),
    [(HEIGHTS, [0.781, 0.791, 0.796, 0.798, 0.809]), (TAPS, [0.856, 0.861, 0.855, 0.859])],
)
def test_each_bounce_has_its_restitution_and_speed(table, expected):
    found = read_measurements(table)
    assert found.measured["normal_restitution"] == pytest.approx(expected, abs=5e-4)
    assert f"{expected[0]} at" in found.notes[0]
    assert any("gravity" in each for each in found.taken)
    one = fit(table, BALL, parameters=["restitution"])
    assert one.parameters["normal.restitution"].value == pytest.approx(np.mean(expected), abs=1e-3)


def test_a_ball_of_known_restitution_is_found_again():
    """By Newton's formulas: from 2 m with e = 0.7, which falls with g."""
    g, e = 9.80665, 0.7
    speed = np.sqrt(2.0 * g * 2.0) * e ** np.arange(4)
    heights = {
        "drop_height (m)": speed[:-1] ** 2 / (2 * g),
        "bounce_height (mm)": 1e3 * speed[1:] ** 2 / (2 * g),
    }
    taps = {"taps": np.cumsum([0.4, *(2.0 * speed[1:] / g)]) * 1e3}
    for table, columns in ((heights, None), (taps, {"taps": "t_bounce (ms)"})):
        found = read_measurements(table, columns=columns)
        assert found.measured["normal_restitution"] == pytest.approx(e, rel=1e-12)
        first = speed[1:3] if columns else speed[:3]
        assert found.given["normal_speed"] == pytest.approx(first, rel=1e-12)


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"drop_height": [1.0], "bounce_height (m)": [0.5]}, "has no unit; give it in m, mm"),
        ({"drop_height (s)": [1.0], "bounce_height (m)": [0.5]}, "s is no unit of it"),
        ({"bounce_height (m)": [0.5]}, "drop_height and bounce_height, or"),
        ({"drop_height (m)": [0.5], "bounce_height (m)": [0.6]}, "0.6 m after 0.5 m; exchange"),
        ({"drop_height (m)": [0.0], "bounce_height (m)": [0.6]}, "must be positive"),
        ({"t_bounce (s)": [0.0, 1.0]}, "has 2 taps; a restitution needs three"),
        ({"t_bounce (s)": [0.0, 1.0, 0.5]}, "must grow"),
        ({"t_bounce (s)": [0.0, 1.0, 2.5]}, "the time to tap 3 is longer than the one to tap 2"),
        (TAPS | {"drop_height (m)": [1.0] * 6}, "or the times t_bounce alone"),
    ],
)
def test_what_is_no_drop_is_refused(table, words):
    with pytest.raises(ValueError, match=words):
        read_measurements(table)
