"""Panels: interpolation, derivatives, and the first fall of a polynomial below zero."""

import math

import numpy as np
import pytest

from contactlab.numeric.lobatto import basis, first_fall, lobatto, row, rows

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


def test_a_dip_between_the_points_looked_at_is_found():
    middle, depth = 0.5 * (NODES.fine[20] + NODES.fine[21]), 1e-7
    tau, which = falls(lambda t: (t - middle) ** 2 - depth)
    assert (tau, which) == (pytest.approx(middle - math.sqrt(depth), abs=1e-12), 0)
    assert falls(lambda t: (t - middle) ** 2 + depth)[1] == -1


def test_a_margin_that_starts_at_nothing_may_dip_before_the_first_inner_node():
    """By the error of its polynomial; beyond that node it crosses where it falls below zero."""
    first = TAU[1]
    assert falls(lambda t: t * (t - 0.5 * first), fresh=True)[1] == -1
    assert falls(lambda t: t * (t - 0.5 * first))[0] < first
    assert falls(lambda t: t * (0.4 - t), fresh=True)[0] == pytest.approx(0.4, abs=1e-12)
    assert falls(lambda t: -t, fresh=True)[0] == pytest.approx(0.0, abs=1e-12)
