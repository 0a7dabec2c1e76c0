"""Numbers that nobody measures, at and beside the ends of what is plausible."""

import attrs
import numpy as np
import pytest

from contactlab import Scene
from contactlab.fitting import read_measurements
from contactlab.fitting.model import Model, scene_of
from contactlab.fitting.parameters import Setup, parameter_named
from contactlab.fitting.plausible import unlikely_numbers, unlikely_parameters
from contactlab.fitting.problem import Problem
from tests.fitting.impacts import BODIES

E_T = "tangential_restitution"


def sentences(columns, *, scene=BODIES):
    """Return the sentences on a table of steel balls; e_t is 0.7 by default."""
    count = max(np.size(values) for values in columns.values())
    table = read_measurements({"slip_restitution": np.full(count, -0.5)} | columns)
    setup = Setup(scene_of(scene, table.given, count), None)
    names = ("friction_coefficient",) if setup.scene.sphere is not None else ()
    model = Model(setup=setup, parameters=tuple(parameter_named(name, setup) for name in names))
    return unlikely_numbers(Problem(model=model, measured=table.measured, errors={}), table)


def unit(name, value):
    return [f"{name} of about {value} is unlikely: look at its unit"]


@pytest.mark.parametrize(
    ("columns", "told"),
    [
        ({"speed (m/s)": [1e-3, 1e-3]}, []),
        ({"speed (m/s)": [0.99e-3, 0.99e-3]}, unit("speed", "0.00099")),
        ({"speed (m/s)": [300.0, 300.0]}, []),
        ({"speed (m/s)": [301.0, 301.0, 2.0]}, unit("speed", "301")),
        ({"speed (m/s)": [400.0, 2.0, 2.0]}, []),
        ({"normal_speed (m/s)": [1e-3]}, []),
        ({"normal_speed (m/s)": [0.9e-3]}, unit("normal_speed", "0.0009")),
        ({"normal_speed (m/s)": [300.0]}, []),
        ({"normal_speed (m/s)": [310.0]}, unit("normal_speed", "310")),
        ({"spin (rad/s)": [-1e5, 0.0]}, []),
        ({"spin (rad/s)": [-1.01e5, 0.0, 0.0]}, unit("spin", "1.01e+05")),
        ({"spin (rad/s)": [1e-7, 0.0]}, []),
        ({"spin (rad/s)": [0.0]}, []),
    ],
)
def test_the_median_magnitude_of_what_moves_decides(columns, told):
    assert sentences(columns) == told


def radians(least, most):
    return [f"angle_deg lies between {least} and {most} degrees: it may be in radians"]


@pytest.mark.parametrize(
    ("angles", "told"),
    [
        ([0.1, 0.5, 1.57], radians("0.1", "1.57")),
        ([-1.57, 0.0, 0.2], radians("-1.57", "0.2")),
        ([0.1, 0.2, 0.31], radians("0.1", "0.31")),
        ([0.1, 0.2, 0.3], []),
        ([0.1, 0.5, 1.58], []),
        ([0.5, 1.5], []),
    ],
)
def test_small_angles_may_be_in_radians(angles, told):
    assert sentences({"angle_deg": angles, "speed (m/s)": [2.0] * len(angles)}) == told


@pytest.mark.parametrize(
    ("radius", "unlikely"), [(1.01e-6, 0), (1e-6, 1), (0.49, 0), (0.5, 1), (12.345, 1)]
)
def test_the_radius_of_a_ball(radius, unlikely):
    scene = attrs.evolve(BODIES, sphere=attrs.evolve(BODIES.sphere, radius=radius))
    words = f"the radius of the sphere, {radius:.3g} m, is unlikely: look at its unit"
    assert sentences({"angle_deg": [5.0]}, scene=scene) == [words] * unlikely


def test_a_scene_without_bodies_has_no_radius():
    psi1 = np.linspace(1.0, 3.0, 3)
    scene = Scene.nondimensional(psi1=psi1, chi=1.4)
    table = read_measurements({"psi2": psi1})
    model = Model(setup=Setup(scene, None), parameters=())
    assert unlikely_numbers(Problem(model=model, measured=table.measured, errors={}), table) == []


def beyond(name, count, least, most):
    return [
        f"{name}: {count} numbers lie beyond {least} and {most}, which no rebound does: look at "
        "its unit, its sign and whether columns have moved"
    ]


@pytest.mark.parametrize(
    ("name", "values", "told"),
    [
        ("normal_restitution", [-0.1, 1.1], []),
        ("normal_restitution", [-0.11, 0.5], beyond("normal_restitution", 1, "-0.1", "1.1")),
        ("normal_restitution", [0.5, 1.11], beyond("normal_restitution", 1, "-0.1", "1.1")),
        ("slip_restitution", [-1.1, 1.1], []),
        ("slip_restitution", [-1.11, 0.0], beyond("slip_restitution", 1, "-1.1", "1.1")),
        ("slip_restitution", [1.11, 2.0], beyond("slip_restitution", 2, "-1.1", "1.1")),
        (E_T, [-0.1, 1.1], []),
        (E_T, [1.11, 0.5], beyond(E_T, 1, "-0.1", "1.1")),
        (E_T, [-0.11, 0.5], beyond(E_T, 1, "-0.1", "1.1")),
        (E_T, [9.0, 0.5, 0.5], []),  # no more than a third
        (E_T, [9.0, 0.5, np.nan], beyond(E_T, 1, "-0.1", "1.1")),  # of those measured
        ("rebound_speed (m/s)", [-5.0, 900.0], []),
    ],
)
def test_what_no_rebound_does(name, values, told):
    assert sentences({"slip_restitution": [0.5] * len(values)} | {name: values}) == told


def test_a_spin_before_may_give_any_tangential_velocity():
    spun = {"spin (rad/s)": [0.0, 100.0], E_T: [-3.0, 4.0]}
    assert sentences(spun) == []
    assert sentences(spun | {"normal_restitution": [2.0, 2.0]}) == (
        beyond("normal_restitution", 2, "-0.1", "1.1")
    )


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
    low, high = interval
    told = (
        f"{name} from {low:.3g} to {high:.3g} is unlikely, as if a pair of materials that {words}: "
        f"look at the units of psi2, {E_T}, speed, the radius"
    )
    assert unlikely_parameters(problem, {name: interval}) == ([told] if words else [])
