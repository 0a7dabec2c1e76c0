"""Stronge's contact by parts: zeros, phases that end, and whole sentences."""

import math

import pytest

from contactlab import Scene, Simulation, create
from contactlab_laws.stronge import first_zero, rebound


@pytest.mark.parametrize(
    ("function", "bend", "start", "stop", "zero"),
    [
        (math.cos, 1.0, 0.0, 3.0, 0.5 * math.pi),
        (math.cos, 1.0, 0.0, 1.5, None),
        (math.sin, 1.0, 1.0, 7.0, math.pi),
        (lambda x: math.cos(1e4 * x), 1e8, 0.0, 1.0, 0.5e-4 * math.pi),
        (lambda x: 1.0 - x, 0.0, 0.0, 3.0, 1.0),
        (lambda x: 1.0 - x, 0.0, 0.0, 1.0, None),  # it comes to zero there, not below
        (lambda x: x * x, 2.0, -1.0, 1.0, None),  # a touch is no fall
        (lambda x: -0.5 - x, 0.0, 0.0, 1.0, 0.0),  # below from the start
        (lambda _: -0.5e-14, 0.0, 0.0, 1e-6, None),  # rounding
        (lambda _: -2e-14, 0.0, 0.0, 1e-6, 0.0),
    ],
)
def test_the_first_fall_below_zero(function, bend, start, stop, zero):
    found = first_zero(function, bend, start, stop)
    assert (found is None) is (zero is None)
    if zero is not None:
        assert found == pytest.approx(zero, abs=1e-13)


@pytest.mark.parametrize("ratio", [None, 0.5])
def test_units_of_an_impact_in_si(ratio):
    """In SI as in scaled numbers: the change in mu v1/ratio, the work in M_t times its square."""
    from contactlab import HalfSpace, Material, Sphere

    steel = Material.named("steel")
    scene = Scene(Sphere(0.01, steel), HalfSpace(steel), 0.3, 0.7, -0.15)
    chosen = create("tangential.stronge", stiffness_ratio=ratio)
    result = Simulation(tangential=chosen).run(scene).check()
    stiff = scene.pair.stiffness_ratio if ratio is None else ratio
    unit = 0.3 * 0.7 / stiff
    omega = math.sqrt(stiff * scene.pair.normal_mass / scene.pair.tangential_mass)
    known = rebound(0.15 / unit, omega, 1.0)
    assert result.motion.slip_velocity_change == pytest.approx(-unit * known.change)
    assert result.motion.friction_work == pytest.approx(
        scene.pair.tangential_mass * unit**2 * known.work
    )
