"""The energy of springs on a doubling grid: merging only loses, no path gains, the books close."""

import itertools

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Simulation
from contactlab_laws.springs.doubling import Memory, fit_grid, move_springs
from tests.longer import longer

#: Steps from one random knot to the next.
STEPS = 64


def given_work(springs, slip, level, *, mean=True, weight=None):
    """Work done on contacts up to each step, over mu P_max times the slip of gross slip.

    ``slip`` and ``level`` (zeta), shape (K, items), are those of ``testing.load_paths``;
    the largest contacts are spread over one doubling. The force of a step is the mean of its ends,
    which errs by the square of the step, or the force at its end, with which the work of a return
    mapping is never less than what it stores.
    """
    items = slip.shape[1]
    radius = 0.01 * 2.0 ** np.linspace(-1.0, 0.0, items, endpoint=False)
    unit = 1e-3 * radius  # the limit at the centre of the largest contact
    one, none, rows = np.ones(items), np.zeros(items), np.zeros((springs, items))
    memory, before, place, work = Memory(none, none, rows, rows), none, none, none
    course = []
    for next_place, zeta in zip(slip, level, strict=True):
        limit = (2.0 / 3.0) * unit * zeta**1.5 * radius
        step, reach = (next_place - place) * unit, radius * np.sqrt(zeta)
        force, _, memory = move_springs(memory, step, reach, limit, unit=one, modulus=one)
        if weight is not None:
            force = force * weight(memory)
        work = work + (0.5 * (force + before) if mean else force) * step
        before, place = force, next_place
        course.append(work / ((2.0 / 3.0) * unit**2 * radius))
    return np.array(course)


def through(knots):
    """Straight lines through knots, shape (K * STEPS, items), from zero."""
    knots = np.concatenate((np.zeros_like(knots[:1]), knots))
    part = (np.arange(STEPS) + 1.0)[:, None] / STEPS
    legs = [start + part * (stop - start) for start, stop in itertools.pairwise(knots)]
    return np.concatenate(legs)


@pytest.mark.parametrize(
    ("springs", "items"),
    [(4, 1_000), *longer((4, 10_000), (8, 10_000))],
)
def test_no_random_path_gains_energy(springs, items):
    """Of paths through random slips and loads, many of them light, from rest."""
    random = np.random.default_rng(1)
    slips = random.normal(0.0, 0.8, (8, items))
    slips[0] = 0.0
    levels = random.uniform(5e-4, 1.0, (8, items)) ** random.choice([1, 4], (1, items))
    slip, level = through(slips), through(levels)
    assert given_work(springs, slip, level, mean=False).min() >= 0.0
    assert given_work(springs, slip, level).min() >= -5e-6


def gains_of_cycles(springs, weight=None):
    """Energy that each of 1,000 cycles gives back: one to three loads a slip, in any phase."""
    random, items, steps = np.random.default_rng(2), 1_000, 100
    base, swing = random.uniform(0.1, 1.0, items), random.uniform(0.0, 0.99, items)
    phase, number = random.uniform(0.0, 2.0 * np.pi, items), random.integers(1, 4, items)
    size, offset = random.uniform(0.02, 1.5, items), random.uniform(-0.5, 0.5, items)
    angle = 2.0 * np.pi * np.arange(6 * steps + 1)[:, None] / steps
    level = base * (1.0 + swing * np.sin(number * angle + phase)) / (1.0 + swing)
    slip = size * np.sin(angle) + offset
    press = (np.arange(20) / 20.0)[:, None]
    level = np.concatenate((press * level[0], level))
    slip = np.concatenate((press * slip[0], slip))
    ends = given_work(springs, slip, level, weight=weight)[20::steps]
    return -np.diff(ends, axis=0)[2:].min(axis=0)


@pytest.mark.parametrize("springs", [4, 8, *longer(16)])
def test_no_cyclic_path_gains_energy(springs):
    assert gains_of_cycles(springs).max() <= 1e-12


def test_a_weight_that_varies_with_the_contact_radius_gains_energy():
    """The stiffness 2 G* b to the last digit at every b: the test above can tell."""

    def exact_stiffness(memory):
        cell = memory.size / 4.0
        inside = np.maximum(np.ceil(memory.radius / np.maximum(cell, 1e-300) - 0.5), 1.0)
        return memory.radius / np.maximum(inside * cell, 1e-300)

    assert (gains_of_cycles(4, exact_stiffness) > 1e-3).sum() >= 3


def test_merging_keeps_the_force_and_loses_energy_and_splitting_changes_neither():
    random, items, springs = np.random.default_rng(4), 500, 8
    size = 2.0 ** random.integers(-3, 3, items)
    held = random.normal(size=(springs, items))
    memory = Memory(size, size, held, np.abs(held))

    def force_and_energy(size, held):
        return size * held.sum(axis=0), 0.5 * size * (held**2).sum(axis=0)

    force, energy = force_and_energy(size / springs, held)
    for factor in (1.7, 3.3, 20.0):
        after, merged, lost = fit_grid(
            memory.size, memory.deflection, factor * size, np.ones(items)
        )
        assert ((after / 2.0 < factor * size) & (factor * size <= after)).all()
        new_force, new_energy = force_and_energy(after / springs, merged)
        assert new_force == pytest.approx(force, rel=1e-12, abs=1e-14)
        assert (lost >= 0.0).all()
        assert energy - new_energy == pytest.approx(lost, rel=1e-9)
    inner = held.copy()
    inner[springs // 2 :] = 0.0  # the outer half is out of contact when cells are split
    force, energy = force_and_energy(size / springs, inner)
    memory = memory._replace(deflection=inner)
    after, split, lost = fit_grid(memory.size, memory.deflection, 0.24 * size, np.ones(items))
    assert (after == 0.5 * size).all()
    new_force, new_energy = force_and_energy(after / springs, split)
    assert new_force == pytest.approx(force, rel=1e-12, abs=1e-14)
    assert new_energy == pytest.approx(energy, rel=1e-12)
    assert not lost.any()


def test_books_of_impacts_close_to_second_order():
    psi1 = np.linspace(0.05, 5.5, 30)
    worst = []
    for springs in (16, 32, 64):
        law = contactlab.create("tangential.springs", springs=springs, grid="doubling")
        march = contactlab.create("integrator.symplectic", steps=8 * springs)
        simulation = Simulation(tangential=law, integrator=march)
        result = simulation.run(Scene.nondimensional(psi1=psi1, chi=49.0 / 34.0)).check()
        worst.append(np.abs(result.energy.relative_imbalance).max())
    assert worst[-1] < 5e-4
    assert worst[0] / worst[-1] > 8.0


@pytest.mark.parametrize("springs", [2, 4, 10, 50])
def test_books_stay_within_what_the_law_declares(springs):
    """With as few steps as the integrator allows, and bodies from slow to quick to turn."""
    psi1 = np.concatenate(([1e-3, 0.98, 1.2, 10.0], np.linspace(0.02, 4.0, 12)))
    law = contactlab.create("tangential.springs", springs=springs, grid="doubling")
    for chi in (0.05, 0.5, 1.44, 8.0, 100.0):
        steps = contactlab.create("integrator.symplectic", steps=7)
        simulation = Simulation(tangential=law, integrator=steps)
        scene = Scene.nondimensional(psi1=psi1, chi=chi)
        result = simulation.run(scene).check()
        assert (np.abs(result.energy.relative_imbalance) < law.books_bound(scene)).all()
        assert (np.abs(result.psi2) <= 1.02 * psi1 + 1e-3).all()
