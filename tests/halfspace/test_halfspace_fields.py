"""Fields of the half-space: tractions along one direction, and instants by hand."""

import math

import numpy as np
import pytest

import contactlab
from contactlab import HalfSpace, Material, Scene, Simulation, Sphere
from contactlab_halfspace.instants import units

CHI = 49 / 34
STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)


def law(**options):
    return Simulation(tangential=contactlab.create("tangential.halfspace", **options))


def one(slip=0.2):
    """An impact in SI with friction 0.4."""
    return Scene(Sphere(0.01, STEEL), HalfSpace(STEEL), 0.4, 0.5, slip)


def test_fields_along_one_direction():
    """Hertz's pressure at greatest compression; tractions that add up to the force."""
    slip = 1.2 * 0.4 * 0.5 / one().pair.stiffness_ratio
    scene = one(slip=slip)
    history = law(rings=16, angles=1).run(scene, history="fields").check().history
    shown = history.fields
    assert shown["traction_x"].shape == (len(history.time), 1, 16)
    assert shown["angle"][0] == pytest.approx([0.5 * math.pi])
    assert (shown["traction_y"] == 0.0).all()
    assert (shown["slip_y"] == 0.0).all()
    middle = int(np.argmax(history.normal_force))
    unit = units(Simulation().normal_motion(scene))
    radius = shown["radius"][middle]
    hertz = 1.5 * unit.force[0] / (math.pi * unit.length[0] ** 2)
    assert shown["pressure"][middle, 0] == pytest.approx(
        hertz * np.sqrt(1.0 - (radius / unit.length[0]) ** 2), rel=0.01, abs=0.03 * hertz
    )
    # Between inner edges c (e² - r²)^½: the weights of Hertz's own pressure carry its force.
    weights = 2.0 * np.pi * np.gradient(radius) * radius
    for k in range(len(history.time) // 4, 3 * len(history.time) // 4, 7):
        found = shown["traction_x"][k, 0] @ weights / (shown["pressure"][k, 0] @ weights)
        known = history.tangential_force[k] / history.normal_force[k]
        assert found == pytest.approx(known, abs=0.02)
    limit = 0.4 * shown["pressure"] * (1.0 + 1e-6)
    assert (np.abs(shown["traction_x"]) <= limit + 1e-9 * hertz).all()
    assert shown["stuck"][middle].any()
    assert not shown["stuck"][middle].all()
    assert not shown["stuck"][shown["pressure"] == 0.0].any()


def test_gross_slip_has_the_limit_everywhere_and_moves_as_the_bodies_do():
    scene = Scene.nondimensional(psi1=9.0, chi=CHI, friction_coefficient=0.4)
    history = law(rings=8, angles=2, extrapolate=False).run(scene, history="fields").history
    shown = history.fields
    touching = shown["pressure"] > 0.0
    assert shown["traction_x"][touching] == pytest.approx(0.4 * shown["pressure"][touching])
    assert not shown["stuck"].any()
    assert (np.diff(shown["slip_x"][:, 0, 0]) > 0.0).all()
