"""A change of units changes no digit, and a change of direction no bit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.registry.registry import REGISTRY
from tests.every_method import every_method

COARSE = {"annuli": 8, "springs": 8, "steps": 40, "tolerance": 1e-3}
#: The exact solution and the fixed steps; adaptive steps follow rounding, and are slow.
METHODS = [method for method in every_method() if method.integrator != "adaptive"]


def longer(method):
    """Return whether a method is left to the longer tests."""
    under_springs = method.tangential == "springs"
    return method.tangential in ("annulus", "mindlin_deresiewicz") or (
        method.integrator == "paper" and not under_springs
    )


SHORTER = [
    pytest.param(method, id=method.name, marks=[pytest.mark.slow] * longer(method))
    for method in METHODS
]


def simulation(method):
    options = {"tangential": {}, "integrator": {}}
    for kind, name in (("tangential", method.tangential), ("integrator", method.integrator)):
        word = REGISTRY.law_class(f"{kind}.{name}").resolution
        if word in COARSE:
            options[kind][word] = COARSE[word]
    return method.simulation(options)


def scene(sign=1.0, *, length=1.0, mass=1.0, time=1.0, friction=0.15, slip=0.5, poisson=0.3):
    """Return a ball on a block in units that are so many metres, kilogrammes and seconds."""
    stress = mass / (length * time**2)
    material = Material(
        shear_modulus=80e9 * stress, poisson_ratio=poisson, density=7850.0 * mass / length**3
    )
    speed = length / time
    return Scene(
        Sphere(0.01 * length, material), HalfSpace(material), friction, 1.3 * speed,
        sign * slip * speed, sign * 7.0 / time,
    )  # fmt: skip


powers = st.integers(-9, 9).map(lambda power: 10.0**power)
frictions, slips = st.floats(0.01, 2.0), st.floats(-3.0, 3.0)


@pytest.mark.parametrize("method", SHORTER)
@given(length=powers, mass=powers, time=powers, friction=frictions, slip=slips)
def test_units(method, length, mass, time, friction, slip):
    model = simulation(method)
    plain = model.run(scene(friction=friction, slip=slip)).check()
    other = model.run(
        scene(length=length, mass=mass, time=time, friction=friction, slip=slip)
    ).check()
    assert other.psi_change == pytest.approx(plain.psi_change, rel=1e-12, abs=1e-12)
    assert other.normal_restitution == pytest.approx(plain.normal_restitution, rel=1e-12)


@pytest.mark.parametrize("method", SHORTER)
@given(friction=frictions, slip=slips, poisson=st.floats(-1.0, 0.5))
def test_direction(method, friction, slip, poisson):
    """To the last bit."""
    model = simulation(method)
    one = model.run(scene(friction=friction, slip=slip, poisson=poisson)).motion
    two = model.run(scene(-1.0, friction=friction, slip=slip, poisson=poisson)).motion
    assert one.slip_velocity_change == -two.slip_velocity_change
    assert one.friction_work == two.friction_work
    assert one.normal_velocity == two.normal_velocity
    assert one.status is two.status


def test_single_precision_and_integers_are_widened():
    """The same number in another type gives the same answer."""
    for psi1, chi in ((np.float32(1.25), np.float32(1.5)), (2, 3), (np.int32(2), np.int8(3))):
        narrow = Simulation().run(Scene.nondimensional(psi1=psi1, chi=chi)).psi2
        wide = Simulation().run(Scene.nondimensional(psi1=float(psi1), chi=float(chi))).psi2
        assert narrow == wide


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
@pytest.mark.parametrize("speed", [1e-142, 1e-12, 1e4])
def test_speeds_whose_squares_are_tiny(method, speed):
    """psi2 depends on the ratio of speeds alone, at 1e-142 m/s too."""
    ball = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)
    plain, other = (
        simulation(method)
        .run(Scene(Sphere(0.01, ball), HalfSpace(ball), 0.2, normal, 0.3 * normal))
        .check()
        for normal in (1.0, speed)
    )
    assert other.psi_change == pytest.approx(plain.psi_change, rel=1e-9, abs=1e-12)
