"""Nodes, integrals to them, and interpolation between them."""

import math

import numpy as np
import pytest

from contactlab.numeric.lobatto import lobatto, rows

NODES = lobatto(20)
TAU = NODES.points


def test_values_and_integrals_of_a_polynomial_are_exact():
    values, places = TAU**7 - 2.0 * TAU, np.array([0.0, 0.123, 0.5, 1.0])
    expected = places**7 - 2.0 * places
    assert rows(NODES, places) @ values == pytest.approx(expected, abs=1e-15)
    assert NODES.integral @ values == pytest.approx(TAU**8 / 8.0 - TAU**2, abs=1e-15)


@pytest.mark.parametrize(
    ("count", "inner"),
    [
        # Abramowitz & Stegun, table 25.6: the nodes of Lobatto's rule on [-1, 1]
        (3, [0.0]),
        (4, [-1.0 / math.sqrt(5.0), 1.0 / math.sqrt(5.0)]),
        (5, [-math.sqrt(3.0 / 7.0), 0.0, math.sqrt(3.0 / 7.0)]),
    ],
)
def test_nodes_and_matrices_of_a_few(count, inner):
    nodes = lobatto(count)
    assert nodes.points == pytest.approx([0.0, *(0.5 + 0.5 * np.array(inner)), 1.0], abs=1e-15)
    powers = nodes.points[None, :] ** np.arange(count)[:, None]
    exponents = np.arange(1, count + 1)
    assert nodes.integral @ powers.T == pytest.approx(
        nodes.points[:, None] ** exponents / exponents, abs=1e-14
    )
    assert not nodes.integral[0].any()
    assert np.abs(nodes.weights).max() == 1.0


def test_values_on_nodes_and_between():
    values = TAU**5
    for place in (0.0, float(TAU[3]), 0.37, 1.0):
        assert rows(NODES, np.array(place)) @ values == pytest.approx(place**5, abs=1e-15)
    assert rows(NODES, np.full((2, 3), 0.37)).shape == (2, 3, 20)
