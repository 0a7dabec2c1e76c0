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


def test_verifying_draws_tells_and_judges(monkeypatch, capsys):
    """By few rings, which are off by less than the table declares."""
    monkeypatch.setattr(checks, "RINGS", 32)
    assert [checks.verify(24, seed) for seed in (1, 2)] == [0, 0]
    lines = capsys.readouterr().out.splitlines()
    assert lines[1:14] != lines[15:]
    stored = read(SHIPPED)
    begin = stored.checksum()[:12]
    assert lines[0] == f"{SHIPPED}: contactlab {stored.version}, {stored.built}, {begin}"
    numbers = [list(map(float, re.findall(r"(?<= )\d[\d.e-]*\d", line))) for line in lines[1:13]]
    e, largest, psi1, chi, rms = np.transpose(numbers)
    assert ((e >= 0.5) & (e < 1.0) & (psi1 <= 9.0) & (chi >= 0.8) & (chi <= 1.8)).all()
    assert (e[::3] >= 0.9).all()
    assert ((rms <= largest) & (largest <= 1.5 * rms)).all()
    assert lines[13] == f"largest {largest.max():.1e}, declared {DAMPED_ERROR:.0e}"


def test_the_fastest_run_counts(monkeypatch, capsys):
    """Five runs of ten impacts each take 7, 3, 5, 2 and 4 ms."""
    clock = iter(np.cumsum([1.0, 7e-3, 1.0, 3e-3, 1.0, 5e-3, 1.0, 2e-3, 1.0, 4e-3]).tolist())
    monkeypatch.setattr(time, "process_time", lambda: next(clock))
    monkeypatch.setattr(checks, "TIMED", 10)
    assert checks.bench() == 0
    assert capsys.readouterr().out == "10 impacts: 200000 ns of processor time each\n"


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
