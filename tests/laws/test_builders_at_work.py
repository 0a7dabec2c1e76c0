"""The builder of the elastic table at work: processes, progress, draws and the bench."""

import itertools

import numpy as np
import pytest

from contactlab_laws.tables.elastic import shipped
from contactlab_laws.tables.patches import polynomial
from contactlab_laws.tables.regions import slip_cut
from table_builders.elastic import bench, build, verify


class Pool:
    """An executor that works at once."""

    used: list[int]

    def __init__(self, workers):
        self.used.append(workers)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    map = staticmethod(map)


@pytest.fixture
def pools(monkeypatch):
    monkeypatch.setattr(Pool, "used", [], raising=False)
    for place in (build, verify):
        monkeypatch.setattr(place, "ProcessPoolExecutor", Pool)
    return Pool.used


def test_several_processes_give_the_same_answers_in_order(pools, monkeypatch):
    sizes = []

    def noted(psi1, chi):
        sizes.append(psi1.size)
        return psi1 - 2.0 * chi

    monkeypatch.setattr(build, "exact", noted)
    psi1, chi = np.arange(100.0), np.ones(100)
    assert (build._shared(map, 3, psi1, chi) == psi1 - 2.0).all()
    assert (len(sizes), sum(sizes), max(sizes)) == (24, 100, 5)


def test_a_build_by_several_processes_tells_what_is_left(pools, monkeypatch, tmp_path, capsys):
    """A table so coarse that each region is one patch, and one so fine that none is good."""
    made = shipped()
    clock = itertools.count(100.0, 10.0)
    monkeypatch.setattr(build.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(build, "BATCH", 4)
    monkeypatch.setattr(build.curves, "find", lambda: made.cuts)
    monkeypatch.setattr(build, "exact", lambda psi1, chi: 0.5 * psi1 - chi)
    for workers in (1, 2):
        build.build(tmp_path / "coarse.npz", tolerance=1e9, workers=workers)
        assert capsys.readouterr().err.splitlines() == [
            "finding the cuts",
            "4 patches, 50.0 %, 10 s left",
            "8 patches, 100.0 %, 0 s left",
        ]
    assert pools == [2]
    monkeypatch.setattr(build, "DEEPEST", 0)
    build.build(tmp_path / "fine.npz", tolerance=0.0)
    told = capsys.readouterr().err
    assert told.count("is left at ") == 8
    assert "Cell(region=7, level_a=0, level_b=0, i=0, j=0) is left at" in told


def test_fresh_impacts_are_shared_out_and_reported(pools, monkeypatch, capsys):
    made = shipped()
    truth = verify.values(made, *(draws := verify.draw(25, 3, made.cuts))[:2])
    known = dict(zip(draws.psi1.tolist(), truth.tolist(), strict=True))
    clock = itertools.count(0.0, 6.0)
    monkeypatch.setattr(verify.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(verify, "BATCH", 10)
    for name, error in (("exact", 1e-3), ("together", 2e-3)):
        monkeypatch.setattr(
            verify,
            name,
            lambda psi1, _, error=error: np.array([known[p] for p in psi1.tolist()]) + error,
        )
    rows = verify.verify(made, count=25, seed=3)
    assert capsys.readouterr().err.splitlines() == [
        "10 impacts, 12 s left",
        "20 impacts, 6 s left",
        "25 impacts, 0 s left",
    ]
    assert not pools
    again = verify.verify(made, count=25, seed=3, workers=2, alone=True)
    assert pools == [2]
    for row, error in ((rows[-1], 2e-3), (again[-1], 1e-3)):
        assert (row.name, row.draws) == ("all", 25)
        assert row.largest == pytest.approx(error)


def test_draws_beside_each_curve():
    """No further than 0.01, most of them much nearer, of both sides where there are two."""
    made = shipped()
    psi1, chi, kind = verify.draw(30_000, 8, made.cuts)
    assert ((kind >= 0) == (np.arange(30_000) % 3 == 2))[kind >= 0].all()
    assert (kind[np.arange(30_000) % 3 != 2] == -1).all()
    assert (chi > 0.0).all()
    assert (chi <= 2.5).all()
    assert (psi1 >= 0.0).all()
    with np.errstate(invalid="ignore", divide="ignore"):
        t = ((psi1 - 1.0) / (2.0 * chi - 1.0)) ** 0.2
    curves = (
        psi1 - 1.0,
        np.where(4.0 * chi > 1.0, psi1 - 4.0 * chi + 1.0, 0.0),
        chi - 0.5,
        np.maximum(np.abs(psi1 - 1.0), np.abs(chi - 0.5)) * np.sign(psi1 - 1.0),
        chi - polynomial(made.cuts.stuck, psi1),
        chi - slip_cut(made.cuts.slip, t),
        psi1 - 2.0 * chi,
        psi1,
        chi - 2.5,
    )
    for number, off in enumerate(curves):
        beside = off[kind == number]
        assert beside.size == pytest.approx(10_000 / 9, rel=0.1)
        assert 0.005 < np.abs(beside).max() < 0.0101
        assert np.median(np.abs(beside)) < 1e-6
        assert {-1.0, 1.0} - set(np.sign(beside)) == (
            {-1.0} if number == 7 else {1.0} if number == 8 else set()
        )
        assert np.mean(np.abs(beside) < 2e-16) < 0.2
    sticking = np.arange(30_000) % 3 == 1
    assert 1.45 < psi1[sticking].max() <= 1.5
    assert np.mean(psi1[sticking] < 0.75) == pytest.approx(0.5, abs=0.02)


def test_the_time_of_impacts_is_that_of_the_fastest_call(monkeypatch):
    clock = iter(np.cumsum([1.0, 5.0, 1.0, 2.0, 1.0, 3.0]).tolist())
    monkeypatch.setattr(bench, "process_time", lambda: next(clock))
    calls = []
    assert bench._least(lambda: calls.append(1), 3) == pytest.approx(2.0)
    assert len(calls) == 3


def test_the_rows_of_the_bench(monkeypatch):
    """Each call is made once and takes 2 ms."""
    asked = []

    def least(call, repeats=15):
        asked.append(repeats)
        call()
        return 2e-3

    monkeypatch.setattr(bench, "_least", least)
    monkeypatch.setattr(bench, "SIZES", (50, 100))
    monkeypatch.setattr(bench, "SINGLES", 10)
    assert bench.bench() == [
        ("50 together", pytest.approx(4e4)),
        ("100 together", pytest.approx(2e4)),
        ("100 with derivatives", pytest.approx(2e4)),
        ("100 products in NumPy", pytest.approx(2e4)),
        ("100 in a sweep", pytest.approx(2e4)),
        ("100 collisions in space", pytest.approx(2e4)),
        ("one at a time", pytest.approx(2e5)),
    ]
    assert asked == [15, 15, 15, 15, 4, 4, 15]


def test_the_impacts_of_the_bench():
    psi1, chi = bench.mixed(2000)
    assert 0.0 < chi.min() < 0.05 < 2.45 < chi.max() < 2.5
    most = 1.05 * np.maximum(1.0, 4.0 * chi - 1.0)
    assert 0.95 < (psi1 / most).max() < 1.0
    assert np.mean(psi1 / most) == pytest.approx(0.5, abs=0.03)
    made = bench.unlike(2000)
    approach = ((made.velocity - made.target_velocity) * made.normal).sum(axis=-1)
    assert (approach > 0.0).all()
    assert made.friction_coefficient == 0.2
    for body, modulus in ((made.body, 208e9), (made.target, 70e9)):
        assert 1e-3 < np.min(body.radius) < 1.1e-3 < 9.9e-3 < np.max(body.radius) < 1e-2
        assert body.material.young_modulus == modulus
    for spin in (made.spin, made.target_spin):
        assert np.std(spin) == pytest.approx(300.0, rel=0.05)
