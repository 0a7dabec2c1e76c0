"""Exact impacts for the builder of the elastic table, and which of them are solved alone."""

import numpy as np
import pytest

from table_builders.elastic import exact


@pytest.mark.parametrize(
    ("off_psi1", "off_chi", "solved"),
    [
        ([0.0], [0.0], 0),
        ([5e-4, 9e-4], [-2e-4, 0.0], 6),
        ([2**-10, 0.0, -2.0], [0.0, -(2**-11), 0.3], 3),  # just so far, and farther
        ([0.0, 5e-4, 0.5], [0.0, 1e-4, 0.2], 4),
    ],
)
def test_near_the_corner_answers_are_extrapolated(off_psi1, off_chi, solved, monkeypatch):
    """With psi1 (-1 + d h), h of second order in d while the ratio of the distances is kept."""
    psi1, chi = 1.0 + np.array(off_psi1), 0.5 + np.array(off_chi)
    calls = []

    def law(psi1, chi):
        u, v = psi1 - 1.0, 2.0 * chi - 1.0
        return psi1 * (-1.0 + 2.0 * u - v + 30.0 * u * v + 1e4 * u**3)

    def alone(psi1, chi):
        calls.append(psi1)
        return law(psi1, chi)

    monkeypatch.setattr(exact, "CORNER", 2**-10)
    monkeypatch.setattr(exact, "alone", alone)
    assert exact.exact(psi1, chi) == pytest.approx(law(psi1, chi), abs=1e-14)
    assert sum(each.size for each in calls) == solved


@pytest.mark.parametrize(
    ("psi1", "chi", "alone", "together"),
    [
        ([0.5, 2.0], [1.0, 1.5], [], [0.5, 2.0]),
        ([1.0 - 5e-6, 1.0 + 5e-6, 3.0], [1.0, 1.5, 0.509], [1.0 - 5e-6, 1.0 + 5e-6, 3.0], []),
        ([1.0 - 2e-5, 1.0, 0.3], [1.0, 1.5, 0.489], [1.0], [1.0 - 2e-5, 0.3]),
    ],
)
def test_impacts_next_to_singular_curves_are_solved_alone(psi1, chi, alone, together, monkeypatch):
    told = {"alone": [], "together": []}

    def solved(psi1, chi):
        told["alone"] += psi1.tolist()
        return psi1 - chi

    class Law:
        def __init__(self, tolerance):
            assert tolerance == 1e-9

        def sweep(self, scene):
            told["together"] += scene.psi1.tolist()
            self.psi2 = scene.psi1 - scene.chi
            return self

        def check(self):
            return self

    monkeypatch.setattr(exact, "exact", solved)
    monkeypatch.setattr(exact, "_law", Law)
    psi1, chi = np.array(psi1), np.array(chi)
    assert exact.together(psi1, chi) == pytest.approx(psi1 - chi, abs=1e-15)
    assert told == {"alone": alone, "together": together}


@pytest.mark.parametrize(("psi1", "sign"), [(8.0, 1), (0.3, -1)])
def test_the_sign_of_the_last_slip(psi1, sign):
    """Slip throughout ends as it began; at chi = 1 an impact that sticks first ends backward."""
    assert exact.last_slip(psi1, 1.0) == sign


def test_impacts_alone_of_two_closed_forms():
    found = exact.alone(np.array([8.0, 0.6]), np.array([1.5, 0.5]))
    assert found == pytest.approx([2.0, -0.6], abs=1e-12)
