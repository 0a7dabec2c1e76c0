"""The builder of the elastic table, part by part: by hand and against closed forms."""

import itertools

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval
from numpy.polynomial.polynomial import polygrid2d

from contactlab_laws.tables import regions
from contactlab_laws.tables.elastic import NODES
from contactlab_laws.tables.patches import nodes
from contactlab_laws.tables.regions import (
    CUT_END,
    SLIP_BACK,
    SLIP_LATE,
    SLIP_LONG,
    SLIP_ON,
    SMALL_FAR,
    SMALL_NEAR,
    STUCK_BACK,
    STUCK_ON,
    Cuts,
)
from table_builders.elastic import fit, start
from table_builders.elastic.coordinates import impact, measure
from table_builders.elastic.fit import Cell

#: Cuts at chi = 1.5 + psi1/10 and chi = 2 + t^5.
CUTS = Cuts(np.array([1.5, 0.1]), np.array([2.0, 0, 0, 0, 0, 1.0]))


@pytest.mark.parametrize(
    ("region", "a", "b", "psi1", "chi"),
    [
        (SMALL_NEAR, 0.5, 0.5, 1.0 - 0.5**6, 0.25),
        (SMALL_FAR, 0.5, 0.25, 0.75, 0.4375),
        (STUCK_BACK, 0.5, 0.5, 0.5, 1.025),  # half between 1/2 and 1.55
        (STUCK_ON, 0.5, 0.5, 0.5, 1.7875),  # a quarter between 1.55 and 5/2
        (SLIP_BACK, 0.5, 0.5, 1.0 + 0.4**5 * 1.51024, 1.25512),  # the cut at 2.01024
        (SLIP_ON, 0.5, 0.5, 1.0 + 0.4**5 * 3.29536, 2.14768),  # a quarter up to 2.56
        (SLIP_LONG, 0.5, 0.5, 1.0 + 0.9**5 * 2.0, 1.5),
        (SLIP_LATE, 0.5, 0.25, 2.5, 1.0),
    ],
)
def test_the_impact_of_a_place(region, a, b, psi1, chi):
    found = impact(region, np.array([a]), np.array([b]), CUTS)
    assert np.concatenate(found) == pytest.approx([psi1, chi], abs=1e-12)
    expected = 1.0 - psi1 if region == SMALL_FAR else abs(2.0 * chi - 1.0)
    assert measure(region, *found) == pytest.approx([expected], abs=1e-12)
    if region not in (SLIP_BACK, SLIP_ON):  # those whose cut has a power less than those of slip
        single = regions.SingleCuts(lambda at: 1.5 + 0.1 * at, lambda t: 2.0 + t**5)
        found = regions.place(psi1, chi, single)
        assert found == pytest.approx((region, a, b, expected), abs=1e-12)


def test_a_cell_covers_splits_and_has_nodes():
    cell = Cell(SLIP_LATE, 1, 2, 1, 3)
    assert cell.area == 0.125
    assert cell.split(True, False) == [Cell(SLIP_LATE, 2, 2, 2, 3), Cell(SLIP_LATE, 2, 2, 3, 3)]
    assert cell.split(False, True) == [Cell(SLIP_LATE, 1, 3, 1, 6), Cell(SLIP_LATE, 1, 3, 1, 7)]
    assert cell.split(True, True) == [
        Cell(SLIP_LATE, 2, 3, i, j) for i, j in itertools.product((2, 3), (6, 7))
    ]
    psi1, chi = cell.nodes(CUTS)
    at = nodes(NODES)
    assert chi == pytest.approx(np.tile(0.5 + 2.0 * (3 + at) / 4, (NODES, 1)))
    assert (psi1 - 1.0) / (2.0 * chi - 1.0) == pytest.approx(
        np.tile(1.0 + (1 + at) / 2, (NODES, 1)).T
    )


@pytest.mark.parametrize(
    ("cell", "of_a", "of_b"),
    [
        (Cell(SMALL_NEAR, 3, 0, 0, 2), (1, 2, 3, 4), ()),
        (Cell(SMALL_FAR, 3, 0, 0, 0), (), ()),
        (Cell(STUCK_BACK, 1, 1, 0, 0), (), ()),
        (Cell(STUCK_ON, 1, 1, 0, 0), (), (1,)),
        (Cell(STUCK_ON, 1, 1, 0, 1), (), ()),
        (Cell(SLIP_BACK, 2, 2, 0, 0), (1, 2, 3, 4), ()),
        (Cell(SLIP_BACK, 2, 2, 1, 0), (), ()),
        (Cell(SLIP_ON, 2, 2, 0, 0), (1, 2, 3, 4), (1,)),
        (Cell(SLIP_LONG, 2, 2, 0, 0), (), ()),
        (Cell(SLIP_LATE, 2, 2, 0, 0), (), ()),
    ],
)
def test_powers_that_g_lacks(cell, of_a, of_b):
    assert fit.missing_powers(cell) == (of_a, of_b)


@pytest.mark.parametrize(
    ("cell", "steepness"),
    [
        (Cell(SMALL_NEAR, 1, 0, 1, 0), 40.0 / (5.0 * 0.5**4 * 0.5)),
        (Cell(SLIP_BACK, 2, 0, 1, 0), 40.0 / (5.0 * 0.2**4 * 0.2)),
        (Cell(SLIP_ON, 0, 0, 0, 0), 0.0),
        (Cell(SLIP_LONG, 1, 0, 1, 0), 40.0 / (5.0 * 0.9**4 * 0.1)),
        (Cell(SLIP_LONG, 0, 0, 0, 0), 40.0 / (5.0 * 0.8**4 * 0.2)),
        (Cell(SLIP_LATE, 3, 0, 1, 0), 0.0),
        (Cell(STUCK_ON, 3, 0, 1, 0), 0.0),
    ],
)
def test_an_error_of_g_in_the_slope(cell, steepness):
    assert fit._steepness(cell) == pytest.approx(steepness, rel=1e-12)


def fitted(cell, bounce, slope=None):
    """Return the fit of a cell whose psi2/psi1 + 1 is that function of x and y in [0, 1]."""
    psi1, chi = cell.nodes(CUTS)
    x, y = np.meshgrid(nodes(NODES), nodes(NODES), indexing="ij")
    scale = measure(cell.region, psi1, chi)
    return fit.fit(cell, psi1, chi, psi1 * (bounce(x, y, scale) - 1.0), slope)


def last(x, power):
    return chebval(2.0 * x - 1.0, [0.0] * power + [1.0])


@pytest.mark.parametrize(
    ("cell", "factor"),
    [
        (Cell(SLIP_LATE, 1, 1, 1, 0), 1.0),
        (Cell(SLIP_LONG, 3, 0, 0, 0), 1.0),  # less steep than the slope may be off
        (Cell(SLIP_BACK, 3, 0, 1, 0), 400.0),  # 40/(5e-5 2000)
    ],
)
def test_the_error_of_a_fit_is_the_sum_of_its_last_coefficients(cell, factor):
    found = fitted(
        cell, lambda x, y, _: 3.0 + x + 1e-3 * last(x, 10) - 2e-3 * last(x, 11) + 5e-3 * last(y, 10)
    )
    assert found.error_a == pytest.approx(3e-3 * factor, rel=1e-9)
    assert found.error_b == pytest.approx(5e-3, rel=1e-9)
    found = fitted(cell, lambda x, y, _: 3.0 + x + y + last(x, 9) + last(y, 9))
    assert max(found.error_a, found.error_b) < 1e-11


def test_a_power_that_g_should_lack_is_an_error():
    """At the nodes the rest of the powers comes near it, by no more than the error told."""
    found = fitted(Cell(SMALL_NEAR, 0, 0, 0, 0), lambda x, y, of: of * (1.0 + 0.5 * x * y), None)
    assert 1e-4 < found.error_a < 0.1
    assert found.error_b < 1e-11
    found = fitted(Cell(STUCK_ON, 0, 0, 0, 0), lambda x, y, of: of * (1.0 + 0.5 * x * y), None)
    assert 1e-4 < found.error_b < 0.1
    assert found.error_a < 1e-11


def test_the_terms_of_a_fit_are_those_of_g():
    """With x^5 given, and those of t^5 in a cell half as wide."""
    cell = Cell(SLIP_ON, 1, 0, 0, 0)
    slope = 2.0 + nodes(NODES) ** 2
    width = 0.5 * CUT_END
    found = fitted(
        cell, lambda x, y, of: of * (1.0 + y**3 + (2.0 + y * y) * (width * x) ** 5 + x**7), slope
    )
    expected = np.zeros((NODES, NODES))
    expected[0, 0] = expected[0, 3] = expected[7, 0] = 1.0
    expected[5, [0, 2]] = np.array([2.0, 1.0]) * width**5
    at = np.linspace(0.0, 1.0, 20)
    assert polygrid2d(at, at, found.terms) == pytest.approx(polygrid2d(at, at, expected), abs=1e-9)
    assert found.error_b < 1e-11
    cell = Cell(SMALL_NEAR, 2, 0, 0, 0)
    assert fit._local(cell, slope) == pytest.approx(slope * 0.25**5)
    assert fit._local(cell, None) is None


def test_the_slope_below_chi_of_one_half_is_known():
    """There g5 = -d psi2/d psi1 - 1 + epsilon g0 = -4 chi."""
    cell = Cell(SMALL_NEAR, 0, 1, 0, 1)
    found = start.slope(cell, CUTS, lambda *_: pytest.fail("solved"))
    assert found == pytest.approx(-2.0 * (1.0 - (1.0 + nodes(NODES)) / 2.0))


def test_the_slope_along_a_cut_that_climbs():
    """With psi2 = chi² + 3 (psi1 - 1) at psi1 = 1: at constant chi, and then along the cut."""
    for region, up in ((SLIP_BACK, False), (SLIP_ON, True)):
        found = start.slope(
            Cell(region, 0, 1, 0, 1), CUTS, lambda psi1, chi: chi**2 + 3.0 * (psi1 - 1.0)
        )
        b = (1.0 + nodes(NODES)) / 2.0
        chi = 2.0 + 0.56 * b * b if up else 0.5 + 1.5 * b
        by_cut = 1.0 - b * b if up else b
        g_by_chi = (2 * chi * (2 * chi - 1) - 2 * (chi**2 + 1)) / (2 * chi - 1) ** 2
        assert found == pytest.approx(3.0 - chi**2 + g_by_chi * by_cut, abs=1e-6)
