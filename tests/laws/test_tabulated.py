"""The tabulated rebound against fresh exact impacts, and against itself."""

import math

import numpy as np
import pytest
from numpy.polynomial import Chebyshev
from numpy.polynomial.polynomial import polyder, polygrid2d, polyval

import contactlab
from contactlab import Simulation, rebound
from contactlab.study.bench_methods import scenes
from contactlab_laws.tables import elastic, patches
from contactlab_laws.tables.elastic import SHIPPED, load_table
from contactlab_laws.tables.file import read
from contactlab_laws.tables.patches import nodes, polynomial
from contactlab_laws.tables.regions import (
    CUT_END,
    FIRST_POWER,
    LARGEST_CHI,
    SEAM_FROM,
    places,
    slip_cut,
)

pytest.importorskip("table_builders", reason="table_builders is not in the wheel")

from table_builders.elastic import cuts
from table_builders.elastic.coordinates import NAMES, impact
from table_builders.elastic.exact import exact, last_slip, reaches_disk
from table_builders.elastic.fit import FINE, Cell, begins_at_one, fit, slope_at_one
from table_builders.elastic.verify import draw, verify
from tests.laws.reference import TABLE

BOUND = 1e-9


def stored():
    """The cells of the table, and the terms by powers of their local coordinates."""
    arrays = read(SHIPPED).arrays
    return arrays["cells"].tolist(), arrays["terms"]


def mixed(count, seed):
    return draw(count, seed, load_table().cuts)[:2]


@pytest.mark.parametrize(("chi", "psi1", "value"), [row for row in TABLE if row[0] <= LARGEST_CHI])
def test_reference_table(chi, psi1, value):
    """Theory §5, ten digits."""
    assert rebound(psi1, chi) == pytest.approx(value, abs=1e-10)


def test_fresh_impacts():
    """A third of them on or beside singular curves."""
    rows = verify(load_table(), count=150, seed=20)
    assert {row.name for row in rows} > {*NAMES, "all"}
    assert max(row.largest for row in rows) < BOUND
    assert rows[-1].rms < 0.1 * BOUND


@pytest.mark.slow
def test_many_fresh_impacts():
    assert verify(load_table(), count=20_000, seed=21)[-1].largest < BOUND


def test_odd_to_the_last_bit():
    psi1, chi = mixed(5000, 22)
    assert np.array_equal(rebound(-psi1, chi), -rebound(psi1, chi))
    for pair in zip(psi1[:200].tolist(), chi[:200].tolist(), strict=True):
        assert rebound(-pair[0], pair[1]) == -rebound(*pair)
    both = rebound(np.array([-1.0, 1.0])[:, None] * psi1[:9], chi[:9], derivatives=True)
    assert np.array_equal(both[1][0], both[1][1])
    assert np.array_equal(both[2][0], -both[2][1])


def test_bounds():
    """No gain of energy, and no more impulse than full slip gives."""
    psi1, chi = mixed(200_000, 23)
    chi[::7] *= 10.0 ** -np.linspace(0.0, 15.0, chi[::7].size)
    psi2 = rebound(psi1, chi)
    assert np.all(np.abs(psi2) <= psi1)
    assert np.all(psi1 - psi2 <= 4.0 * chi * (1.0 + 1e-15) + 1e-15 * psi1)
    assert np.all(psi2 <= psi1)


def test_limits():
    assert math.copysign(1.0, rebound(0.0, 1.0)) == 1.0
    assert rebound(0.0, 1.0) == 0.0
    assert rebound(0.6, 0.5) == -0.6
    assert rebound(1.0, 0.5) == -1.0
    assert rebound(1e300, 2.0) == 1e300
    assert rebound(7.0, 1.25) == 2.0
    assert rebound(1e-300, 1.4411764705882353) == pytest.approx(0.23167e-300, rel=1e-5, abs=0.0)
    assert rebound(0.9, 1e-12) == pytest.approx(0.9, abs=4.1e-12)


def seams(count):
    """Both sides of every line where one region, or one patch, ends and another begins."""
    made = load_table()
    unit = np.linspace(0.0, 1.0, count)
    step = 1e-13
    pairs = []
    for region, level_a, level_b, i, j in stored()[0]:
        a, b = (i + unit) / 2**level_a, (j + unit) / 2**level_b
        for edge in (i / 2**level_a, j / 2**level_b):
            along_a = edge == i / 2**level_a
            for side in (-step, step):
                here = np.clip(np.full(count, edge + side), 0.0, 1.0)
                place = (here, b) if along_a else (a, here)
                pairs.append(np.stack(impact(region, *place, made.cuts)))
    chi = LARGEST_CHI * (0.01 + 0.99 * np.linspace(0.0, 1.0, 40 * count))
    for border in (np.ones_like(chi), 4.0 * chi - 1.0, np.abs(2.0 * chi - 1.0) + 1.0, 2.0 * chi):
        pairs += [np.stack((np.abs(border + side), chi)) for side in (-step, step)]
    t = CUT_END * unit

    def beside(side):
        cut = np.minimum(slip_cut(made.cuts.slip, t) + side, LARGEST_CHI)
        yield np.stack((unit, np.full(count, 0.5 + side)))
        yield np.stack((unit, polynomial(made.cuts.stuck, unit) + side))
        yield np.stack((1.0 + t**5 * (2.0 * cut - 1.0), cut))

    for both in zip(beside(-step), beside(step), strict=True):
        pairs += both
    return pairs


def test_continuous_across_every_seam():
    pairs = seams(25)
    for one, other in zip(pairs[::2], pairs[1::2], strict=True):
        inside = (one[1] <= LARGEST_CHI) & (other[1] <= LARGEST_CHI)
        inside &= (one[1] > 0.0) & (other[1] > 0.0)
        first, second = (rebound(*side[:, inside]) for side in (one, other))
        scale = np.maximum(1.0, one[0, inside])
        assert np.max(np.abs(first - second) / scale, initial=0.0) < BOUND


def test_slope_is_continuous_at_psi1_of_one_and_at_full_slip():
    """C¹ there, though the regions beside share no patch (theory §10)."""
    chi = np.linspace(0.01, LARGEST_CHI, 400)
    chi = chi[np.abs(chi - 0.5) > 1e-3]
    for border in (np.ones_like(chi), np.maximum(1.0, 4.0 * chi - 1.0)):
        # what lies between is delta^(3/5): 4e-10 of it
        before = rebound(border * (1.0 - 2e-16), chi, derivatives=True)
        after = rebound(border * (1.0 + 2e-16), chi, derivatives=True)
        for one, other in zip(before[1:], after[1:], strict=True):
            hard = (chi > 1.83) & (chi < 1.92)
            assert np.abs(one - other)[~hard].max() < 1e-6
            assert np.abs(one - other)[hard].max() < 5e-6


@pytest.mark.slow
def test_derivatives_against_differences_of_exact_impacts():
    psi1, chi, _ = draw(80, 24, load_table().cuts)
    curves = np.array([psi1, psi1 - 1.0, psi1 - 4.0 * chi + 1.0, chi, chi - 0.5, chi - LARGEST_CHI])
    far = np.abs(curves).min(axis=0) > 1e-3
    psi1, chi = psi1[far][:30], chi[far][:30]
    assert psi1.size > 25
    h = 5e-5

    def difference(x, y):
        near, wide = (
            exact(psi1 + n * h * x, chi + n * h * y) - exact(psi1 - n * h * x, chi - n * h * y)
            for n in (1, 2)
        )
        return (8.0 * near - wide) / (12.0 * h)

    _, by_psi1, by_chi = rebound(psi1, chi, derivatives=True)
    assert np.abs(by_psi1 - difference(1, 0)).max() < 1e-6
    assert np.abs(by_chi - difference(0, 1)).max() < 1e-6


def test_derivatives_are_those_of_the_table():
    psi1, chi = (np.abs(values) for values in mixed(4000, 25))
    away = (
        (psi1 < 4.0 * chi - 1.1)
        & (np.abs(psi1 - 1.0) > 1e-2)
        & (np.abs(chi - 0.5) > 1e-2)
        & (chi < 2.49)
        & (chi > 0.01)
    )
    psi1, chi = psi1[away] + 1e-3, chi[away]
    _, by_psi1, by_chi = rebound(psi1, chi, derivatives=True)
    h = 1e-5
    change = (rebound(psi1 + h, chi) - rebound(psi1 - h, chi)) / (2.0 * h)
    assert np.abs(by_psi1 - change).max() < 2e-6
    change = (rebound(psi1, chi + h) - rebound(psi1, chi - h)) / (2.0 * h)
    assert np.abs(by_chi - change).max() < 5e-6


def test_scalar_gathered_and_sorted_agree(monkeypatch):
    psi1, chi = mixed(3000, 26)
    gathered = rebound(psi1, chi)
    monkeypatch.setattr(patches, "FEW", 0)
    assert np.abs(rebound(psi1, chi) - gathered).max() < 2e-12
    monkeypatch.setattr(elastic, "BLOCK", 700)
    monkeypatch.setattr(patches, "STRETCH", 3)
    assert np.abs(rebound(psi1, chi) - gathered).max() < 2e-12
    pairs = list(zip(psi1.tolist(), chi.tolist(), strict=True))
    singly = [rebound(*pair) for pair in pairs]
    off = np.abs(np.array(singly) - gathered)
    # At a seam rounding, which is not that of arrays, may choose the patch of the other side.
    here = places(np.abs(psi1), chi, load_table().cuts)
    cells = np.array([here.a, here.b]) * 64.0
    seam = np.zeros(psi1.size, dtype=bool)
    seam[here.who] = (np.abs(cells - np.round(cells)) < 1e-9).any(axis=0)
    assert off[~seam].max() < 2e-12
    assert off[seam].max(initial=0.0) < 4e-11


def test_places_and_impacts_are_each_others_inverse():
    made = load_table()
    psi1, chi = mixed(3000, 27)
    here = places(psi1, chi, made.cuts)
    for region in np.unique(here.region).tolist():
        part = here.region == region
        a, b = here.a[part], here.b[part]
        assert ((a >= 0.0) & (a <= 1.0) & (b >= 0.0) & (b <= 1.0)).all()
        back = impact(region, a, b, made.cuts)
        assert np.abs(back[0] - psi1[here.who[part]]).max() < 1e-14 * 10
        assert np.abs(back[1] - chi[here.who[part]]).max() < 1e-14 * 10


@pytest.mark.slow
def test_the_cuts_are_found_again(monkeypatch):
    """Coarsely: by few points, chi to 1e-3."""
    monkeypatch.setattr(cuts, "POINTS", 12)
    monkeypatch.setattr(cuts, "HALVINGS", 8)
    unit = np.linspace(0.0, 1.0, 21)
    found, known = cuts.find(), load_table().cuts
    for curve, arguments, one, other in zip(
        (polynomial, slip_cut, polynomial),
        (unit, CUT_END * unit, SEAM_FROM + (1.0 - SEAM_FROM) * unit),
        found,
        known,
        strict=True,
    ):
        assert curve(one, arguments) == pytest.approx(curve(other, arguments), abs=3e-3)


@pytest.mark.slow
@pytest.mark.parametrize("row", [(5, 2, 2, 0, 1), (5, 3, 2, 4, 1)], ids=["at psi1 = 1", "beyond"])
def test_a_patch_is_made_again_from_exact_impacts(row):
    """At once as good as the table's tolerance, and the same polynomial, slopes included."""
    made, cell = load_table(), Cell(*row)
    cells, all_terms = stored()
    known = all_terms[cells.index(list(row))]
    psi1, chi = cell.nodes(made.cuts)
    slope = None
    if begins_at_one(cell):
        slope = slope_at_one(cell, made.cuts, exact)
        b = (cell.j + nodes(FINE)) * 0.5**cell.level_b
        seam = polynomial(made.cuts.seam, np.maximum(b, SEAM_FROM))
        width = 2.0 * seam * CUT_END * 0.5**cell.level_a
        of_table = polyval(nodes(FINE), known[FIRST_POWER]) / width**FIRST_POWER
        assert slope == pytest.approx(of_table, abs=1e-7)
    psi2 = exact(psi1.ravel(), chi.ravel()).reshape(psi1.shape)
    patch = fit(cell, made.cuts, psi1, chi, psi2, slope)
    assert max(patch.error_a, patch.error_b) < float(read(SHIPPED).arrays["tolerance"])
    x = np.linspace(0.0, 1.0, 33)
    for one, other in ((patch.terms, known), (polyder(patch.terms), polyder(known))):
        assert polygrid2d(x, x, one) == pytest.approx(polygrid2d(x, x, other), abs=1e-8)


@pytest.mark.parametrize(
    ("beyond", "low", "high", "power"),
    [(reaches_disk, 1.03, 1.04, 4.0), (lambda *impact: last_slip(*impact) < 0, 1.8, 1.95, 2.5)],
    ids=["seam", "cut"],
)
def test_the_exact_law_leaves_its_continuation_by_a_power(beyond, low, high, power):
    """At chi = 2.3, from above a curve of theory §10; the law alone, without the table."""
    for _ in range(45):
        psi1 = 0.5 * (low + high)
        low, high = (low, psi1) if beyond(psi1, 2.3) else (psi1, high)
    above, below = 4e-3 * nodes(8), -2e-3 / np.array([1.0, 2.0, 4.0])
    values = exact(high + np.concatenate((above, below)), np.full(11, 2.3))
    left = values[8:] - Chebyshev.fit(above, values[:8], 7)(below)
    assert np.log2(left[:-1] / left[1:]) == pytest.approx([power] * 2, abs=0.05)


def test_beyond_the_table():
    psi1 = np.linspace(0.0, 10.0, 41)
    seam = [rebound(psi1, chi) for chi in (LARGEST_CHI, np.nextafter(LARGEST_CHI, 3.0))]
    assert np.abs(seam[0] - seam[1]).max() < 5e-9
    chi = np.array([1.0, 3.0])
    assert np.array_equal(rebound(2.0, chi), [rebound(2.0, 1.0), rebound(2.0, 3.0)])
    assert rebound(-2.0, 3.0) == -rebound(2.0, 3.0)


def test_shapes():
    assert type(rebound(1, 1)) is float
    assert rebound([1.0, 2.0], [[1.0], [2.0], [0.3]]).shape == (3, 2)
    values = rebound(1.2, [1.44], derivatives=True)
    assert [value.shape for value in values] == [(1,)] * 3
    assert all(type(value) is float for value in rebound(1.2, 1.44, derivatives=True))


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ({"psi1": np.nan, "chi": 1.0}, "psi1"),
        ({"psi1": 1.0, "chi": 0.0}, "chi"),
        ({"psi1": 1.0, "chi": -1.0}, "chi"),
        ({"psi1": np.inf, "chi": 1.0}, "psi1"),
        ({"psi1": [1.0, 2.0], "chi": [1.0, 2.0, 3.0]}, "shapes"),
        ({"psi1": 1.0, "chi": 3.0, "derivatives": True}, "2.5"),
    ],
)
def test_refusals(arguments, word):
    with pytest.raises(ValueError, match=word):
        rebound(**arguments)


def test_contactlab_rebound_uses_the_table_up_to_its_tolerance():
    psi1, chi = np.array([0.3, 1.2, 2.0, 5.0, 1.1]), np.array([1.0, 1.44, 3.0, 2.0, 0.3])
    low = chi <= LARGEST_CHI
    mixture = contactlab.rebound(psi1, chi)
    assert np.array_equal(mixture[low], elastic.rebound(psi1[low], chi[low]))
    values = contactlab.rebound(psi1[low], chi[low], derivatives=True)
    expected = elastic.rebound(psi1[low], chi[low], derivatives=True)
    for one, other in zip(values, expected, strict=True):
        assert np.array_equal(one, other)

    solved = contactlab.rebound(psi1, chi, tolerance=1e-9)
    assert 0.0 < np.abs(solved - mixture)[low].max() < 2e-9


def test_the_error_over_the_scenes_of_the_benchmark_is_that_of_the_theory_page():
    for scene in scenes(quick=False):
        integrator = contactlab.create("integrator.events", tolerance=1e-12)
        known = float(Simulation(integrator=integrator).run(scene).check().psi2)
        found = contactlab.rebound(float(scene.psi1), float(scene.chi))
        assert found == pytest.approx(known, abs=2e-11)


def test_derivatives_at_the_edge_of_slip_below_chi_of_one_half():
    """At psi1 = 1 exactly the derivative by psi1 was 0/0; slip throughout begins there, with 1."""
    for chi in (0.02, 0.1, 0.3, 0.45):
        _, by_psi1, by_chi = rebound(
            np.array([1.0 - 1e-12, 1.0, 1.0 + 1e-12]), chi, derivatives=True
        )
        assert by_psi1 == pytest.approx(1.0, abs=1e-7)
        assert by_chi == pytest.approx(-4.0, abs=1e-7)
