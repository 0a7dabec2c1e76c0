"""The builder of the table with a restitution, by hand and against closed forms."""

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval2d

from contactlab_laws.halfspace.course import course
from contactlab_laws.tables.damped import BORDERS, RINGS, SLIPS, STICKS, TURNS, Section, _together
from contactlab_laws.tables.damped import place as place_of
from contactlab_laws.tables.damped import rough as rough_of
from contactlab_laws.tables.file import read
from table_builders.damped import build
from table_builders.damped.coordinates import (
    coefficients,
    incidence,
    nodes,
    restitution,
    smooth,
)
from tests.laws.other_march import motion

CUTS = (1.2, 2.2, 5.2)


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
    assert incidence(piece, at, CUTS) == pytest.approx(psi1, abs=1e-14)
    assert place_of(piece, psi1, CUTS) == pytest.approx(at, abs=1e-7)


@pytest.mark.parametrize(
    ("piece", "value"), [(STICKS, 0.25), (RINGS, 0.5), (TURNS, 0.5), (SLIPS, 3.9)]
)
def test_the_tabulated_quantity_and_back(piece, value):
    """Gross slip at chi = 1.5, e = 0.8 takes 5.4 from psi1 = 2."""
    assert smooth(piece, 2.0, 0.5, 1.5, 0.8) == pytest.approx(value, abs=1e-15)
    assert rough_of(piece, 2.0, value, 1.5, 0.8) == pytest.approx(0.5, abs=1e-15)


def test_nodes_are_chebyshevs_and_coefficients_are_found_at_them():
    half_root = np.sqrt(3.0) / 2.0
    assert nodes(3, 1.0, 5.0) == pytest.approx([3 - 2 * half_root, 3.0, 3 + 2 * half_root])
    wanted = np.arange(1.0, 7.0).reshape(2, 3)
    x, y = np.meshgrid(nodes(2, -1.0, 1.0), nodes(3, -1.0, 1.0), indexing="ij")
    assert coefficients(chebval2d(x, y, wanted)) == pytest.approx(wanted, abs=1e-14)
    assert restitution(0.5) == 0.875


STEP = np.array([0.0, 10.0, 20.0, 30.0, 40.0])


@pytest.mark.parametrize(
    ("share", "psi1"),
    [
        ([0.3, 0.5, 0.8, 1.0, 1.0], 20.0 + 0.2 / 0.03),
        ([0.3, 0.7, 0.8, 1.0, 1.0], 30.0),  # the line comes to 1 beyond the next
        ([0.3, 0.5, 0.9949, 0.98, 1.0], 40.0),  # falling: not before the next
        ([0.9, 0.9949, 0.9949, 1.0, 1.0], 25.1),  # as flat as a rise can be
        ([0.3, 0.5, 1.0, 0.9, 1.0], 40.0),  # for good
        ([0.3, 0.5, 0.6, 0.7, 0.8], 40.0),  # never
        ([0.8, 1.0, 1.0, 1.0, 1.0], 10.0),
        ([1.0, 1.0, 1.0, 1.0, 1.0], 10.0),
        ([0.96, 0.98, 0.995, 1.0, 1.0], 20.0),  # no more than the limit: 1 - 0.98 at 0.002 a unit
    ],
)
def test_where_a_share_comes_to_one_for_good(share, psi1):
    assert build._reaching(STEP, np.array(share), 0.995) == pytest.approx(psi1, abs=1e-9)


def test_the_largest_share_is_that_before_the_slip_of_the_end():
    late = [0.1, 0.5, 0.6, 0.7, 0.2, 0.9, 1.0]
    early = [0.8, 0.5, 0.3, 0.2, 0.4, 0.9, 1.0]
    assert build._largest(np.array([late, early]).T, 2).tolist() == [0.7, 0.8]


def test_the_margin_is_the_least_excess_of_slip_in_unloading():
    """Of elastic spheres whose central limit falls as zeta, at the rate V <= 0."""
    path = course(motion("hertz"), 8, 1)
    rate = np.full((15, 2), 0.25)
    rate[3:, 1] = [9.0] * 5 + [-0.75] * 7
    steepest = -(np.diff(path.radius[8:16] ** 2) / np.diff(path.time[8:16, 0])).max()
    assert 0.0 < steepest < 0.5
    found = build._margin(rate, path, 8)
    assert found == pytest.approx([0.25 + steepest, -0.75 + steepest], abs=1e-6)


def test_pieces_between_cuts_are_no_narrower_than_their_least():
    cuts = build.cuts_at(0.9, np.array([0.8, 1.5]), rings=6)
    assert (np.diff(cuts, axis=0) >= build.NARROWEST - 1e-12).all()


def test_elastic_gross_slip_by_few_rings():
    psi1, chi = np.array([[8.0], [9.0]]), np.array([1.0, 1.4])
    found = build.solve(psi1, chi, 1.0)
    assert found == pytest.approx(psi1 - 4.0 * chi, abs=1e-9)


def cuts_of(t, chi):
    return np.array([1.0 + 0.2 * chi + 0.1 * t, 2.0 + chi + 0.2 * t, 6.0 + chi - 0.3 * t])


def psi2_of(piece, psi1, chi, e):
    """Return psi2 that each piece can hold: of its coordinate by hand, smooth in chi and t."""
    t = np.cbrt(1.0 - e)
    low, middle, high = cuts_of(t, chi)
    if piece == STICKS:
        return psi1 * (0.1 + 0.3 * t) * (1.0 + chi * psi1 / low)
    if piece == RINGS:
        return chi - t * np.sqrt((psi1 - low) / (middle - low))
    if piece == TURNS:
        return (1.0 + t) * (psi1 - middle) / (high - middle)
    return psi1 - 2.0 * chi * (1.0 + e) + t * (high - 1.0) / (psi1 - 1.0)


def test_a_small_table_is_built_and_read_back(monkeypatch, tmp_path, capsys):
    """At restitutions of both pieces of t, between the nodes."""
    monkeypatch.setattr(build, "NODES", (4, 3, 2))
    monkeypatch.setattr(build, "cuts_at", lambda e, chi: cuts_of(np.cbrt(1.0 - e), chi))
    monkeypatch.setattr(
        build,
        "solve",
        lambda psi1, chi, e: np.array([psi2_of(k, psi1[k], chi, e) for k in range(4)]),
    )
    build.build(tmp_path / "small.npz")
    told = capsys.readouterr().err.splitlines()
    assert told[0::3] == ["cuts of piece 1 of 2", "cuts of piece 2 of 2"]
    near = 0.5 * BORDERS[1] * (1.0 - np.sqrt(0.5))
    assert told[1] == f"1 of 4: e = {1.0 - near**3:.4f}"
    assert [line.split(":")[0] for line in told[1:3] + told[4:]] == [
        f"{done} of 4" for done in range(1, 5)
    ]
    stored = read(tmp_path / "small.npz")
    assert set(stored.arrays) == {"cuts", "terms"}
    assert stored.arrays["terms"].shape == (2, 4, 4, 3, 2)
    for e in (0.99, 0.95, 0.8, 0.55):
        ours, t = Section.of(stored, e), np.cbrt(1.0 - e)
        for chi in (0.9, 1.3, 1.7):
            low, middle, high = cuts_of(t, chi)
            psi1 = np.array(
                [0.4 * low, 0.7 * low + 0.3 * middle, 0.5 * (middle + high), 2.0 * high]
            )
            expected = [psi2_of(piece, psi1[piece], chi, e) for piece in range(4)]
            found = _together(psi1, np.full(4, chi), e, ours)
            # The last terms along psi1 may be left out where they add up to less than 1e-5.
            assert found == pytest.approx(expected, abs=3e-5)
