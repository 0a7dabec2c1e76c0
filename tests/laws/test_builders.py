"""The builders of tables: by hand, against closed forms, and the commands."""

import sys

import numpy as np
import pytest
from contactlab_laws.tables.damped import RINGS, SLIPS, STICKS, TURNS
from contactlab_laws.tables.damped import place as place_of
from contactlab_laws.tables.damped import rough as rough_of
from numpy.polynomial.chebyshev import chebval2d

from contactlab.impact.coupling import FILE
from contactlab_laws.tables import regions
from contactlab_laws.tables.elastic import NODES
from contactlab_laws.tables.patches import nodes
from contactlab_laws.tables.regions import (
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

pytest.importorskip("table_builders", reason="table_builders is not in the wheel")

from table_builders.damped import build
from table_builders.damped.build import coefficients, incidence, restitution, smooth
from table_builders.damped.build import nodes as damped_nodes

from table_builders import __main__ as command
from table_builders.coupling import build as unlike
from table_builders.elastic import exact
from table_builders.elastic.coordinates import impact, measure
from table_builders.elastic.fit import Cell, slope_at_one

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


def test_the_slope_along_a_cut_that_climbs():
    """With psi2 = chi² + 3 (psi1 - 1) at psi1 = 1: at constant chi, and then along the cut."""
    for region, up in ((SLIP_BACK, False), (SLIP_ON, True)):
        found = slope_at_one(
            Cell(region, 0, 1, 0, 1), CUTS, lambda psi1, chi: chi**2 + 3.0 * (psi1 - 1.0)
        )
        b = (1.0 + nodes(NODES)) / 2.0
        chi = 2.0 + 0.56 * b * b if up else 0.5 + 1.5 * b
        by_cut = 1.0 - b * b if up else b
        g_by_chi = (2 * chi * (2 * chi - 1) - 2 * (chi**2 + 1)) / (2 * chi - 1) ** 2
        assert found == pytest.approx(3.0 - chi**2 + g_by_chi * by_cut, abs=1e-6)


PIECES = (1.2, 2.2, 5.2)


@pytest.mark.parametrize(
    ("piece", "at", "psi1"),
    [
        (STICKS, -1.0, 0.0),
        (STICKS, 0.5, 0.9),
        (STICKS, 1.0, 1.2),
        (RINGS, -1.0, 1.2),
        (RINGS, 0.0, 1.45),  # a quarter of the way at half of its root
        (RINGS, 1.0, 2.2),
        (TURNS, 0.2, 3.28),  # 2.2 + 3 * 0.6²
        (SLIPS, 1.0, 5.2),
        (SLIPS, 0.0, 9.4),  # 1 + 4.2/0.5
    ],
)
def test_psi1_of_a_coordinate_and_back(piece, at, psi1):
    assert incidence(piece, at, PIECES) == pytest.approx(psi1, abs=1e-14)
    assert place_of(piece, psi1, PIECES) == pytest.approx(at, abs=1e-7)


@pytest.mark.parametrize(
    ("piece", "value"), [(STICKS, 0.25), (RINGS, 0.5), (TURNS, 0.5), (SLIPS, 3.9)]
)
def test_the_tabulated_quantity_and_back(piece, value):
    """Gross slip at chi = 1.5, e = 0.8 takes 5.4 from psi1 = 2."""
    assert smooth(piece, 2.0, 0.5, 1.5, 0.8) == pytest.approx(value, abs=1e-15)
    assert rough_of(piece, 2.0, value, 1.5, 0.8) == pytest.approx(0.5, abs=1e-15)


def test_nodes_are_chebyshevs_and_coefficients_are_found_at_them():
    half_root = np.sqrt(3.0) / 2.0
    assert damped_nodes(3, 1.0, 5.0) == pytest.approx([3 - 2 * half_root, 3.0, 3 + 2 * half_root])
    wanted = np.arange(1.0, 7.0).reshape(2, 3)
    x, y = np.meshgrid(damped_nodes(2, -1.0, 1.0), damped_nodes(3, -1.0, 1.0), indexing="ij")
    assert coefficients(chebval2d(x, y, wanted)) == pytest.approx(wanted, abs=1e-14)
    assert restitution(0.5) == 0.875


def test_elastic_gross_slip_by_few_rings():
    psi1, chi = np.array([[8.0], [9.0]]), np.array([1.0, 1.4])
    found = build.solve(psi1, chi, 1.0)
    assert found == pytest.approx(psi1 - 4.0 * chi, abs=1e-9)


@pytest.mark.parametrize(("psi1", "sign"), [(8.0, 1), (0.3, -1)])
def test_the_sign_of_the_last_slip(psi1, sign):
    """Slip throughout ends as it began; at chi = 1 an impact that sticks first ends backward."""
    assert exact.last_slip(psi1, 1.0) == sign


def test_impacts_alone_of_two_closed_forms():
    found = exact.alone(np.array([8.0, 0.6]), np.array([1.5, 0.5]))
    assert found == pytest.approx([2.0, -0.6], abs=1e-12)


def test_the_shipped_sizes_of_coupling_are_of_the_nodes_of_the_builder():
    lines = FILE.read_text(encoding="utf-8").splitlines()
    assert lines[2] == "psi1,chi,poisson_ratio,Lambda=0.25,Lambda=0.5,Lambda=1,Lambda=2,Lambda=4"
    assert [line.split(",")[:3] for line in lines[3:]] == [
        [f"{psi1:g}", f"{chi:g}", f"{nu:g}"]
        for chi in unlike.CHI
        for nu in (0.0, 0.5)
        for psi1 in unlike.PSI1
    ]


@pytest.mark.parametrize(
    "asked", ["", "elastic", "damped", "damped build --count 3", "damped build --file any.npz"]
)
def test_an_unfinished_command_is_refused(asked, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["table_builders", *asked.split()])
    with pytest.raises(SystemExit) as ended:
        command.main()
    assert ended.value.code == 2
    assert "usage: python -m table_builders" in capsys.readouterr().err
