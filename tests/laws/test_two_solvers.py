"""Two solvers with nothing in common agree: the slip front, and springs with Richardson's rule."""

import numpy as np

from contactlab import Scene, Simulation
from tests.laws.bundle import extrapolated


def sample(count, seed, largest):
    rng = np.random.default_rng(seed)
    chi = np.exp(rng.uniform(np.log(0.35), np.log(largest), count))
    psi1 = rng.uniform(0.0, 1.0, count) ** 1.5 * np.maximum(4.0 * chi - 1.0, 1.0) * 1.03
    return psi1, chi


def test_front_and_springs_agree_over_a_random_sample():
    psi1, chi = sample(60, 3, 10.0)
    ours = Simulation().run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2
    springs, _, guess = extrapolated(psi1, chi, 300, 900)
    difference = np.abs(ours - springs)
    assert np.median(difference) < 1e-6
    # the springs' own error is the larger by far: it is what their two resolutions differ by
    assert (difference < 2.0 * guess + 1e-6).all()
    assert difference.max() < 1e-3


def test_they_come_together_as_the_springs_are_refined():
    psi1, chi = sample(12, 8, 5.0)
    ours = Simulation().run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2
    errors = [
        np.sqrt(np.mean((extrapolated(psi1, chi, n, 3 * n)[0] - ours) ** 2)) for n in (60, 120, 240)
    ]
    assert errors[2] < errors[0] / 4.0
    assert errors[2] < 1e-5
