"""The numbers behind the paper's figures: parameters, axes and curves."""

import numpy as np
import pytest

from contactlab import Scene, Simulation, create, rebound
from contactlab.study.paper_figures import (
    FIGURE_2_PSI1,
    FIGURE_4_CHI,
    SOLID_CHI,
    chi_of_gyration,
    paper_data,
)

FORCE, NORMAL = "F/(mu P_max)", "P/P_max"


@pytest.fixture(scope="module")
def data():
    law = Simulation(
        tangential=create("tangential.linear_spring"),
        integrator=create("integrator.symplectic", steps=60),
    )
    return {number: figure(law) for number, figure in paper_data().items()}


def test_chi_is_that_of_equation_38():
    """Of Poisson's ratio 0.3, kappa = 2 (1 - nu)/(2 - nu) = 0.7/0.85; solid, K² = 2/5."""
    kappa = 2.0 * 0.7 / 1.7
    assert pytest.approx(0.5 * kappa * 3.5, rel=1e-15) == SOLID_CHI
    assert pytest.approx(1.4412, abs=5e-5) == SOLID_CHI
    for ratio in (1.0, 0.4**0.5, 0.25):
        assert chi_of_gyration(ratio) == pytest.approx(0.5 * kappa * (1.0 + 1.0 / ratio**2))


def test_the_figures_are_found_by_number(data):
    assert list(data) == [1, 2, 3, 4]
    for number, words in {
        1: ("t/duration", "force", "psi1"), 2: ("psi1", "psi2", ""),
        3: ("t/duration", "force", "gyration_ratio"), 4: ("chi", "psi2", ""),
    }.items():  # fmt: skip
        found = data[number]
        assert (found.number, found.x, found.y, found.parameter) == (number, *words)


@pytest.mark.parametrize(
    ("number", "parameters"),
    [(1, [0.4, 0.8, 1.2, 2.0, 3.0, 4.0]), (3, [1.0, 0.4**0.5, 0.4, 0.25])],
)
def test_forces_are_drawn_with_one_normal_force(data, number, parameters):
    normal, *tangential = data[number].curves
    assert normal.name == NORMAL
    assert np.isnan(normal.parameter)
    assert {curve.name for curve in tangential} == {FORCE}
    assert [curve.parameter for curve in tangential] == parameters
    assert normal.y.max() == pytest.approx(1.0, abs=1e-2)
    for curve in tangential:
        assert (curve.x[0], curve.x[-1]) == (0.0, pytest.approx(59.5 / 60.0))
        assert np.abs(curve.y).max() <= 1.0 + 1e-9


def test_forces_are_those_of_their_parameter(data):
    """The second curve, from a run of its own; mu = 1."""
    simulation = Simulation(
        tangential="linear_spring", integrator=create("integrator.symplectic", steps=60)
    )
    for number, make in (
        (1, lambda psi1: (psi1, SOLID_CHI)), (3, lambda ratio: (1.2, chi_of_gyration(ratio))),
    ):  # fmt: skip
        curve = data[number].curves[2]
        psi1, chi = make(curve.parameter)
        result = simulation.run(Scene.nondimensional(psi1=psi1, chi=chi), history=True)
        peak = result.motion.maximum_force
        np.testing.assert_allclose(curve.y[1:] * peak, result.history.tangential_force)


@pytest.mark.parametrize("number", [2, 4])
def test_reflexions_stand_beside_rigid_and_exact_ones(data, number):
    law, rigid, exact = data[number].curves
    assert [curve.name for curve in (law, rigid, exact)] == [
        "linear_spring", "rigid-body theory", "exact solution"
    ]  # fmt: skip
    assert np.isnan([curve.parameter for curve in (law, rigid, exact)]).all()
    psi1 = FIGURE_2_PSI1 if number == 2 else np.full(len(FIGURE_4_CHI), 1.2)
    chi = np.full(len(psi1), SOLID_CHI) if number == 2 else FIGURE_4_CHI
    for curve in (law, rigid, exact):
        np.testing.assert_array_equal(curve.x, FIGURE_2_PSI1 if number == 2 else FIGURE_4_CHI)
    np.testing.assert_allclose(rigid.y, np.maximum(psi1 - 4.0 * chi, 0.0), atol=1e-12)
    alone = [rebound(*pair) for pair in zip(psi1[::10], chi[::10], strict=True)]
    np.testing.assert_allclose(exact.y[::10], alone)
