"""Numbers that nobody measures, at and beside the ends of what is plausible."""

import attrs
import numpy as np
import pytest

from contactlab import Scene
from contactlab_fit import read_measurements
from contactlab_fit.model import Model, scene_of
from contactlab_fit.parameters import Setup, find_parameter
from contactlab_fit.plausible import unlikely_numbers, unlikely_parameters
from contactlab_fit.problem import Problem
from tests.fitting.impacts import BODIES

E_T = "tangential_restitution"


def sentences(columns, *, scene=BODIES):
    """Return the sentences on a table of steel balls; e_t is 0.7 by default."""
    count = max(np.size(values) for values in columns.values())
    table = read_measurements({"beta0": np.full(count, 0.5)} | columns)
    setup = Setup(scene_of(scene, table.given, count), None)
    names = ("friction_coefficient",) if setup.scene.sphere is not None else ()
    model = Model(setup=setup, parameters=tuple(find_parameter(name, setup) for name in names))
    return unlikely_numbers(Problem(model=model, measured=table.measured, errors={}), table)


@pytest.mark.parametrize(
    ("columns", "told"),
    [
        ({"speed (m/s)": [1e-3, 1e-3]}, ""),
        ({"speed (m/s)": [0.99e-3, 0.99e-3]}, "speed of about 0.00099 is unlikely"),
        ({"speed (m/s)": [301.0, 301.0, 2.0]}, "speed of about 301 in impacts 1 and 2 is"),
        ({"speed (m/s)": [400.0, 2.0, 2.0]}, "speed of about 400 in impact 1 is unlikely"),
        ({"speed (m/s)": [2.0, 1500.0, 1.0, 2500.0]}, "speed of about 1.5e+03 in impacts 2 and 4"),
        ({"normal_speed (m/s)": [0.9e-3]}, "normal_speed of about 0.0009 is unlikely"),
        ({"normal_speed (m/s)": [300.0]}, ""),
        ({"spin (rad/s)": [-1e5, 0.0]}, ""),
        ({"spin (rad/s)": [-1.01e5, 0.0, 0.0]}, "spin of about 1.01e+05 is unlikely"),
        ({"spin (rad/s)": [1e-7, 0.0]}, ""),
        ({"angle_deg": [0.1, 0.5, 1.57]}, "between 0.1 and 1.57 degrees: it may be in radians"),
        ({"angle_deg": [-1.57, 0.0, 0.2]}, "it may be in radians"),
        ({"angle_deg": [0.1, 0.2, 0.3]}, ""),
        ({"angle_deg": [0.1, 0.5, 1.58]}, ""),
        ({"angle_deg": [0.5, 1.5]}, ""),
    ],
)
def test_numbers_before_the_impact(columns, told):
    """A number that is told stands in a row; the greatest angle decides on radians."""
    found = sentences(columns)
    assert len(found) == bool(told)
    assert told in "".join(found)


@pytest.mark.parametrize(
    ("radius", "unlikely"), [(1.01e-6, 0), (1e-6, 1), (0.49, 0), (0.5, 1), (12.345, 1)]
)
def test_the_radius_of_a_ball(radius, unlikely):
    scene = attrs.evolve(BODIES, sphere=attrs.evolve(BODIES.sphere, radius=radius))
    words = f"the radius of the sphere, {radius:.3g} m, is unlikely: check the unit"
    assert sentences({"angle_deg": [5.0]}, scene=scene) == [words] * unlikely


def test_a_scene_without_bodies_has_no_radius():
    psi1 = np.linspace(1.0, 3.0, 3)
    scene = Scene.nondimensional(psi1=psi1, chi=1.4)
    table = read_measurements({"psi2": psi1})
    model = Model(setup=Setup(scene, None), parameters=())
    assert unlikely_numbers(Problem(model=model, measured=table.measured, errors={}), table) == []


@pytest.mark.parametrize(
    ("name", "values", "outside"),
    [
        ("normal_restitution", [-0.1, 1.1], 0),
        ("normal_restitution", [-0.11, 0.5], 1),
        ("normal_restitution", [0.5, 1.11], 1),
        ("beta0", [-1.1, 1.1], 0),
        ("beta0", [-1.11, 0.0], 1),
        ("beta0", [1.11, 2.0], 2),
        (E_T, [-0.1, 1.1], 0),
        (E_T, [1.11, 0.5], 1),
        (E_T, [9.0, 0.5, 0.5], 0),  # no more than a third
        (E_T, [9.0, 0.5, np.nan], 1),  # of those measured
        ("rebound_speed (m/s)", [-5.0, 900.0], 0),
    ],
)
def test_what_no_rebound_does(name, values, outside):
    found = sentences({"beta0": [0.5] * len(values)} | {name: values})
    assert len(found) == bool(outside)
    if outside:
        assert found[0].startswith(f"{name}: {outside} numbers lie outside ")


def test_a_spin_before_may_give_any_tangential_velocity():
    spun = {"spin (rad/s)": [0.0, 100.0], E_T: [-3.0, 4.0]}
    assert sentences(spun) == []
    (told,) = sentences(spun | {"normal_restitution": [2.0, 2.0]})
    assert told.startswith("normal_restitution: 2 numbers")


ICE = "slides on thin ice or sticks like soft rubber"


@pytest.mark.parametrize(
    ("name", "interval", "words"),
    [
        ("friction_coefficient", (0.001, 0.0099), ICE),
        ("friction_coefficient", (0.001, 0.01), ""),
        ("friction_coefficient", (2.0, 3.0), ""),
        ("friction_coefficient", (2.01, 3.0), ICE),
        ("stiffness_ratio", (0.6, 0.66), ""),
        ("stiffness_ratio", (0.6, 0.659), "has no Poisson's ratio from 0 to 0.5"),
        ("stiffness_ratio", (1.01, 1.2), ""),
        ("stiffness_ratio", (1.02, 1.2), "has no Poisson's ratio from 0 to 0.5"),
        ("normal.restitution", (0.01, 0.1), ""),
        ("normal.restitution", (0.01, 0.09), "hardly rebounds"),
        ("normal.restitution", (0.9, 1.0), ""),
        ("tangential.beta", (-9.0, -8.0), ""),
    ],
)
def test_a_parameter_whose_whole_interval_is_implausible(name, interval, words):
    problem = Problem(model=None, measured={"psi2": [1.0], E_T: [1.0]}, errors={})
    found = unlikely_parameters(problem, {name: interval})
    assert len(found) == bool(words)
    assert words in "".join(found)
