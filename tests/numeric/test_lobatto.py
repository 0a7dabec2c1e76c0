"""Panels: interpolation, derivatives, and the first fall of a polynomial below zero."""

import math

import numpy as np
import pytest
from numpy.polynomial import legendre

from contactlab.numeric.lobatto import basis, first_fall, lobatto, row, rows, value_at

NODES = lobatto(20)
TAU = NODES.points
LEVEL = -4e-15


def falls(*polynomials, fresh=False):
    return first_fall(NODES, np.array([f(TAU) for f in polynomials]), LEVEL, fresh=fresh)


def test_values_slopes_and_integrals_of_a_polynomial_are_exact():
    values, places = TAU**7 - 2.0 * TAU, np.array([0.0, 0.123, 0.5, 1.0])
    expected = places**7 - 2.0 * places
    assert rows(NODES, places) @ values == pytest.approx(expected, abs=1e-15)
    assert row(NODES, 0.123) @ values == pytest.approx(expected[1], abs=1e-15)
    weights = basis(NODES, places)
    assert values @ weights / weights.sum(axis=0) == pytest.approx(expected, abs=1e-15)
    assert NODES.derivative @ values == pytest.approx(7.0 * TAU**6 - 2.0, abs=1e-12)
    assert NODES.integral @ values == pytest.approx(TAU**8 / 8.0 - TAU**2, abs=1e-15)


def test_the_first_fall_of_several_is_found_to_rounding():
    tau, which = falls(lambda t: 0.8 - t, lambda t: math.pi / 8.0 - t, lambda t: 1.0 + t)
    assert (tau, which) == (pytest.approx(math.pi / 8.0, abs=1e-15), 1)
    assert falls(lambda t: 1.0 + t) == (math.inf, -1)


@pytest.mark.parametrize("depth", [1e-4, 1e-7, 1e-10])
@pytest.mark.parametrize("middle", [0.1, 0.2615, 0.5, 0.7384, 0.9])
def test_a_dip_between_the_points_looked_at_is_found(middle, depth):
    tau, which = falls(lambda t: (t - middle) ** 2 - depth)
    assert (tau, which) == (pytest.approx(middle - math.sqrt(depth), abs=1e-9), 0)
    assert falls(lambda t: (t - middle) ** 2 + depth)[1] == -1


def test_a_margin_that_starts_at_nothing_may_dip_before_the_first_inner_node():
    """By the error of its polynomial; beyond that node it crosses where it falls below zero."""
    first = TAU[1]
    assert falls(lambda t: t * (t - 0.5 * first), fresh=True)[1] == -1
    assert falls(lambda t: t * (t - 0.5 * first))[0] < first
    assert falls(lambda t: t * (0.4 - t), fresh=True)[0] == pytest.approx(0.4, abs=1e-12)
    assert falls(lambda t: -t, fresh=True)[0] == pytest.approx(0.0, abs=1e-12)


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
    assert nodes.fine == pytest.approx(
        np.sin(np.arange(3 * count + 1) * math.pi / (6 * count)) ** 2
    )
    assert nodes.fine[nodes.second] >= nodes.points[1] > nodes.fine[nodes.second - 1]
    assert np.array_equal(nodes.identity, np.eye(count))
    assert np.array_equal(nodes.ones, np.ones(count))
    powers = nodes.points[None, :] ** np.arange(count)[:, None]
    assert powers @ nodes.to_fine == pytest.approx(
        nodes.fine ** np.arange(count)[:, None], abs=1e-13
    )
    exponents = np.arange(1, count + 1)
    assert nodes.integral @ powers.T == pytest.approx(
        nodes.points[:, None] ** exponents / exponents, abs=1e-14
    )
    assert not nodes.integral[0].any()
    assert np.abs(nodes.weights).max() == 1.0
    assert abs(nodes.derivative.sum(axis=1)).max() < 1e-13
    for degree in range(count):
        values = legendre.legval(2.0 * nodes.points - 1.0, np.eye(count)[degree])
        expected = [degree == count - 2, degree == count - 1]
        assert nodes.tail @ values == pytest.approx(np.array(expected, dtype=float), abs=1e-13)


def test_values_on_nodes_and_between():
    values = TAU**5
    for place in (0.0, float(TAU[3]), 0.37, 1.0):
        assert value_at(NODES, place, values) == pytest.approx(place**5, abs=1e-15)
    assert rows(NODES, np.full((2, 3), 0.37)).shape == (2, 3, 20)


def test_the_first_of_two_falls_and_of_two_rows_counts():
    """Whichever row it is in, and whichever of its roots is smaller."""
    late, early = (lambda t: 0.9 - t), (lambda t: (t - 0.3) * (t - 0.6))
    for order, which in (((late, early), 1), ((early, late), 0)):
        found = falls(*order)
        assert found == (pytest.approx(0.3, abs=1e-14), which)
    assert falls(late, late)[1] == 0
    assert falls(lambda t: 1.0 - 2.0 * t**30)[0] == pytest.approx(0.5 ** (1.0 / 30.0), abs=1e-6)
    touching = falls(lambda t: (t - 0.5) ** 2)
    assert touching == (math.inf, -1)  # zero is not below the level
    assert falls(lambda t: 0.0 * t) == (math.inf, -1)
    at_the_end = falls(lambda t: 1.0 - 1e-6 - t)
    assert at_the_end == (pytest.approx(1.0 - 1e-6, abs=1e-14), 0)


def test_a_dip_at_the_edge_of_what_is_looked_at_is_none():
    """A value that only falls has its end as its least, where a fall is looked for directly."""
    assert falls(lambda t: 2.0 - t) == (math.inf, -1)
    assert falls(lambda t: 1.0 + t) == (math.inf, -1)
    assert falls(lambda t: 1.0 + 0.0 * t) == (math.inf, -1)
