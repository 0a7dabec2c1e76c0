"""``rebound`` and ``collide`` in other people's loops: empty batches, restitutions, bad numbers."""

import threading

import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, Sphere, collide, rebound

STEEL = Material.named("steel")
BALL = Sphere(0.01, STEEL)
CHI = 49 / 34
EACH = np.array([0.9, 1.0, 0.7, 0.9, 1.0, 0.7])


def test_empty_arrays_give_empty_arrays():
    for restitution in (1.0, 0.9, np.array([])):
        psi2 = rebound(np.array([]), CHI, restitution=restitution)
        assert (psi2.shape, psi2.dtype) == ((0,), np.float64)
    for part in rebound(np.zeros((0, 3)), CHI, derivatives=True):
        assert part.shape == (0, 3)
    assert rebound([], np.array([])).shape == (0,)


@pytest.mark.parametrize("simulation", [None, Simulation(tangential="coulomb")])
def test_an_empty_batch_of_encounters_collides_to_nothing(simulation):
    none = np.zeros((0, 3))
    balls = Sphere(np.zeros(0), STEEL)
    for sphere, target in ((BALL, BALL), (balls, BALL), (BALL, HalfSpace(STEEL))):
        met = Encounter(sphere, target, 0.2, normal=none, velocity=none, spin=none)
        after = collide(met, simulation)
        assert after.velocity.shape == after.target_spin.shape == (0, 3)
        assert after.collided.shape == after.friction_work.shape == (0,)
        assert after.status.shape == (0,)
        assert after.energy.imbalance.shape == (0,)
        assert after.check() is after
        assert str(after.plan) == ""
    each = collide(met, restitution=np.zeros(0))
    assert each.impulse.shape == (0, 3)


def test_a_scene_has_at_least_one_impact():
    with pytest.raises(ValueError, match="at least one"):
        Scene(Sphere(np.zeros(0), STEEL), BALL, 0.2, 1.0)
    with pytest.raises(ValueError, match="at least one"):
        Scene(BALL, BALL, 0.2, np.zeros(0))


def test_each_impact_may_have_its_restitution():
    psi1 = np.linspace(0.2, 3.0, 6)
    together = rebound(psi1, CHI, restitution=EACH)
    alone = [rebound(float(one), CHI, restitution=float(e)) for one, e in zip(psi1, EACH)]  # noqa: B905
    assert together == pytest.approx(alone, abs=1e-12)
    grid = rebound(psi1[:, None], CHI, restitution=[0.9, 1.0])
    assert grid.shape == (6, 2)
    assert grid[:, 1] == pytest.approx(rebound(psi1, CHI), abs=1e-12)
    assert len(rebound(psi1, CHI, restitution=EACH, derivatives=True)) == 4
    assert len(rebound(psi1, CHI, derivatives=True)) == 3


def encounters(part=slice(None)):
    """Return encounters with spin, the fourth of which separates."""
    rng = np.random.default_rng(2)
    velocity = np.column_stack((np.full(6, 2.0), rng.normal(0.0, 1.0, (6, 2))))
    velocity[3, 0] = -1.0
    spin = rng.normal(0.0, 50.0, (6, 3))
    return Encounter(
        BALL, BALL, 0.2, normal=[1.0, 0.0, 0.0], velocity=velocity[part], spin=spin[part]
    )


def test_each_encounter_may_have_its_restitution():
    together = collide(encounters(), restitution=EACH, separating="pass")
    for place in range(6):
        one = collide(encounters(place), restitution=float(EACH[place]), separating="pass")
        for name in ("velocity", "spin", "target_velocity", "target_spin", "impulse"):
            assert getattr(together, name)[place] == pytest.approx(getattr(one, name), rel=1e-11)
        assert together.friction_work[place] == pytest.approx(one.friction_work, rel=1e-9)
    met = EACH[[0, 1, 2, 4, 5]]
    assert together.result.normal_restitution == pytest.approx(met, abs=1e-4)
    assert together.result.status.shape == (5,)
    for index, e in enumerate(met):
        place = (0, 1, 2, 4, 5)[index]
        one = collide(encounters(place), restitution=float(e))
        joined, alone = (set(map(str, plan.computed)) for plan in (together.plan[index], one.plan))
        assert joined == alone
        assert together.result.psi2[index] == pytest.approx(one.result.psi2, abs=1e-9)


def test_a_grid_of_encounters_may_have_a_restitution_each():
    velocity = np.ones((2, 3, 3)) * [2.0, 0.7, 0.0]
    grid = Encounter(BALL, BALL, 0.2, normal=[1.0, 0.0, 0.0], velocity=velocity)
    after = collide(grid, restitution=[0.9, 1.0, 0.7])
    assert after.normal_velocity == pytest.approx(np.full((2, 3), -2.0) * [0.9, 1.0, 0.7])
    assert after.plan.marched.shape == (2, 3)
    assert after.result.psi2.shape == (2, 3)
    with pytest.raises(ValueError, match="shape"):
        collide(grid, restitution=[0.9, 1.0])


def test_the_first_bad_number_is_named_by_its_index():
    bad = np.ones((4, 2))
    bad[2, 1] = np.nan
    for call, words in (
        (lambda: rebound(bad, CHI), r"psi1 = .*index \[2, 1\]"),
        (lambda: rebound(1.0, [1.0, -1.0, -2.0]), r"chi = .*first of 2 has index \[1\]"),
        (lambda: rebound(1.0, CHI, restitution=[0.9, 1.1]), r"restitution = .*index \[1\]"),
        (lambda: collide(encounters(), restitution=EACH - 0.75), r"restitution = .*index \[2\]"),
        (
            lambda: Encounter(
                BALL, BALL, [0.1, -0.1], normal=np.ones((2, 3)), velocity=np.ones((2, 3))
            ),
            r"friction_coefficient = .*index \[1\]",
        ),
        (
            lambda: Encounter(
                BALL, BALL, 0.1, normal=np.ones((3, 3)), velocity=[[1, 0, 0], [0, 0, np.inf]] * 2
            ),
            r"velocity = .*index",
        ),
    ):
        with pytest.raises(ValueError, match=words):
            call()


def test_threads_get_the_answers_of_one():
    psi1 = np.linspace(-4.0, 4.0, 2001)
    expected, found = rebound(psi1, CHI), {}

    def work(name):
        found[name] = [rebound(psi1, CHI) for _ in range(5)]

    threads = [threading.Thread(target=work, args=(name,)) for name in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(each, expected) for answers in found.values() for each in answers)
