"""The advised measurement: effects count by their size, whichever their sign."""

import re

import numpy as np
import pytest

from contactlab.fitting import determined
from contactlab.fitting.model import Model, scene_of
from contactlab.fitting.parameters import LawOption, Setup, parameter_named
from contactlab.fitting.problem import Problem
from tests.fitting.impacts import ANGLES, BODIES, restitution

STEEP = np.array([0.1, 0.2, 0.3, 0.4, 0.5])


def model(*names, angles=ANGLES, simulation=None):
    velocities = {
        "normal_speed": 2.0 * np.cos(np.radians(angles)),
        "tangential_velocity": 2.0 * np.sin(np.radians(angles)),
    }
    setup = Setup(scene_of(BODIES, velocities, len(angles)), simulation)
    return Model(setup=setup, parameters=tuple(parameter_named(name, setup) for name in names))


def test_the_effect_on_a_quantity_that_falls_is_its_size():
    """Tangential restitution falls with friction where the sphere slides, and rises nowhere."""
    slides = model("friction_coefficient", angles=np.array([55.0, 60.0, 65.0]))
    values = np.array([0.1])
    effect = determined._effect(slides, values, 0, "tangential_restitution")
    points = np.array([[0.095], [0.105]])
    low, high = slides.predicted(points, ["tangential_restitution"])["tangential_restitution"]
    assert np.all(high < low)
    assert effect == pytest.approx((low - high) / 0.1)


def test_advice_does_not_depend_on_which_minimum_is_named_first():
    both = np.array([[0.02], [0.3]])
    fitted = model("friction_coefficient")
    words = [determined._telling_apart(fitted, points) for points in (both, both[::-1])]
    angles = [float(re.search(r"about ([\d.]+)", text)[1]) for text in words]
    assert angles[0] == angles[1]
    x = determined.ANGLES_DEG
    off = np.abs(restitution(0.02, x) - restitution(0.3, x))
    assert angles[0] == x[np.argmax(off)]


@pytest.mark.parametrize("direction", [-1.0, 1.0])
def test_a_quantity_that_only_falls_or_only_rises_is_not_idle(direction):
    """In gross slip friction lowers the speed, in whichever direction the sphere moves."""
    slides = model("friction_coefficient", angles=direction * np.array([55.0, 60.0, 65.0]))
    moved = "rebound_tangential_velocity"
    low, middle, high = slides.predicted(np.array([[0.09], [0.1], [0.11]]), [moved])[moved]
    assert np.all(direction * (high - low) < 0.0)
    numbers = {moved: middle, "normal_restitution": np.full(3, 0.9)}
    problem = Problem(model=slides, measured=numbers, errors={})
    assert determined.idle(problem, np.array([0.1])) == ["normal_restitution"]


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_both_of_two_parameters_with_one_effect_are_named(monkeypatch, sign):
    """They compensate by a change in the same direction, or in opposite ones."""
    both = model("friction_coefficient", "stiffness_ratio")
    slopes = np.array([[1.0, sign], [2.0, 2.0 * sign], [3.0, 3.0 * sign]])
    monkeypatch.setattr(Problem, "linearised", lambda *_: (np.zeros(3), slopes))
    problem = Problem(model=both, measured={"tangential_restitution": np.ones(3)}, errors={})
    with pytest.raises(ValueError, match="change of friction_coefficient and stiffness_ratio"):
        determined.check_determined(problem, np.array([0.1, 0.8]))


def test_the_size_of_a_negative_number_is_its_magnitude():
    unbounded = LawOption(
        name="normal.x", least=-np.inf, most=np.inf, starts=(0.0,), kind="normal", option="x"
    )
    assert determined._sizes((unbounded,), np.array([-2.5])) == pytest.approx([2.5])
    bounded = LawOption(
        name="normal.x", least=-1.0, most=1.0, starts=(0.0,), kind="normal", option="x"
    )
    assert determined._sizes((bounded,), np.array([-50.0])) == pytest.approx([2.0])


@pytest.mark.parametrize("value", [-2.0, 2.0])
def test_a_half_width_is_compared_with_the_magnitude_of_the_value(value, monkeypatch):
    """A half-width of 1.9 beside a value of -2 is precise enough; one of 2.1 is not."""
    monkeypatch.setattr(determined, "_advised", lambda *_: "advice")
    unbounded = LawOption(
        name="normal.x", least=-np.inf, most=np.inf, starts=(0.0,), kind="normal", option="x"
    )
    made = Model(setup=model("friction_coefficient").setup, parameters=(unbounded,))
    problem = Problem(model=made, measured={}, errors={})
    determined.check_precise(problem, np.array([value]), np.array([1.9]))
    with pytest.raises(ValueError, match=r"hardly depend on normal\.x"):
        determined.check_precise(problem, np.array([value]), np.array([2.1]))
