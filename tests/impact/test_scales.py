"""Absurd scales: a ValueError that names the argument and a remedy, or a right answer."""

import math

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere

STEEL = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)
CHI = 49.0 / 34.0
ALL = {
    "fronts": {},
    "springs": {"springs": 12},
    "annulus": {"annuli": 12},
    "mindlin_cap": {},
    "mindlin_deresiewicz": {},
    "thornton_yin": {},
    "linear_spring": {},
    "stronge": {},
    "walton": {},
    "coulomb": {},
    "frictionless": {},
}


def scene(mu=0.2, speed=1.0, slip=0.3):
    return Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), mu, speed, slip)


def simulation(name):
    return Simulation(tangential=contactlab.create(f"tangential.{name}", **ALL[name]))


@pytest.mark.parametrize(
    ("numbers", "argument"),
    [
        ({"speed": 1e-264}, "normal_speed"),
        ({"speed": 1e-165}, "normal_speed"),
        ({"speed": 1e-165, "slip": 1e-165}, "normal_speed"),
        ({"speed": 1e160}, "normal_speed"),
        ({"slip": 1e160}, "tangential_velocity"),
        ({"mu": 1e-308, "speed": 1e-5, "slip": 1e10}, "friction_coefficient"),
        ({"mu": 1e-320, "speed": 1e-10}, "friction_coefficient"),
        ({"mu": 1e-150, "speed": 1e-140, "slip": 1e-290}, "friction_coefficient"),
        ({"mu": 1e-200, "speed": 1e-100, "slip": 1e-300}, "friction_coefficient"),
        ({"mu": 1e-150, "speed": 1e-134, "slip": 1e-284}, "friction_coefficient"),
        ({"mu": 1e-280, "speed": 1e-5, "slip": 1e-278}, "friction_coefficient"),
    ],
)
def test_refused_with_argument_and_remedy(numbers, argument):
    with pytest.raises(ValueError, match=rf"^{argument} = .*: .*; give "):
        scene(**numbers)
    sound = {"mu": 0.2, "speed": 1.0, "slip": 0.3}
    for beside in (sound, numbers):  # all of a batch, or one of it
        batch = {name: np.array([beside[name], value]) for name, value in numbers.items()}
        with pytest.raises(ValueError, match=rf"^{argument} = "):
            scene(**batch)


@pytest.mark.parametrize("psi1", [1e155, -1e200, 1e308])
def test_psi1_whose_energy_overflows(psi1):
    with pytest.raises(ValueError, match=r"psi1, chi = .*kinetic energy of slip.*; give "):
        Scene.nondimensional(psi1=psi1, chi=CHI)


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize(
    ("mu", "speed", "ratio"),
    [(1e-140, 1e-140, 0.3), (1e-150, 1.0, 0.3), (1.0, 1e-140, 0.3), (1e-12, 1e-12, 1e5)],
)
def test_or_right(name, mu, speed, ratio):
    """Psi2 depends on psi1 and chi alone: the same incidence, at scales that a float holds."""
    plain = scene(mu=0.2, speed=1.0, slip=ratio * 0.2)
    small = scene(mu=mu, speed=speed, slip=ratio * mu * speed)
    assert small.psi1 == pytest.approx(plain.psi1, rel=1e-12)
    found, expected = (simulation(name).run(each).check() for each in (small, plain))
    assert found.psi_change == pytest.approx(expected.psi_change, rel=1e-9, abs=1e-12)
    imbalance = found.energy.relative_imbalance
    assert math.isfinite(imbalance)


@pytest.mark.parametrize("shape", [(), (2,)])
@pytest.mark.parametrize("name", ["springs", "coulomb", "fronts"])
@pytest.mark.parametrize("psi1", [0.0, 1e-300, 1e-155, 1e-20, 1e150])
def test_relative_imbalance_never_raises(name, psi1, shape):
    given = np.full(shape, psi1) if shape else psi1
    with np.errstate(all="raise"):
        result = simulation(name).run(Scene.nondimensional(psi1=given, chi=CHI))
        books = np.asarray(result.energy.relative_imbalance)
    assert np.isfinite(books).all()
    assert (np.abs(books) < 0.1).all()
    small = scene(speed=1e-140, slip=0.0 if psi1 == 0.0 else 3e-141)
    with np.errstate(all="raise"):
        assert abs(simulation(name).run(small).check().energy.relative_imbalance) < 0.1


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("psi1", [1e-155, 1e-300, 0.0])
@pytest.mark.parametrize("batch", [False, True])
def test_users_who_ask_numpy_to_raise(name, psi1, batch):
    given = np.array([psi1, 1.2, -psi1]) if batch else psi1
    with np.errstate(all="raise"):
        simulation = Simulation(tangential=contactlab.create(f"tangential.{name}", **ALL[name]))
        result = simulation.run(Scene.nondimensional(psi1=given, chi=CHI)).check()
        numbers = [result.psi2, result.energy.relative_imbalance, str(result.plan), repr(result)]
    first = np.ravel(numbers[0])[0]
    assert abs(first) <= psi1
    if psi1 and name not in ("frictionless", "coulomb"):
        alike = simulation.run(Scene.nondimensional(psi1=1e-9, chi=CHI)).check().psi2 / 1e-9
        assert first / psi1 == pytest.approx(alike, rel=1e-6)
