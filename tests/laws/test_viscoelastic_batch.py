"""Springs that lose in pressure and shear: a relaxation time for each impact, or one for all."""

import numpy as np
import pytest

from contactlab_laws.viscoelastic.batch import extrapolate_steps, rebound
from contactlab_laws.viscoelastic.motion import course
from contactlab_laws.viscoelastic.relaxation import restitution_of
from tests.laws.test_restituted_table import PSI1, REFERENCES, SINGLES


def test_values_of_another_program():
    psi1 = np.tile(PSI1, len(REFERENCES))
    a, chi = np.repeat(list(REFERENCES), len(PSI1), axis=0).T
    found = extrapolate_steps(psi1, chi, a, springs=40, steps=400)
    assert found == pytest.approx(np.concatenate([*REFERENCES.values()]), abs=4e-4)


@pytest.mark.slow
def test_each_its_own_relaxation_time():
    psi1, chi, a, psi2 = np.array(SINGLES).T
    found = extrapolate_steps(psi1, chi, a, springs=60, steps=480)
    assert found == pytest.approx(psi2, abs=1e-4)
    alone = [
        extrapolate_steps(psi1[k : k + 1], chi[k : k + 1], float(a[k]), springs=60, steps=480)[0]
        for k in range(4)
    ]
    assert found == pytest.approx(alone, abs=1e-12)


def test_second_order():
    psi1, chi, a, psi2 = np.array(SINGLES).T
    counts = (25, 50, 100)
    off = [np.abs(rebound(psi1, chi, a, springs=n, steps=8 * n) - psi2).max() for n in counts]
    assert -np.polyfit(np.log(counts), np.log(off), 1)[0] > 1.7


@pytest.mark.parametrize("e_of", [0.05, 1.0])
def test_slip_throughout_at_any_number_of_springs(e_of):
    e, chi = restitution_of(e_of), np.array([0.4, 1.0, 2.0])
    psi1 = np.maximum(1.0, 2.0 * chi * (1.0 + e) - e) + 0.1
    found = rebound(psi1, chi, e_of, springs=6, steps=400)
    assert found == pytest.approx(psi1 - 2.0 * chi * (1.0 + e), abs=1e-8)


def test_the_motion_ends_at_the_restitution():
    a = np.array([1e-9, 0.01, 0.4, 3.0])
    path = course(a, 200)
    assert -path.rate[-1] == pytest.approx(restitution_of(a), abs=2e-8)
    assert (path.radius[-1] == 0.0).all()
    assert path.duration.sum(axis=0)[0] == pytest.approx(2.943, abs=1e-3)  # Hertz's


@pytest.mark.slow
def test_a_stiff_impact_settles():
    """chi = 300 at strong loss: psi follows the springs, and does not ring."""
    chi, psi1 = np.full(3, 300.0), np.array([0.5, 10.0, 250.0])
    coarse, fine = (rebound(psi1, chi, 1.0, springs=20, steps=steps) for steps in (2000, 6000))
    assert coarse == pytest.approx(fine, abs=2e-3)
