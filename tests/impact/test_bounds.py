"""Both sides of every bound of the scenes: what a float holds, units that look wrong, adhesion."""

import math

import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Sphere
from contactlab.impact.bodies import Pair
from contactlab.impact.cautions import tabor_caution
from contactlab.impact.hertz import rigid_body_rebound, slips_throughout

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
LOST = "normal_speed = {}: the kinetic energy of the impact must be at least 1e-290 J and finite, "


def below(value):
    return math.nextafter(value, 0.0)


def bare(friction, slip, *, mass=1.0, speed=1.0):
    """Return a scene without bodies, kappa = 1: unit of slip ``friction * speed`` m/s."""
    pair = Pair(
        radius=1.0, effective_modulus=1.0, effective_shear_modulus=1.0,
        normal_mass=mass, tangential_mass=1.0,
    )  # fmt: skip
    return Scene(None, None, friction, speed, slip, pair=pair)


def test_the_least_energy_of_an_impact():
    """½ m v² is exact with v a power of two."""
    speed = 2.0**-480
    mass = 1e-290 * 2.0**961
    assert 0.5 * mass * speed * speed == 1e-290
    assert bare(0.0, 0.0, mass=mass, speed=speed).normal_speed == speed
    with pytest.raises(ValueError, match=" ") as caught:
        bare(0.0, 0.0, mass=below(mass), speed=speed)
    assert str(caught.value) == LOST.format(speed) + (
        "or digits are lost; give larger speeds or masses"
    )


def test_the_energy_of_slip_is_finite():
    words = (
        ": the kinetic energy of slip must be finite; give less; from 4 chi - 1 on psi1 falls by "
        "4 chi"
    )
    assert bare(1.0, 1e154).slip_velocity == 1e154
    for slip in (1.4e154, -1.4e154):  # the largest float is 1.34e154 squared
        with pytest.raises(ValueError, match=r"^psi1, chi = \(.*, 0\.5\)") as caught:
            bare(1.0, slip)
        assert str(caught.value).endswith(words)
    with pytest.raises(ValueError, match=r"^tangential_velocity = 1e\+160: ") as caught:
        Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.1, 1.0, 1e160)
    assert str(caught.value).endswith(words)


@pytest.mark.parametrize(
    ("velocity", "spin", "told"),
    [(0.0, 1e162, "1e+160"), (0.0, -1e162, "-1e+160"), (1.79e308, 1.7e308, "inf")],
)
def test_a_spin_is_told_as_a_part_of_the_slip_velocity(velocity, spin, told):
    with pytest.raises(ValueError, match="energy of slip must be finite") as caught:
        Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.1, 1.0, velocity, spin)
    assert str(caught.value).startswith(f"tangential_velocity + spin * radius = {told}: ")


def ball(radius=0.5, *, normal=3.0, tangential=4.0, spin=0.0, **material):
    """Return a ball at 5 m/s on steel."""
    numbers = {"shear_modulus": 80e9, "poisson_ratio": 0.25, "density": 7850.0}
    made = Material(**(numbers | material))
    return Scene(Sphere(radius, made), HalfSpace(STEEL), 0.1, normal, tangential, spin)


def soft(radius):
    """Return a scene of E* = 1 GPa: two bodies of E = 2 GPa and nu = 0, of unlike sizes."""
    made = Material(young_modulus=2e9, poisson_ratio=0.0, density=1000.0)
    return Scene(Sphere(radius, made), HalfSpace(made), 0.1, 1.0)


def test_tabors_parameter_by_hand():
    """(R Gamma²/E*²)^(1/3)/h: 1e-3 m, 0.1 J/m² and 1 GPa give (1e-23)^(1/3)/3e-10 = 71.8."""
    start = "model: Tabor's parameter is {}, but the theory holds "
    end = ". Use jkr."
    scene = soft(1e-3)

    def said(given, **bounds):
        return tabor_caution(given, 0.1, other="jkr", **bounds)

    assert said(scene, most=5.0) == (start.format("72") + "below 5" + end,)
    assert said(scene, least=100.0) == (start.format("72") + "above 100" + end,)
    assert said(scene, least=71.0, most=72.0) == ()
    assert said(scene) == ()
    assert tabor_caution(scene, 0.0, other="jkr", most=5.0) == ()
    assert said(Scene.nondimensional(psi1=1.0, chi=1.0), most=0.0) == ()
    # a thousand times the radius is ten times the parameter
    both = soft(np.array([1e-3, 1.0]))
    assert said(both, most=100.0) == (start.format("7.2e+02") + "below 100" + end,)
    assert said(both, least=100.0) == (start.format("72") + "above 100" + end,)
    value = float(np.cbrt(1e-3 * (0.1 / scene.pair.effective_modulus) ** 2) / 3e-10)
    assert said(scene, least=value, most=value) == ()
    assert said(scene, least=math.nextafter(value, 100.0)) != ()


@pytest.mark.parametrize(("chi", "least"), [(1.0, 3.0), (0.5, 1.0), (0.2, 1.0), (2.0, 7.0)])
def test_slip_throughout_begins_at_a_bound(chi, least):
    """|psi1| >= max(1, 4 chi - 1), eqs (44) and (46)."""
    for sign in (1.0, -1.0):
        assert slips_throughout(sign * least, chi)
        assert not slips_throughout(sign * below(least), chi)
    many = slips_throughout(np.array([least, below(least)]), np.array([chi, chi]))
    assert many.tolist() == [True, False]
    nan = slips_throughout(9.0, math.nan), slips_throughout(np.array([9.0]), math.nan)
    assert [bool(np.all(each)) for each in nan] == [False, False]


def test_rigid_bodies_lose_two_chi_for_each_half_of_the_impact():
    assert rigid_body_rebound(10.0, 1.5) == 4.0
    assert rigid_body_rebound(-10.0, 1.5, 0.5) == -5.5
    assert rigid_body_rebound(np.array([6.0, 6.5]), 1.5).tolist() == [0.0, 0.5]
