"""The half-space at length: all of theory §9's values, 64 rings, and a second discretisation."""

import numpy as np
import pytest

import contactlab
from contactlab import Scene
from tests.halfspace.square_grid import SquareGrid, rebound
from tests.halfspace.test_halfspace import (
    CHI,
    FINITE_ELEMENTS,
    SHIFTS,
    finite_element_case,
    simulation,
)

pytestmark = pytest.mark.slow
#: Finite elements of the case of theory §9 between psi1 = .5 and 2: rms of the axisymmetric
#: theory, of one-way and of two-way coupling.
COLUMNS = {0.5: 0, 1.0: 1, 1.5: 2, 2.0: 3, 3.0: 4}


@pytest.mark.parametrize("lam", SHIFTS)
def test_one_way_coupling_over_lam(lam):
    """Theory §9's table, ±2e-3, and the error that the law declares."""
    psi1 = np.array(list(COLUMNS))
    scene = Scene.nondimensional(psi1=psi1, chi=CHI, poisson_ratio=0.3, coupling_number=lam)
    result = simulation(coupling="one_way").run(scene)
    shift = result.psi2 - contactlab.rebound(psi1, CHI)
    assert shift == pytest.approx(SHIFTS[lam], abs=4e-3)
    assert (np.abs(shift - SHIFTS[lam]) <= 2e-3 + result.plan.psi2_error).all()


@pytest.mark.parametrize("psi1", FINITE_ELEMENTS)
@pytest.mark.parametrize("coupling", ["one_way", "two_way"])
def test_finite_element_case(psi1, coupling):
    expected = FINITE_ELEMENTS[psi1][coupling == "two_way"]
    result = simulation(coupling=coupling).run(finite_element_case(psi1))
    assert result.psi2 == pytest.approx(expected, abs=4e-3)
    assert abs(result.psi2 - expected) < 1.5 * result.plan.psi2_error
    if coupling == "two_way":
        normal = 0.5 * result.scene.pair.normal_mass * result.scene.normal_speed**2
        assert abs(result.energy.imbalance) < 3e-4 * normal


@pytest.mark.parametrize("psi1", [0.98, 2.0])
@pytest.mark.parametrize("coupling", ["one_way", "two_way"])
def test_64_rings(psi1, coupling):
    expected = FINITE_ELEMENTS[psi1][coupling == "two_way"]
    law = simulation(coupling=coupling, rings=64, extrapolate=False)
    result = law.run(finite_element_case(psi1))
    assert result.psi2 == pytest.approx(expected, abs=1.5e-3)
    if coupling == "two_way":
        normal = 0.5 * result.scene.pair.normal_mass * result.scene.normal_speed**2
        assert abs(result.energy.imbalance) < 8e-5 * normal


@pytest.mark.parametrize(
    ("coupling", "cells", "steps", "bound"),
    [
        ("none", 32, 60, 6e-3),
        ("one_way", 32, 60, 3e-3),
        ("two_way", 32, 100, 3e-3),
    ],
)
def test_square_cells(coupling, cells, steps, bound):
    """Another discretisation, another solver, other steps."""
    lam, mu, kappa = 0.784, 0.3, 1.4 / 1.7
    drag = 0.0 if coupling == "none" else lam
    lift = lam * mu * mu / kappa if coupling == "two_way" else 0.0
    grid = SquareGrid(cells, 0.3, drag, lift)
    psi2, restitution, _ = rebound(grid, 0.98, CHI, steps=steps, two_way=coupling == "two_way")
    result = simulation(coupling=coupling).run(finite_element_case(0.98))
    assert result.psi2 == pytest.approx(psi2, abs=bound)
    assert result.normal_restitution == pytest.approx(restitution, abs=6e-4)


def test_square_cells_know_the_cosine_of_twice_the_angle():
    grid = SquareGrid(48, 0.3, 0.0, 0.0)
    inside = grid.square < 1.0
    traction = np.sqrt(np.maximum(1.0 - grid.square, 0.0))
    found = grid.sheared(traction, 0.0 * traction)[1][inside]
    expected = (0.3 / 1.7 * 0.25 * 2.0 * grid.x * grid.y)[inside]  # r² sin 2 theta = 2 x y
    assert found == pytest.approx(expected, abs=1e-3)


def test_the_angles_are_enough():
    """8, 12 and 16 agree; 4 are not enough for strong coupling."""
    scenes = Scene.nondimensional(
        psi1=np.array([0.5, 0.98, 2.0]), chi=CHI, poisson_ratio=0.3, coupling_number=2.0
    )
    runs = [
        simulation(coupling="one_way", angles=n, rings=16, extrapolate=False).run(scenes).psi2
        for n in (4, 8, 12, 16)
    ]
    assert np.ptp(runs[1:], axis=0).max() < 3e-4
    assert np.abs(runs[0] - runs[1]).max() < 5e-3


@pytest.mark.parametrize(
    ("normal", "options"),
    [("jkr", {"work_of_adhesion": 20.0}), ("thornton", {"yield_pressure": 1e9})],
)
def test_adhesive_and_plastic_laws_against_annuli(normal, options):
    steel = contactlab.Material.named("steel")
    ball = contactlab.Sphere(0.01, steel)
    scene = Scene.at_angle(
        ball, contactlab.HalfSpace(steel), 0.3, speed=1.0, angle_deg=np.array([10.0, 30.0, 50.0])
    )
    law = contactlab.create(f"normal.{normal}", **options)
    ours = simulation(law, angles=1).run(scene)
    annuli = [
        contactlab.Simulation(
            normal=law,
            tangential=contactlab.create("tangential.annulus", annuli=n),
            integrator=contactlab.create("integrator.symplectic", steps=16 * n),
        )
        .run(scene)
        .psi2
        for n in (50, 100)
    ]
    assert ours.psi2 == pytest.approx(2.0 * annuli[1] - annuli[0], abs=4e-3)


@pytest.mark.parametrize(
    ("low", "high", "count", "bound"),
    [(0.05, 3.0, 1000, 3e-3), (3.0, 10.0, 300, 0.01), (10.0, 100.0, 60, 0.04)],
)
def test_the_declared_error_holds_at_random_impacts(low, high, count, bound):
    draw = np.random.default_rng(11)
    chi = np.exp(draw.uniform(np.log(low), np.log(high), count))
    psi1 = draw.uniform(0.0, 1.0, count) ** 2 * np.minimum(4.0 * chi, 40.0)
    result = simulation(angles=1).run(Scene.nondimensional(psi1=psi1, chi=chi))
    error = np.abs(result.psi2 - contactlab.rebound(psi1, chi))
    assert (error <= result.plan.psi2_error).all()
    assert error.max() < bound
