"""The readers of tables by parts: polynomials three ways, places on every border, refused files."""

import hashlib
from datetime import UTC, datetime
from importlib import metadata

import numpy as np
import pytest
from numpy.polynomial import Chebyshev, Polynomial
from numpy.polynomial.polynomial import polyval, polyval2d

from contactlab_laws.tables import damped, elastic, patches, regions
from contactlab_laws.tables.file import Stored, read, write
from contactlab_laws.tables.patches import (
    Patches,
    chebyshev_of_values,
    compiled_polynomial,
    needed,
    nodes,
    polynomial,
    powers,
    powers_of_chebyshev,
)
from contactlab_laws.tables.regions import Cuts, SingleCuts, place, places

DRAW = np.random.default_rng(12)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_polynomials_of_one_argument(count):
    terms = DRAW.normal(size=count)
    at = np.linspace(-1.0, 2.0, 7)
    known = polyval(at, terms)
    assert polynomial(terms, at) == pytest.approx(known, abs=1e-13)
    single = compiled_polynomial(terms)
    assert [single(x) for x in at.tolist()] == pytest.approx(known.tolist(), abs=1e-13)
    room = np.empty((max(count, 2), 7))
    assert powers(at, room)[:count] == pytest.approx(at ** np.arange(count)[:, None])


def test_a_cut_without_its_low_powers():
    terms = np.zeros(9)
    terms[[0, 5, 6, 8]] = 2.0, 0.3, -0.2, 0.1
    t = np.linspace(0.0, 1.0, 6)
    assert regions.slip_cut(terms, t) == pytest.approx(polyval(t, terms), abs=1e-15)


@pytest.mark.parametrize(("stretch", "shift"), [(1.0, 0.0), (2.0, 1.0)])
def test_chebyshevs_terms_by_powers(stretch, shift):
    terms = DRAW.normal(size=6)
    matrix = powers_of_chebyshev(6, stretch=stretch, shift=shift)
    known = Chebyshev(terms).convert(kind=Polynomial)(Polynomial([-shift, stretch]))
    assert matrix @ terms == pytest.approx(known.coef, abs=1e-12)
    values = Chebyshev(terms)(2.0 * nodes(6) - 1.0)
    assert chebyshev_of_values(6) @ values == pytest.approx(terms, abs=1e-14)
    assert (np.diff(nodes(6)) > 0.0).all()


@pytest.mark.parametrize(
    ("sizes", "small", "count"),
    [
        ([3.0, 2.0, 1.0], 0.5, 3),
        ([3.0, 2.0, 1.0], 1.0, 2),  # what is left out may add up to as much
        ([3.0, 2.0, 1.0], 2.9, 2),
        ([3.0, 2.0, 1.0], 3.0, 1),
        ([3.0, 2.0, 1.0], 99.0, 1),  # one at least
    ],
)
def test_how_many_terms_are_needed(sizes, small, count):
    assert needed(np.array([sizes, sizes]), small).tolist() == [count, count]


@pytest.fixture
def three():
    """Three patches of 4 by 3 terms, of which some need fewer."""
    terms = DRAW.normal(size=(3, 4, 3))
    terms[1, 2:], terms[1, :, 2:], terms[2, :, 2:] = 0.0, 0.0, 0.0
    return Patches(DRAW.uniform(size=(2, 3)), terms, [[4, 2, 4], [3, 2, 2]])


@pytest.mark.parametrize(
    ("few", "gathered", "stretch"), [(999, 200, 99), (999, 7, 99), (0, 1, 99), (0, 1, 7), (0, 1, 1)]
)
def test_patches_are_evaluated_in_any_order(few, gathered, stretch, three, monkeypatch):
    monkeypatch.setattr(patches, "FEW", few)
    monkeypatch.setattr(patches, "GATHERED", gathered)
    monkeypatch.setattr(patches, "STRETCH", stretch)
    for numbers in (DRAW.integers(0, 3, 40), np.full(9, 2), np.array([2, 0, 2])):
        a, b = DRAW.uniform(size=(2, numbers.size))
        known = [
            polyval2d(x - three.origins[0, k], y - three.origins[1, k], three.terms[k])
            for k, x, y in zip(numbers, a, b, strict=True)
        ]
        found = three.values(numbers.astype(np.int16), a.copy(), b.copy())
        assert found == pytest.approx(known, abs=1e-13)


def test_the_number_of_places_from_which_patches_are_sorted(three, monkeypatch):
    asked = []
    for name in ("_sorted", "_gathered"):
        monkeypatch.setattr(Patches, name, lambda *_, name=name: asked.append(name))
    for count in (1999, 2000):
        three.values(np.zeros(count, dtype=np.int16), np.zeros(count), np.zeros(count))
    assert asked == ["_gathered", "_sorted"]


def test_a_single_place_before_and_after_it_is_compiled(three, monkeypatch):
    monkeypatch.setattr(patches, "COMPILED", 3)
    for k in range(3):
        first = three.single[k]
        known = polyval2d(0.3 - three.origins[0, k], 0.8 - three.origins[1, k], three.terms[k])
        for call in range(1, 6):
            assert three.single[k](0.3, 0.8) == pytest.approx(known, abs=1e-13)
            assert (three.single[k] is first) is (call < 3)


CUTS = Cuts(np.array([1.5, 0.25]), np.array([2.0, 0, 0, 0, 0, 0.5]))
SINGLE = SingleCuts(lambda speed: 1.5 + 0.25 * speed, lambda t: 2.0 + 0.5 * t**5)

#: Impacts on borders, which belong to the region named; numbers that halves and fifth roots keep.
BORDERS = [
    (1.0, 0.25, regions.SMALL_NEAR),  # psi1 = 1, chi < 1/2
    (0.5, 0.25, regions.SMALL_FAR),  # as far from psi1 = 1 as from chi = 1/2
    (0.5, 0.2499, regions.SMALL_NEAR),
    (0.0, 0.25, regions.SMALL_FAR),
    (0.5, 0.5, regions.STUCK_BACK),
    (1.0, 0.5, regions.STUCK_BACK),
    (1.0, 1.0, regions.STUCK_BACK),
    (0.0, 1.5, regions.STUCK_ON),  # on the cut
    (1.0, 1.75, regions.STUCK_ON),
    (0.5, 1.62, regions.STUCK_BACK),
    (0.5, 2.5, regions.STUCK_ON),
    (2.0, 1.0, regions.SLIP_LONG),  # psi1 = 2 chi
    (2.0001, 1.0, regions.SLIP_LATE),
    (2.9999, 1.0, regions.SLIP_LATE),
    (3.0, 1.0, None),  # psi1 = 4 chi - 1
    (1.5, 0.25, None),
    (1.0001, 0.5, None),
    (1.0 + 0.8**5 * 2.0 * 0.999, 1.5, regions.SLIP_BACK),
    (1.0 + 0.8**5 * 2.0 * 1.001, 1.5, regions.SLIP_LONG),
    (1.0 + 2.0**-5 * 3.031249, 2.015625, regions.SLIP_ON),
    (1.0 + 2.0**-5 * 3.03124, 2.01562, regions.SLIP_BACK),
    (1.0000001, 1.9, regions.SLIP_BACK),
]


def test_places_of_many_impacts_are_those_of_each():
    speed, chi = np.array([row[:2] for row in BORDERS]).T
    many = places(speed, chi, CUTS)
    found = {int(who): k for k, who in enumerate(many.who)}
    for number, (one, other, region) in enumerate(BORDERS):
        alone = place(one, other, SINGLE)
        if region is None:
            assert alone is None
            assert number not in found
            continue
        assert alone[0] == region
        k = found[number]
        assert many.region[k] == region
        together = many.a[k], many.b[k], many.measure[k]
        assert together == pytest.approx(alone[1:], abs=1e-9)
        assert (many.speed[k], many.chi[k]) == (one, other)
        assert min(alone[1:3]) >= -1e-12
        assert max(alone[1:3]) <= 1.0 + 1e-12


@pytest.mark.parametrize("psi1", [0.3, -0.3, 0.0, 5.0, -5.0])
@pytest.mark.parametrize("count", [39, 40, 41])
def test_few_and_many_impacts_agree_in_value_and_sign(psi1, count):
    """The table's own: from 40 on together."""
    chi = np.linspace(0.1, 2.4, count)
    found = elastic.rebound(np.full(count, psi1), chi)
    single = [elastic.rebound(psi1, each) for each in chi.tolist()]
    assert found == pytest.approx(single, abs=2e-12)


@pytest.mark.parametrize("e", [0.5, 0.899, 0.901, 0.9999])
@pytest.mark.parametrize("count", [11, 12])
def test_few_and_many_damped_impacts_agree(e, count):
    psi1, chi = np.linspace(0.1, 8.0, count), np.linspace(0.8, 1.8, count)
    found = damped.rebound(psi1, chi, e)
    ours = damped.section(e)
    single = [damped.single(p, x, e, ours) for p, x in zip(psi1, chi, strict=True)]
    assert found == pytest.approx(single, abs=1e-13)
    assert (damped.rebound(-psi1, chi, e) == -found).all()


def test_a_file_tells_its_version_and_day(tmp_path):
    stored = Stored.today(b=[1.0, 2.0], a=np.array([3], dtype=np.int16))
    assert stored.version == metadata.version("contactlab")
    assert stored.built == datetime.now(UTC).date().isoformat()
    digest = hashlib.sha256(f"3 {stored.version} {stored.built}".encode())
    digest.update(b"a <i2 (1,)" + np.array([3], dtype="<i2").tobytes())
    digest.update(b"b <f8 (2,)" + np.array([1.0, 2.0]).tobytes())
    assert stored.checksum() == digest.hexdigest()
    write(tmp_path / "t.npz", stored)
    again = read(tmp_path / "t.npz")
    assert (again.version, again.built) == (stored.version, stored.built)
    assert {name: each.tolist() for name, each in again.arrays.items()} == {"a": [3], "b": [1, 2]}


@pytest.mark.parametrize("changed", [{"format": 2}, {"version": "0"}, {"built": "1999-01-01"}])
def test_a_file_whose_head_was_changed_is_refused(changed, tmp_path):
    path = tmp_path / "t.npz"
    write(path, Stored.today(a=[1.0]))
    with np.load(path) as file:
        content = {name: file[name] for name in file.files}
    np.savez(path, **{**content, **changed})
    with pytest.raises(ValueError) as told:  # noqa: PT011
        read(path)
    assert str(told.value) == (
        f"{path}: no table that can be trusted (the checksum does not fit); install contactlab "
        "anew, or build the table: python -m table_builders"
    )
