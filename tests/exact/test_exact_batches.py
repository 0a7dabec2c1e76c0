"""Batches of the exact law: followed together, they are what their impacts are one by one."""

import subprocess
import sys

import numpy as np
import pytest

import contactlab
import contactlab_laws.events.law as events
from contactlab import Scene, Simulation, Status, rebound
from contactlab_laws.events.scaled import ScaledImpact

pytestmark = pytest.mark.slow

#: Where rounding, events that crowd, or the limits of what is done together could show.
CORNERS = ("one", "full", "half", "zero", "rim", "balanced")
HALF_AND_ONE = 0.9999999193997331, 0.49999995258443836


@pytest.fixture(autouse=True)
def few(monkeypatch):
    """Small batches too are followed together."""
    monkeypatch.setattr(events, "FEWEST", 2)


def together(psi1, chi, **settings):
    integrator = contactlab.create("integrator.events", **settings)
    return Simulation(integrator=integrator).run(Scene.nondimensional(psi1=psi1, chi=chi))


def apart(monkeypatch, psi1, chi):
    with monkeypatch.context() as patch:
        patch.setattr(events, "FEWEST", sys.maxsize)
        return together(psi1, chi)


def mixed(count, seed, low=0.35, high=8.0):
    draw = np.random.default_rng(seed)
    chi = draw.uniform(low, high, count)
    return draw.uniform(0.0, 4.0 * chi) * draw.choice([-1.0, 1.0], count), chi


def corner(name, count):
    draw = np.random.default_rng(CORNERS.index(name))

    def spread(low, high):
        return 10.0 ** draw.uniform(low, high, count)

    side = draw.choice([-1.0, 1.0], count)
    chi = spread(-1.3, 1.5)
    if name == "one":
        return 1.0 + side * spread(-14, -1), chi
    if name == "full":
        return np.maximum(4.0 * chi - 1.0, 1.0) * (1.0 - spread(-14, -1)), chi
    if name == "half":
        return draw.uniform(0.0, 1.2, count), 0.5 + side * spread(-12, -1)
    if name == "zero":
        return spread(-12, -2), chi
    least = -2.3 if name == "rim" else -9
    other = draw.choice([-1.0, 1.0], count)
    return 1.0 + side * spread(least, -1), 0.5 + other * spread(-9, -1)


def compared(monkeypatch, psi1, chi):
    batch, single = together(psi1, chi).check(), apart(monkeypatch, psi1, chi).check()
    error = np.abs(batch.psi_change - single.psi_change) / np.maximum(1.0, np.abs(psi1))
    assert error.max() < 1e-10
    assert np.abs(batch.energy.relative_imbalance).max() < 2e-6
    return batch


def test_mixed_impacts_are_what_they_are_one_by_one(monkeypatch):
    ran, solve = [], ScaledImpact.solve
    psi1, chi = mixed(150, 1)
    compared(monkeypatch, psi1, chi)
    monkeypatch.setattr(ScaledImpact, "solve", lambda *given: ran.append(1) or solve(*given))
    batch = together(psi1, chi)
    assert len(ran) <= 3
    assert np.abs(batch.energy.relative_imbalance).max() < 1e-7
    assert batch.counters["panels"] > 10 * batch.plan.marched.sum()


@pytest.mark.parametrize("name", CORNERS)
def test_corners(monkeypatch, name):
    compared(monkeypatch, *corner(name, 45))


def test_heavy_impacts(monkeypatch):
    draw = np.random.default_rng(2)
    chi = 10.0 ** draw.uniform(1.5, 2.3, 42)
    compared(monkeypatch, draw.uniform(0.0, 1.0, 42) ** 2 * 4.0 * chi, chi)


@pytest.mark.parametrize(
    ("psi1", "chi"),
    [
        # slip began just beyond a piece, at the end of which the level is all but stationary
        (1.0018500911813328, 43.34865308194917),
        (1.0000013289143115, 34.227865254010226),
        (0.9075518363460114, 89.5221721756772),
        # slip so short that it hides between the points looked at, and that the front is back at
        # the edge within the same panel
        (0.9998778548451843, 160.80683733399906),
        (0.9987610244171012, 220.85085905811604),
        (1.000124712663441, 369.2576334038081),
    ],
)
def test_fronts_that_were_found_too_slowly_or_not_at_all(psi1, chi):
    single = Simulation().run(Scene.nondimensional(psi1=psi1, chi=chi)).check().psi_change
    law, normal = contactlab.create("tangential.fronts"), Simulation().normal_motion
    motion = normal(Scene.nondimensional(psi1=[psi1], chi=[chi]))
    found = law.impacts_together(np.array([psi1]), np.array([2.5 * chi]), motion, 1e-9)
    assert found.solved.all()
    assert found.change[0] == pytest.approx(single, abs=1e-11)


def test_an_answer_does_not_depend_on_its_neighbours():
    psi1, chi = mixed(200, 3)
    whole = together(psi1, chi).psi2
    order = np.random.default_rng(4).permutation(psi1.size)
    shuffled = together(psi1[order], chi[order]).psi2
    assert np.abs(shuffled - whole[order]).max() < 1e-10
    for first in range(0, 200, 50):
        part = slice(first, first + 50)
        assert np.abs(together(psi1[part], chi[part]).psi2 - whole[part]).max() < 1e-10
    heavy = together(np.append(psi1[:100], 30.0), np.append(chi[:100], 300.0)).psi2[:-1]
    assert np.abs(heavy - whole[:100]).max() < 1e-10


def test_a_sweep_and_any_shape_give_the_same():
    psi1, chi = mixed(120, 5)
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    swept = Simulation().sweep(scene, chunk=60).psi2
    assert np.abs(swept - together(psi1, chi).psi2).max() < 1e-10
    square = together(psi1.reshape(8, 15), chi.reshape(8, 15))
    assert np.abs(square.psi2.ravel() - swept).max() < 1e-10


def test_odd_to_the_last_bit():
    psi1, chi = mixed(100, 6)
    assert np.array_equal(together(-psi1, chi).psi2, -together(psi1, chi).psi2)


def test_statuses_are_those_of_the_impacts():
    psi1, chi = mixed(60, 7)
    chi[7] = 1e6
    result = together(psi1, chi)
    assert list(result.failures) == [7]
    assert result.status[7] is Status.UNRESOLVED
    assert "3000 are allowed" in result.motion.detail[7]
    chi[7] = 1.0
    good = np.delete(np.arange(60), 7)
    assert np.abs(together(psi1, chi).psi2 - result.psi2)[good].max() < 1e-10


def test_what_is_given_up_is_said():
    law, normal = contactlab.create("tangential.fronts"), Simulation().normal_motion
    psi1 = np.array([1.0, 1.0 + 1e-7, 0.999, 0.5, 0.5, 2.0])
    chi = np.array([1.0, 2.0, 0.5 - 1e-7, 2e4, 1.0, 0.4])
    motion = normal(Scene.nondimensional(psi1=psi1, chi=chi))
    found = law.impacts_together(psi1, 2.5 * chi, motion, 1e-9)
    assert found.solved.tolist() == [False, False, False, False, True, False]


def test_closer_tolerances_and_histories_are_followed_one_by_one(monkeypatch):
    def refuse(*given):
        raise AssertionError("together")

    monkeypatch.setattr(events, "together", refuse)
    psi1, chi = mixed(50, 8)
    together(psi1, chi, tolerance=1e-10).check()
    scene = Scene.nondimensional(psi1=psi1, chi=chi)
    kept = Simulation().run(scene, history=True).check()
    assert kept.history.slip_velocity[-1] == pytest.approx(kept.psi2, abs=1e-11)


@pytest.mark.parametrize("count", [1, 5, 65])
def test_rebound_next_to_one_and_one_half(count):
    """Where it was wrong by a thousandth, and by something else in every array."""
    psi1, chi = HALF_AND_ONE
    expected = -0.9999998258226
    assert rebound([psi1] * count, chi) == pytest.approx([expected] * count, abs=1e-9)


def test_rebound_is_the_same_alone_and_in_an_array():
    draw = np.random.default_rng(9)
    psi1 = np.append(1.0 - 10.0 ** draw.uniform(-9, -2, 60), draw.uniform(0.0, 30.0, 60))
    chi = np.append(0.5 + draw.choice([-1, 1], 60) * 10.0 ** draw.uniform(-9, -2, 60), [3.1] * 60)
    whole = rebound(psi1, chi)
    for k in range(0, 120, 6):
        assert rebound(psi1[k], chi[k]) == pytest.approx(whole[k], abs=1e-10)


def test_rebound_takes_any_tolerance_that_it_names():
    assert rebound(1.2, 1.4, tolerance=0.01) == pytest.approx(rebound(1.2, 1.4), abs=1e-9)


def test_no_scipy_for_the_exact_law():
    probe = (
        "import sys; from contactlab import Scene, Simulation; "
        "run = Simulation().run; run(Scene.nondimensional(psi1=1.2, chi=1.4)).psi2; "
        "run(Scene.nondimensional(psi1=[1.2] * 70, chi=1.4)).psi2; "
        "assert not [m for m in sys.modules if m.startswith('scipy')]"
    )
    subprocess.run([sys.executable, "-c", probe], check=True)


@pytest.mark.parametrize(
    ("psi1", "chi"),
    [
        (1.0 - 1.083109903e-7, 0.5 - 1.26158579e-8),
        (1.0 - 2.083845889e-7, 0.5 - 2.36000072e-8),
        (1.0 - 4.230063710e-5, 0.5 - 1.0293614093e-6),
        (0.9999987917493628, 0.4999994424348435),
        (0.9999617933606803, 0.49999492783624133),
    ],
)
def test_next_to_one_and_one_half_no_event_is_mistaken(psi1, chi):
    """At chi = 1/2 the contact rebounds with -psi1; beside it no further off than chi is."""
    result = Simulation().run(Scene.nondimensional(psi1=psi1, chi=chi)).check()
    assert abs(result.psi2 + psi1) < abs(2.0 * chi - 1.0)
    closest = Simulation(integrator=contactlab.create("integrator.events", tolerance=1e-12))
    other = closest.run(Scene.nondimensional(psi1=psi1, chi=chi)).check()
    assert abs(result.psi2 - other.psi2) < 1e-10


@pytest.mark.slow
@pytest.mark.parametrize("name", CORNERS)
def test_corners_at_length(monkeypatch, name):
    compared(monkeypatch, *corner(name, 400))


@pytest.mark.slow
def test_many_mixed_impacts(monkeypatch):
    compared(monkeypatch, *mixed(1_500, 10))
    compared(monkeypatch, *mixed(150, 11, 8.0, 100.0))
