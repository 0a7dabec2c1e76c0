"""e_t over friction turns: two frictions may meet the data, and intervals are then profiles."""

import re

import numpy as np
import pytest
from scipy.special import stdtrit

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, fit
from contactlab_fit import tabulated
from tests.fitting.impacts import BODIES as IMPACTS
from tests.fitting.impacts import restitution, table
from tests.longer import longer

STEEL = Material.named("steel")
BALL = Sphere(0.01, STEEL), HalfSpace(STEEL)
BODIES = Scene(*BALL, friction_coefficient=0.1, normal_speed=1.0)
SPEED, NOISE = 3.9, 0.002
TOLD = re.compile(r"friction_coefficient ([\d.]+) \(95 % ([\d.]+) to ([\d.]+)\)")


def measured(friction, angle, noise):
    """Return impacts at one angle: e_t with noise, a number an impact."""
    count, radians = len(noise), np.radians(angle)
    scene = Scene(*BALL, friction, np.full(count, SPEED * np.cos(radians)), SPEED * np.sin(radians))
    e_t = tabulated.impacts(scene, None).tangential_restitution + noise
    return {"angle_deg": np.full(count, angle), "speed (m/s)": np.full(count, SPEED),
            "tangential_restitution": e_t}  # fmt: skip


def told(impacts, simulation=None):
    """Return the intervals of friction that a fit tells, as its answer or in its refusal."""
    try:
        return [
            fit(impacts, BODIES, simulation=simulation).parameters["friction_coefficient"].interval
        ]
    except ValueError as error:
        return [(float(low), float(high)) for _, low, high in TOLD.findall(str(error))]


def is_told(seed):
    """Return whether the truth of a random set is in what a fit tells: refusals count as told."""
    generator = np.random.default_rng([7, seed])
    angle = generator.uniform(15.0, 60.0)
    count, friction = int(generator.integers(4, 12)), generator.uniform(0.08, 0.5)
    intervals = told(measured(friction, angle, NOISE * generator.standard_normal(count)))
    return len(intervals) > 1 or any(low <= friction <= high for low, high in intervals)


@pytest.mark.parametrize("seed", [17, *longer(22, 44, 52, 55)])
def test_of_sets_at_one_angle_the_truth_is_told(seed):
    """Without a scan over friction four would tell another one alone, and one nothing."""
    assert is_told(seed)


@pytest.mark.slow
def test_of_two_hundred_sets_at_one_angle_the_truth_is_told():
    """A 95 % interval misses in one of twenty: 10 of 200, and 12 with their scatter."""
    assert sum(not is_told(seed) for seed in range(200)) <= 12


@pytest.mark.parametrize("laws", [None, *longer({"tangential": "annulus"})])
def test_both_frictions_are_told_with_their_intervals(laws):
    noise = NOISE * np.random.default_rng(1).standard_normal(8)
    impacts = measured(0.2, 30.0, noise)
    intervals = told(impacts, laws and Simulation(**laws))
    assert any(low <= 0.2 <= high for low, high in intervals)
    middles = [0.5 * (low + high) for low, high in intervals]
    assert sorted(middles) == pytest.approx([0.155, 0.2], abs=0.008)
    mean = impacts["tangential_restitution"].mean()
    for friction in middles:
        (expected,) = restitution(friction, np.array([30.0]), material=STEEL)
        assert expected == pytest.approx(mean, abs=NOISE)


@pytest.mark.slow
def test_where_e_t_turns_the_interval_is_the_profile():
    """The sum of squares at its ends, by the exact solution, has grown by t²/(n - 1) of itself."""
    angles, noise = np.full(7, 45.0), 0.002 * np.array([1.0, -1.0, 0.6, -1.2, 0.4, -0.9, -0.3])
    frictions = np.linspace(0.25, 0.4, 61)
    least = min(frictions, key=lambda friction: restitution(friction, angles[:1])[0])
    values = restitution(least, angles) + noise
    one = fit(table(values, angles), IMPACTS).parameters["friction_coefficient"]
    low, high = one.interval
    assert low < least < high
    assert high - low < 0.3 * least
    assert one.standard_error == pytest.approx(0.5 * (high - low) / stdtrit(6, 0.975))
    squares = [
        np.sum((values - restitution(friction, angles)) ** 2) for friction in (one.value, low, high)
    ]
    grown = np.array(squares[1:]) / squares[0] - 1.0
    np.testing.assert_allclose(grown, stdtrit(6, 0.975) ** 2 / 6, rtol=0.01)
