"""``contactlab.rebound``: many impacts at once against the exact solution of each."""

import subprocess
import sys

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation, rebound
from tests.laws.reference import PSI1, PSI2, TABLE
from tests.longer import longer

TOLERANCE = 1e-5


def exact(psi1, chi):
    psi1, chi = np.broadcast_arrays(np.asarray(psi1, float), np.asarray(chi, float))
    integrator = contactlab.create("integrator.events", tolerance=1e-9)
    fronts = contactlab.create("tangential.fronts", table=False)
    law = Simulation(tangential=fronts, integrator=integrator)
    return law.run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi2


def sample(low, high, count, seed):
    """Half of the impacts over the whole range of incidence, half where most of them stick."""
    rng = np.random.default_rng(seed)
    chi = rng.uniform(low, high, count)
    most = np.where(np.arange(count) % 2, 1.5, 4.0 * chi + 1.0)
    return rng.uniform(0.0, most), chi


@pytest.mark.parametrize(("chi", "psi1", "value"), TABLE)
def test_reference_table(chi, psi1, value):
    """Theory §5."""
    assert rebound(psi1, chi) == pytest.approx(value, abs=1e-6)
    assert rebound(psi1, chi, tolerance=1e-9) == pytest.approx(value, abs=1e-9)


@pytest.mark.parametrize(
    ("low", "high", "count"),
    [
        (0.05, 0.6, 100),
        (0.35, 4.0, 50),
        (0.35, 8.0, 50),
        (8, 30, 20),
        *longer((0.35, 8.0, 400)),
    ],
)
def test_random_impacts_against_the_exact_solution(low, high, count):
    psi1, chi = sample(low, high, count, seed=11)
    error = np.abs(rebound(psi1, chi) - exact(psi1, chi)) / np.maximum(1.0, psi1)
    assert error.max() < TOLERANCE
    assert np.sqrt(np.mean(error**2)) < 0.1 * TOLERANCE


def test_a_tighter_tolerance_is_kept():
    psi1, chi = sample(0.35, 8.0, 40, seed=12)
    truth = exact(psi1, chi)
    loose, tight = (np.abs(rebound(psi1, chi, tolerance=t) - truth).max() for t in (1e-4, 1e-6))
    assert tight < 1e-6
    assert loose < 1e-4
    one_by_one = rebound(psi1[:20], chi[:20], tolerance=1e-9)
    assert np.abs(one_by_one - truth[:20]).max() < 2e-9


BOTH_SIDES = (0.3, 0.5, 0.5 + 1e-9, 0.7, 1.0, 1.44, 3.0, *longer(8.0))


@pytest.mark.parametrize("chi", BOTH_SIDES)
def test_both_sides_of_every_boundary(chi):
    borders = np.array([1.0, max(1.0, 4.0 * chi - 1.0), 2.0 * chi, abs(2.0 * chi - 1.0) + 0.5])
    steps = np.array([0.0, 1e-12, 1e-9, 1e-6, 1e-4])
    psi1 = (borders[:, None] + np.concatenate((steps, -steps))).ravel()
    assert np.abs(rebound(psi1, chi) - exact(psi1, chi)).max() < TOLERANCE


LARGE = [(100.0, 0.3), (100.0, 1.2), *longer((1000.0, 0.95)), (1e4, 0.6)]


@pytest.mark.parametrize(("chi", "psi1"), LARGE)
def test_large_chi(chi, psi1):
    assert rebound(psi1, chi) == pytest.approx(float(exact(psi1, chi)), abs=TOLERANCE)


@pytest.mark.slow
def test_odd_to_the_last_bit():
    psi1, chi = sample(0.2, 10.0, 500, seed=13)
    assert np.array_equal(rebound(-psi1, chi), -rebound(psi1, chi))
    assert rebound(0.0, 1.0) == 0.0


def test_limits():
    assert rebound(1e-300, 1.4411764705882353) == pytest.approx(0.231692e-300, rel=1e-4, abs=0.0)
    assert rebound(1e300, 2.0) == 1e300
    assert rebound(2.0**60, 512.0) == 2.0**60 - 2048.0  # full slip, to the last bit
    assert rebound(0.9, 1e-12) == pytest.approx(0.9, abs=1e-11)
    assert rebound(0.6, 0.5) == -0.6  # balanced: nothing slips


@pytest.mark.slow
def test_invariants():
    psi1, chi = sample(0.05, 20.0, 2000, seed=14)
    psi2 = rebound(psi1, chi)
    assert np.all(np.abs(psi2) <= psi1)
    assert np.all(np.abs(psi2 - psi1) <= 4.0 * chi * (1.0 + 1e-15))


@pytest.mark.slow
def test_answers_hardly_depend_on_the_batch():
    psi1, chi = sample(0.35, 8.0, 400, seed=15)
    whole = rebound(psi1, chi)
    shuffled = np.random.default_rng(1).permutation(psi1.size)
    bound = 1e-10 * np.maximum(1.0, psi1)
    assert (
        np.abs(rebound(psi1[shuffled], chi[shuffled]) - whole[shuffled]) < bound[shuffled]
    ).all()
    for few in range(0, 400, 50):
        five = slice(few, few + 5)
        assert (np.abs(rebound(psi1[five], chi[five]) - whole[five]) < bound[five]).all()


def test_shapes():
    table = rebound(np.array(PSI1), np.array(list(PSI2))[:, None])
    assert table.shape == (len(PSI2), len(PSI1))
    assert np.abs(table - np.array(list(PSI2.values()))).max() < 1e-6
    assert type(rebound(1, 1)) is float
    assert rebound(np.array([0.5]), 1.0).shape == (1,)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ({"psi1": np.nan, "chi": 1.0}, "psi1"),
        ({"psi1": 1.0, "chi": 0.0}, "chi"),
        ({"psi1": 1.0, "chi": 1e5}, "1e4"),
        ({"psi1": [1.0, 2.0], "chi": [1.0, 2.0, 3.0]}, "shapes"),
        ({"psi1": 1.0, "chi": 1.0, "tolerance": 1e-12}, "tolerance"),
        ({"psi1": 1.0, "chi": 1.0, "tolerance": [1e-5, 1e-5]}, "tolerance"),
    ],
)
def test_refusals(arguments, word):
    with pytest.raises(ValueError, match=word):
        rebound(**arguments)


def test_no_law_is_loaded_before_it_is_called():
    probe = (
        "import sys, contactlab; contactlab.rebound; "
        "assert not [m for m in sys.modules if m.startswith(('contactlab_', 'scipy'))]"
    )
    subprocess.run([sys.executable, "-c", probe], check=True)


def test_derivatives_follow_what_was_given_and_not_which_number_it_is():
    """Left out, None: three numbers; a restitution, of whatever object: four."""
    for left_out in ({}, {"restitution": None}):
        assert len(rebound(1.2, 1.44, derivatives=True, **left_out)) == 3
    for e in (1.0, 1, float("1"), np.float64(1.0), 0.8, np.array([1.0])):
        assert len(rebound(1.2, 1.44, derivatives=True, restitution=e)) == 4
        assert len(rebound(np.empty(0), 1.44, derivatives=True, restitution=1.0)) == 4
