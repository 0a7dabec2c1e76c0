"""The builders of tables: by hand, against closed forms, and the commands."""

import sys

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval3d

from contactlab.impact.coupling import FILE
from contactlab_laws.tables import regions
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

from table_builders import __main__ as command
from table_builders.coupling import build as unlike
from table_builders.elastic import exact
from table_builders.elastic.coordinates import impact, measure
from table_builders.elastic.fit import FINE, Cell, slope_at_one
from table_builders.restituted import build

#: Cuts at chi = 1.5 + psi1/10 and chi = 2 + t^5, and the seam at t/CUT_END = 0.3 + b/5.
CUTS = Cuts(np.array([1.5, 0.1]), np.array([2.0, 1.0]), np.array([0.3, 0.2]))
#: 2 chi - 1 a quarter of the way from the cut at t = 0.32, on the seam, up to 2.7.
PAST_SEAM = 2.0 * (0.75 * (2.0 + 0.32**5) + 0.25 * 2.7) - 1.0


@pytest.mark.parametrize(
    ("region", "a", "b", "psi1", "chi"),
    [
        (SMALL_NEAR, 0.5, 0.5, 1.0 - 0.5**6, 0.25),
        (SMALL_FAR, 0.5, 0.25, 0.75, 0.4375),
        (STUCK_BACK, 0.5, 0.5, 0.5, 1.025),  # half between 1/2 and 1.55
        (STUCK_ON, 0.5, 0.5, 0.5, 1.7875),  # a quarter between 1.55 and 5/2
        (SLIP_BACK, 0.5, 0.5, 1.0 + 0.4**5 * 1.51024, 1.25512),  # the cut at 2.01024
        (SLIP_ON, 0.5, 0.5, 1.0 + 0.32**5 * PAST_SEAM, 0.5 + 0.5 * PAST_SEAM),
        (SLIP_LONG, 0.5, 0.5, 1.0 + 0.9**5 * 2.0, 1.5),
        (SLIP_LATE, 0.5, 0.25, 2.5, 1.0),
    ],
)
def test_the_impact_of_a_place(region, a, b, psi1, chi):
    found = impact(region, np.array([a]), np.array([b]), CUTS)
    assert np.concatenate(found) == pytest.approx([psi1, chi], abs=1e-12)
    expected = 1.0 - psi1 if region == SMALL_FAR else abs(2.0 * chi - 1.0)
    assert measure(region, *found) == pytest.approx([expected], abs=1e-12)
    single = regions.SingleCuts(
        lambda at: 1.5 + 0.1 * at, (2.0, lambda _: 1.0), lambda b: 0.3 + 0.2 * b
    )
    found = regions.place(psi1, chi, single)
    assert found == pytest.approx((region, a, b, expected), abs=1e-12)
    here = regions.places(*(np.full(1, each) for each in (psi1, chi)), CUTS)
    assert (here.region[0], here.a[0], here.b[0]) == pytest.approx((region, a, b), abs=1e-12)


def test_the_slope_along_a_cut_that_climbs():
    """With psi2 = chi² + 3 (psi1 - 1) at psi1 = 1: at constant chi, and then along the cut."""
    for region, up in ((SLIP_BACK, False), (SLIP_ON, True)):
        found = slope_at_one(
            Cell(region, 0, 1, 0, 1), CUTS, lambda psi1, chi: chi**2 + 3.0 * (psi1 - 1.0)
        )
        b = (1.0 + nodes(FINE)) / 2.0
        chi = 2.0 + 0.7 * b * b if up else 0.5 + 1.5 * b
        by_cut = 1.0 - b * b if up else b
        g_by_chi = (2 * chi * (2 * chi - 1) - 2 * (chi**2 + 1)) / (2 * chi - 1) ** 2
        assert found == pytest.approx(3.0 - chi**2 + g_by_chi * by_cut, abs=1e-6)


def test_the_impacts_of_a_cell_of_restitutions():
    """Those of a region that slips: half of (1 - u)² of the way from K = 2 chi (1 + e) - e to 1."""
    cell = build.Cell(2, (1, 0, 2), (1, 0, 3))
    inner = (np.array([0.0, 0.5]), np.array([0.25]), np.array([0.5]))
    assert cell.shares(2, inner[2]) == pytest.approx([0.875])
    psi1, chi = cell.impacts(inner, 0.5)
    assert chi == pytest.approx(0.75)
    assert psi1.ravel() == pytest.approx([1.75 - 0.75 * 0.25, 1.75 - 0.75 * 0.0625])
    assert cell.split(1) == [
        build.Cell(2, (1, 1, 2), (1, 0, 3)), build.Cell(2, (1, 1, 2), (1, 1, 3))
    ]  # fmt: skip
    assert build.Cell(0, (0, 0, 0), (0, 0, 0)).impacts(inner, 0.5)[0].ravel().tolist() == [0, 0.5]


def test_a_cell_that_is_a_polynomial_holds_it():
    """With psi2 = psi1² chi (1 + e) in place of springs."""
    aims = (1e-4,) * 5
    even = build.Quantity(lambda psi1, chi, e: psi1**2 * chi * (1.0 + e), aims, 1, ends=True)
    cells = [build.Cell(1, (1, 0, 0), (1, 0, 0)), build.Cell(3, (1, 0, 0), (0, 0, 0))]
    terms = build.terms_of(even, cells)
    found = chebval3d(0.5, -0.25, 0.0, terms[0])
    assert found == pytest.approx(0.875 * (0.5 + 2.5 * 0.375) * 1.5)  # of psi2/psi1, at e = 1/2
    assert max(build.errors(even, cells, terms)) < 1e-9
    assert build.holding(even, cells, terms) == [True, True]
    jumps = build.Quantity(
        lambda psi1, chi, e: np.sign(psi1 - 0.7) + 0.0 * chi * e, aims, 1, ends=True
    )
    own = build.terms_of(jumps, cells[:1])
    assert build.holding(jumps, cells[:1], own) == [False]
    assert build.tails(cells[0], own[0]).argmax() == 0
    squares = build.Quantity(even.solve, aims, 2, ends=False)
    over = build.terms_of(squares, cells)
    assert chebval3d(0.5, -0.25, 0.0, over[0]) == pytest.approx((0.5 + 2.5 * 0.375) * 1.5)


@pytest.mark.parametrize(("psi1", "sign"), [(8.0, 1), (0.3, -1)])
def test_the_sign_of_the_last_slip(psi1, sign):
    """Slip throughout ends as it began; at chi = 1 an impact that sticks first ends backward."""
    assert exact.last_slip(psi1, 1.0) == sign


def test_exact_impacts_of_two_closed_forms():
    found = exact.exact(np.array([8.0, 0.6, 1.0]), np.array([1.5, 0.5, 0.5]))
    assert found == pytest.approx([2.0, -0.6, -1.0], abs=1e-14)


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
    "asked",
    ["", "elastic", "restituted", "restituted build --count 3", "restituted build --file any.npz"],
)
def test_an_unfinished_command_is_refused(asked, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["table_builders", *asked.split()])
    with pytest.raises(SystemExit) as ended:
        command.main()
    assert ended.value.code == 2
    assert "usage: python -m table_builders" in capsys.readouterr().err
