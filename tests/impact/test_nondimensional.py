"""Scenes by dimensionless groups."""

import attrs
import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab.impact.coupling import coupling_number


@pytest.mark.parametrize("nu", [-0.2, 0.0, 0.3, 0.5])
@pytest.mark.parametrize("friction", [None, 0.092, 2.0])
def test_every_group_is_the_one_given(nu, friction):
    scene = Scene.nondimensional(
        psi1=1.2, chi=1.4412, poisson_ratio=nu, coupling_number=0.784, friction_coefficient=friction
    )
    assert scene.psi1 == pytest.approx(1.2, rel=1e-15)
    assert scene.chi == pytest.approx(1.4412, rel=1e-15)
    assert scene.pair.stiffness_ratio == pytest.approx(2.0 * (1.0 - nu) / (2.0 - nu), rel=1e-15)
    assert coupling_number(scene) == pytest.approx(0.784, rel=1e-15)
    assert scene.friction_coefficient == (1.0 if friction is None else friction)
    assert scene.unit_friction == (friction is None)


def test_axisymmetric_answers_do_not_depend_on_the_other_groups():
    psi1 = np.array([0.3, 1.2, 3.0])
    plain = Simulation().run(Scene.nondimensional(psi1=psi1, chi=1.4412))
    scene = Scene.nondimensional(
        psi1=psi1, chi=1.4412, poisson_ratio=0.3, coupling_number=0.2, friction_coefficient=0.1
    )
    assert Simulation().run(scene).psi2 == pytest.approx(plain.psi2, abs=1e-11)


def test_the_finite_element_case_has_its_coupling_number():
    # Theory §9: rigid plane, nu = mu = 0.3, Lambda = 0.784 by G -> infinity of the plane.
    ball = Sphere(0.01, Material(shear_modulus=1e9, poisson_ratio=0.3, density=1000.0))
    plane = HalfSpace(Material(shear_modulus=1e15, poisson_ratio=0.3))
    bodies = Scene(ball, plane, 0.3, 1.0, 0.3)
    numbers = Scene.nondimensional(
        psi1=bodies.psi1,
        chi=bodies.chi,
        poisson_ratio=0.3,
        coupling_number=coupling_number(bodies),
        friction_coefficient=0.3,
    )
    assert coupling_number(bodies) == pytest.approx(0.784, abs=5e-4)
    assert numbers.pair.dundurs_beta == pytest.approx(bodies.pair.dundurs_beta, rel=1e-5)


def test_two_groups_are_as_before():
    scene = Scene.nondimensional(psi1=1.2, chi=1.4412)
    assert attrs.astuple(scene.pair) == (1.0, 0.9375, 0.9375, 1.0, 0.5 / 1.4412, 0.0, 1.0, 1.0, 0.0)
    assert (scene.friction_coefficient, scene.tangential_velocity) == (1.0, 1.2)


@pytest.mark.parametrize(
    ("entries", "word"),
    [
        ({"poisson_ratio": 0.6}, "poisson_ratio"),
        ({"coupling_number": np.inf}, "coupling_number"),
        ({"friction_coefficient": 0.0}, "friction_coefficient"),
    ],
)
def test_a_bad_group_is_refused_by_name(entries, word):
    with pytest.raises(ValueError, match=word):
        Scene.nondimensional(psi1=1.0, chi=1.0, **entries)


def test_groups_may_vary_over_a_grid_and_in_a_batch():
    grid = Scene.grid(psi1=[0.5, 1.0], coupling_number=[0.0, 0.5, 1.0], chi=1.4412)
    assert grid.shape == (6,)
    assert coupling_number(grid) == pytest.approx([0.0, 0.5, 1.0] * 2)
    assert grid.take(4).unit_friction
    assert coupling_number(grid.take(4)) == pytest.approx(0.5)


def test_scenes_with_and_without_friction_do_not_stack():
    first = Scene.nondimensional(psi1=0.5, chi=1.0)
    second = Scene.nondimensional(psi1=0.5, chi=1.0, friction_coefficient=0.3)
    assert Scene.stack([first, first]).unit_friction
    with pytest.raises(ValueError, match="friction"):
        Scene.stack([first, second])
