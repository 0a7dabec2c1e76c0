"""The table of the size of elastic coupling against fresh solutions of the half-space."""

import numpy as np
import pytest

from contactlab import Scene
from contactlab.impact.coupling import coupling_shift, nodes
from tests.present import extra

pytest.importorskip("table_builders", reason="table_builders is not in the wheel")

from table_builders.coupling.build import CHI, COUPLING_NUMBER, POISSON_RATIO, PSI1, shift

#: A caution may understate the shift by this factor, where the shift is at least ``FROM``.
FACTOR, FROM = 4.0, 0.005
#: It may overstate the shift by this times Lambda.
ABOVE = 0.05


def size(psi1, chi, nu, numbers):
    """Return the interpolated size, shape (numbers, ...)."""
    scenes = [
        Scene.nondimensional(psi1=psi1, chi=chi, poisson_ratio=nu, coupling_number=number)
        for number in numbers
    ]
    return np.array([coupling_shift(scene) for scene in scenes])


def check(psi1, chi, nu, numbers):
    fresh, table = np.abs(shift(psi1, chi, nu, numbers)), size(psi1, chi, nu, numbers)
    large = fresh >= FROM
    assert large.any()
    assert (fresh[large] <= FACTOR * table[large]).all()
    # The shift changes its sign between nodes, where the mean of two sizes is too large.
    assert (table - fresh <= ABOVE * np.array(numbers)[:, None]).all()


def test_the_axes_are_those_of_the_builder():
    psi1, chi, nu, number = nodes().axes
    assert psi1.tolist() == [0.0, *PSI1]
    assert number.tolist() == [0.0, *COUPLING_NUMBER]
    assert (tuple(chi), tuple(nu)) == (CHI, POISSON_RATIO)
    assert np.isfinite(nodes().size).all()
    assert (nodes().size[1:, :, :, -1] > 0.0).all()


@extra("contactlab_halfspace")
@pytest.mark.slow
def test_at_a_node_the_table_is_the_solution():
    fresh = np.abs(shift(np.array([1.0, 3.0]), 1.44, 0.5, (0.5,)))
    table = size(np.array([1.0, 3.0]), 1.44, 0.5, (0.5,))
    assert table == pytest.approx(fresh, abs=2e-4)


@pytest.mark.slow
@extra("contactlab_halfspace")
def test_between_nodes():
    check(np.array([0.6, 4.5]), np.array([1.3, 1.5]), np.array([0.2, 0.4]), (0.7,))


@extra("contactlab_halfspace")
@pytest.mark.slow
def test_between_nodes_at_random():
    random = np.random.default_rng(3)
    psi1 = np.concatenate([random.uniform(0.2, 2.5, 10), random.uniform(0.0, 7.0, 10)])
    check(psi1, random.uniform(0.85, 2.2, 20), random.uniform(0.0, 0.5, 20), (0.35, 1.5, 3.0))
