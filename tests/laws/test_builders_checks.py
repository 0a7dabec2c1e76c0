"""Verifying, timing and measuring the table with a restitution: numbers drawn, and all texts."""

import re
import time

import numpy as np
import pytest

from contactlab import create
from contactlab.compose.rebound import DAMPED_ERROR
from contactlab_laws.tables.damped import SHIPPED
from contactlab_laws.tables.file import read
from table_builders.damped import checks, differences


def test_impacts_by_rings_keep_their_shape(monkeypatch):
    def rings(psi1, chi, e, *, counts):
        assert counts == (64, 96, 128)
        return e + psi1 - 3.0 * chi

    monkeypatch.setattr(checks, "by_rings", rings)
    found = checks.solve(np.array([[1.0], [2.0]]), np.array([0.0, 1.0, 2.0]), 5.0)
    assert found.tolist() == [[6.0, 3.0, 0.0], [7.0, 4.0, 1.0]]


@pytest.mark.parametrize(
    ("largest", "answer", "said"),
    [(DAMPED_ERROR, 0, "1.0e-03"), (1.5 * DAMPED_ERROR, 1, "1.5e-03")],
)
def test_verifying_draws_tells_and_judges(largest, answer, said, monkeypatch, capsys):
    """The table is right but for each fourth impact of a batch, and worst in the third batch."""
    drawn = []

    def off(psi1, chi, e):
        drawn.append((psi1, chi, e))
        error = np.zeros(psi1.shape)
        error[3::4] = -0.5 * largest
        error[3] = -largest if len(drawn) == 3 else error[3]
        return error

    monkeypatch.setattr(checks, "rebound", off)
    monkeypatch.setattr(checks, "solve", lambda *of: np.zeros(of[0].shape))
    assert checks.verify(100, 5) == answer
    lines = capsys.readouterr().out.splitlines()
    stored = read(SHIPPED)
    begin = stored.checksum()[:12]
    assert lines[0] == f"{SHIPPED}: contactlab {stored.version}, {stored.built}, {begin}"
    assert lines[-1] == f"largest {said}, declared 1e-03"
    assert len(lines) == 14
    for number, (line, (psi1, chi, e)) in enumerate(zip(lines[1:-1], drawn, strict=True)):
        worst = largest if number == 2 else 0.5 * largest
        rms = np.sqrt((worst**2 + 0.25 * largest**2) / 8)
        assert line == (
            f"e = {e:.6f}: largest {worst:.1e} at psi1 = {psi1[3]:.4f}, chi = {chi[3]:.4f}; "
            f"rms {rms:.1e}"
        )
        assert psi1.shape == chi.shape == (8,)
        assert 1e-5 <= 1.0 - e <= (0.1 if number % 3 == 0 else 0.5)
    psi1, chi = (np.concatenate(each) for each in list(zip(*drawn, strict=True))[:2])
    assert 0.0 <= psi1.min() < 0.5 < 8.5 < psi1.max() <= 9.0
    assert 0.8 <= chi.min() < 0.9 < 1.7 < chi.max() <= 1.8
    assert min(e for *_, e in drawn) < 0.7
    near = np.log10([1.0 - e for *_, e in drawn[::3]])
    assert near.min() < -3.0


def test_a_batch_has_one_impact_at_least_and_another_seed_others(monkeypatch, capsys):
    drawn = []
    monkeypatch.setattr(checks, "rebound", lambda *of: drawn.append(of[0]) or of[0])
    monkeypatch.setattr(checks, "solve", lambda *of: of[0])
    for seed in (1, 1, 2):
        assert checks.verify(7, seed) == 0
    assert [each.size for each in drawn] == [1] * 36
    assert drawn[:12] == drawn[12:24] != drawn[24:]
    assert capsys.readouterr().out.count("largest 0.0e+00, declared 1e-03") == 3


def test_the_fastest_run_counts(monkeypatch, capsys):
    """Five runs of ten impacts each take 7, 3, 5, 2 and 4 ms."""
    clock = iter(np.cumsum([1.0, 7e-3, 1.0, 3e-3, 1.0, 5e-3, 1.0, 2e-3, 1.0, 4e-3]).tolist())
    monkeypatch.setattr(time, "process_time", lambda: next(clock))
    monkeypatch.setattr(checks, "TIMED", 10)
    drawn = []
    monkeypatch.setattr(checks, "rebound", lambda psi1, chi, e: drawn.append((psi1, chi, e)))
    assert checks.bench() == 0
    assert capsys.readouterr().out == "10 impacts: 200000 ns of processor time each\n"
    psi1, chi, e = drawn[0]
    assert (psi1.size, chi.size, e, len(drawn)) == (10, 10, 0.9, 5)
    assert ((psi1 >= 0.0) & (psi1 <= 9.0) & (chi >= 0.8) & (chi <= 1.8)).all()
    assert psi1.max() > 4.5
    assert np.ptp(chi) > 0.5


def test_the_impacts_of_the_differences():
    """24 of each chi from 0.2 up to slip throughout and 1 more, then 24 between 0.7 and 2."""
    psi1, chi = (each.reshape(48, 6) for each in differences.impacts(0.5))
    assert (chi == [0.8, 1.0, 1.2, 49 / 34, 1.6, 1.8]).all()
    assert (psi1[0] == 0.2).all()
    assert psi1[23] == pytest.approx(3.0 * chi[0] + 1.0)
    assert np.diff(psi1[:24], axis=0) == pytest.approx(np.tile((3 * chi[0] + 0.8) / 23, (23, 1)))
    assert psi1[24:] == pytest.approx(np.linspace(0.7, 2.0, 24)[:, None] + np.zeros(6))


def test_springs_are_extrapolated_in_their_number(monkeypatch):
    """Gross slip is exact with any number; at psi1 = 1.2 few springs come near many."""
    law = create("normal.tsuji", restitution=0.9)
    psi1, chi = np.array([9.0, 1.2]), np.array([1.0, 1.4])
    monkeypatch.setattr(differences, "SPRINGS", 16)
    few = differences.springs(law, psi1, chi)
    assert few[0] == pytest.approx(9.0 - 2.0 * 1.9, abs=2e-3)
    asked = []

    class Told:
        def __init__(self, *, normal, tangential, integrator):
            asked.append((normal, tangential.springs, integrator.steps))

        def sweep(self, scene):
            assert (scene.psi1.tolist(), scene.chi.tolist()) == ([9.0, 1.2], [1.0, 1.4])
            return self

        def check(self):
            self.psi2 = np.array([2.0, 5.0]) + 7.0 / asked[-1][1] ** 2
            return self

    monkeypatch.setattr(differences, "Simulation", Told)
    assert differences.springs(law, psi1, chi) == pytest.approx([2.0, 5.0])
    assert asked == [(law, 8, 32), (law, 16, 64)]


def test_both_sides_are_the_half_space_with_the_motion_of_a_law(monkeypatch):
    def followed(motion, psi1, chi):
        return -float(motion.final_rate) + 0.0 * psi1

    monkeypatch.setattr(differences, "by_half_space", followed)
    found = differences.tsuji.__wrapped__(0.75)
    assert found.shape == (288,)
    assert found == pytest.approx(0.75, abs=1e-9)


def test_the_laws_that_are_measured():
    told = [repr(law) for law in differences.laws()]
    names = [re.match(r"\w+", each)[0] for each in told]
    calibrated = ["Tsuji", "HuntCrossley", "KuwabaraKono", "Linear", "WaltonBraun"]
    others = ["Thornton"] * 5 + ["JohnsonKendallRoberts"] * 3 + ["DerjaguinMullerToporov"] * 2
    assert names == [name for name in calibrated for _ in range(11)] + others
    values = [float(re.search(r"restitution=([\d.e-]+)", each)[1]) for each in told[:55]]
    assert values == 5 * [1.0, 0.99, 0.95, 0.9, 0.8, 0.65, 0.5, 0.4, 0.3, 0.2, 0.1]
    values = [float(re.search(r"(?:velocity|adhesion)=([\d.e-]+)", each)[1]) for each in told[55:]]
    assert values == [0.6, 0.3, 0.1, 0.03, 0.01, 0.001, 0.01, 0.05, 0.01, 0.05]
