"""The readers of tables by parts: polynomials three ways, places on every border, refused files."""

import hashlib
from datetime import UTC, datetime
from importlib import metadata

import numpy as np
import pytest
from numpy.polynomial.polynomial import polyval

from contactlab_laws.tables import damped, elastic
from contactlab_laws.tables.file import Stored, read, write
from contactlab_laws.tables.patches import (
    compiled_polynomial,
    polynomial,
    powers,
)

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
