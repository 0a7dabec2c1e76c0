"""Stronge's contact by parts: where stick ends, many impacts beside one, and whole sentences."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from contactlab import Scene, Simulation, create
from contactlab_laws.stronge.batch import MANY, rebounds
from contactlab_laws.stronge.stages import ONE, rebound


def met(start, speed, closing, turn):
    """Where abs(f) first exceeds p, by a fine grid; pi/2 if nowhere."""
    load = np.sin if closing else np.cos

    def excess(x, sign=1.0):
        return sign * (start * np.cos(turn * x) + speed * np.sin(turn * x)) - load(x)

    grid = np.linspace(1e-9, 0.5 * np.pi, 20_001)
    over = [(np.argmax(excess(grid, sign) > 0.0), sign) for sign in (1.0, -1.0)]
    place, sign = min(((k, sign) for k, sign in over if k), default=(0, 0))
    if not place:
        return 0.5 * np.pi, 0
    return brentq(excess, grid[place - 1], grid[place], (sign,), xtol=1e-15), sign


def cases():
    """Spring forces at first touch and at maximum compression, fast and slow, near turn = 1 too."""
    draw = np.random.default_rng(1)
    for turn in (0.2, 0.999, 1.0, 1.001, 1.7, 4.0, 30.0):
        for _ in range(3):
            yield 0.0, draw.uniform(0.01, 1.0) / turn, True, turn
            yield draw.uniform(-1.0, 1.0), draw.normal() / turn, False, turn


def test_stick_ends_where_a_fine_grid_says():
    columns = [np.array(column) for column in zip(*cases(), strict=True)]
    for closing in (True, False):
        start, speed, turn = (columns[k][columns[2] == closing] for k in (0, 1, 3))
        many = MANY.stick_ends(start, speed, closing, turn, np.zeros_like(start))
        for k, row in enumerate(zip(start.tolist(), speed.tolist(), turn.tolist(), strict=True)):
            expected = met(*row[:2], closing, row[2])
            one = ONE.stick_ends(*row[:2], closing, row[2], 0.0)
            assert one == pytest.approx(expected, abs=1e-9)
            assert [each[k] for each in many] == pytest.approx(one, abs=1e-12)


@pytest.mark.parametrize(("beyond", "found"), [(1e-9, True), (-1e-9, False)])
def test_no_narrow_meeting_is_missed(beyond, found):
    """f comes 1e-9 beyond p, over 1e-4 of x, or stays 1e-9 below."""
    turn, place = 3.0, 0.5
    x = np.linspace(place - 0.2, place + 0.2, 100_001)

    def excess(swing):
        return (swing * np.cos(turn * (x - place)) - np.cos(x)).max() - beyond

    swing = brentq(excess, 0.5, 1.0)
    numbers = swing * math.cos(turn * place), swing * math.sin(turn * place), turn, 0.0
    start, speed, *rest = numbers
    one = ONE.stick_ends(start, speed, False, *rest)
    start, speed, *rest = (np.array([each]) for each in numbers)
    many = MANY.stick_ends(start, speed, False, *rest)
    assert (one[1] == 1, many[1][0] == 1.0) == (found, found)


def test_many_impacts_are_as_one():
    """To 1e-12 of max(1, psi1): NumPy's sines may differ from Python's in the last bit."""
    draw = np.random.default_rng(2)
    chi = np.exp(draw.uniform(np.log(0.01), np.log(1000.0), 400))
    psi1 = draw.uniform(1e-3, 1.1, chi.size) * 4.0 * chi
    psi1[:20] = 1.0
    e = draw.choice([0.0, 0.01, 0.5, 0.9, 1.0], chi.size)
    many = rebounds(psi1, np.sqrt(2.0 * chi), e)
    rows = zip(psi1.tolist(), np.sqrt(2.0 * chi).tolist(), e.tolist(), strict=True)
    change, work = np.array([rebound(*row) for row in rows]).T
    np.testing.assert_array_less(abs(many.change - change) / np.maximum(1.0, psi1), 1e-12)
    np.testing.assert_array_less(abs(many.work - work) / np.maximum(1.0, psi1**2), 1e-12)


@pytest.mark.parametrize("ratio", [None, 0.5])
def test_units_of_an_impact_in_si(ratio):
    """In SI as in scaled numbers: the change in mu v1/ratio, the work in M_t times its square."""
    from contactlab import HalfSpace, Material, Sphere

    steel = Material.named("steel")
    scene = Scene(Sphere(0.01, steel), HalfSpace(steel), 0.3, 0.7, -0.15)
    chosen = create("tangential.stronge", stiffness_ratio=ratio)
    result = Simulation(tangential=chosen).run(scene).check()
    stiff = scene.pair.stiffness_ratio if ratio is None else ratio
    unit = 0.3 * 0.7 / stiff
    omega = math.sqrt(stiff * scene.pair.normal_mass / scene.pair.tangential_mass)
    known = rebound(0.15 / unit, omega, 1.0)
    assert result.motion.slip_velocity_change == pytest.approx(-unit * known.change)
    assert result.motion.friction_work == pytest.approx(
        scene.pair.tangential_mass * unit**2 * known.work
    )
