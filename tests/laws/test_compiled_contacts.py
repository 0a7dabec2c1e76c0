"""Several contacts by the compiled march beside Python's, each the other's referee."""

import os
import signal
import threading
import time

import attrs
import numpy as np
import pytest

from contactlab import Body, Gathering, HalfSpace, Sphere, Status, Touch, collide, create
from tests.collisions.gathered import STEEL, cushion, laws, random_gathering, row
from tests.laws.test_compiled_march import EQUAL, both, needs_library  # noqa: F401

pytestmark = needs_library
#: What is told of contacts, and what of it is a time or a number of touches.
TOLD = ("impulse", "slip_velocity", "normal_velocity", "friction_work", "shear_loss", "normal_loss",
        "maximum_force", "maximum_radius", "duration", "first_touch", "last_touch",
        "touches")  # fmt: skip


def off(one, other):
    """Return the largest difference of two answers, each number over the largest of its kind."""
    worst = 0.0
    for name in ("velocity", "spin", *TOLD):
        found, expected = (np.asarray(getattr(each, name), dtype=float) for each in (one, other))
        assert np.array_equal(np.isnan(found), np.isnan(expected)), name
        size = np.nanmax(np.abs(expected), initial=0.0)
        if size > 0.0:
            worst = max(worst, np.nanmax(np.abs(found - expected)) / size)
    return worst


def alike(both, make, simulation=None):  # noqa: F811
    """Return the answers of both to a gathering, whose steps and statuses are the same."""
    one, other = both(lambda: collide(make(), simulation))
    assert np.array_equal(one.status, other.status)
    assert one._motion.counters == other._motion.counters
    return one, other


ROWS = {
    "gaps": lambda: row(4, gaps=[0.0, 1e-6, 2e-6], mu=0.15, spin=100.0),
    "one loss": lambda: row(3, mu=0.15, spin=100.0, gaps=[0.0, 1e-6]),
    "a loss each": lambda: row(3, mu=0.15, spin=100.0, e=[1.0, 0.8]),
    "force": lambda: cushion(force=[0.0, 0.0, -1.0]),
    "loaded": lambda: cushion(loaded=True),
    "loaded with loss": lambda: cushion(loaded=True, e=(0.9, 0.5)),
    "one contact": lambda: row(2, mu=0.2, spin=50.0),
    "one contact after a gap": lambda: row(2, mu=0.2, spin=50.0, gaps=1e-6),
}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(each, marks=pytest.mark.slow) if "with" in each or "each" in each else each
        for each in ROWS
    ],
)
def test_contacts_are_those_of_python(both, name):  # noqa: F811
    normal = create("normal.viscoelastic", restitution=0.8) if name == "one loss" else "hertz"
    own = "with" in name or "each" in name
    one, other = alike(both, ROWS[name], None if own else laws(12, 60, normal))
    assert off(one.check(), other) < EQUAL
    assert one.energy.relative_imbalance == pytest.approx(other.energy.relative_imbalance, abs=1e-9)


def drawn(draw, lossy):
    """Return a random gathering in which something approaches."""
    while True:
        gathering = random_gathering(draw, most=5)
        touches = gathering.touches
        if lossy:
            touches = [
                attrs.evolve(each, restitution=float(draw.choice([1.0, 0.8, 0.4])))
                for each in touches
            ]
        try:
            return Gathering(gathering.bodies, touches), gathering.scene
        except ValueError:
            continue


@pytest.mark.parametrize("count", [3, pytest.param(60, marks=pytest.mark.slow)])
def test_elastic_gatherings_are_those_of_python(both, count):  # noqa: F811
    draw = np.random.default_rng(count)
    for _ in range(count):
        gathering, _ = drawn(draw, lossy=False)
        one, other = alike(both, lambda given=gathering: given, laws(12, 60))
        assert off(one, other) < EQUAL


@pytest.mark.slow
def test_gatherings_with_loss_are_those_of_python(both):  # noqa: F811
    """Where a branch is decided by rounding, by no more than a rounding of velocities moves."""
    draw, equal, simulation = np.random.default_rng(3), 0, laws(12, 60, None)
    for _ in range(25):
        gathering, _ = drawn(draw, lossy=True)
        one, other = alike(both, lambda given=gathering: given, simulation)
        found, moved = off(one, other), 0.0
        if found >= EQUAL:
            for k in (-4, -3, -2, 2, 3, 4):
                factor = 1.0 + k * 2.0**-52
                bodies = [
                    attrs.evolve(each, velocity=factor * each.velocity, spin=factor * each.spin)
                    for each in gathering.bodies
                ]
                again = collide(Gathering(bodies, gathering.touches), simulation)
                moved = max(moved, off(again, other))
        equal += found < EQUAL
        assert found < max(EQUAL, 3.0 * moved)
    assert equal > 15


@pytest.mark.parametrize("e", [1.0, pytest.param(0.8, marks=pytest.mark.slow)])
def test_a_batch_is_its_gatherings(both, e):  # noqa: F811
    gaps, speeds = np.array([0.0, 1e-6, 5e-6]), np.array([1.0, 0.5, 2.0])

    def made(which):
        ball = Sphere(0.01, STEEL)
        first = Body(ball, velocity=np.stack([speeds[which], 0 * speeds[which]] * 2, -1)[..., :3])
        bodies = [first, Body(ball), Body(ball)]
        return Gathering(
            bodies,
            [
                Touch(0, 1, 0.2, normal=[1, 0, 0], restitution=e),
                Touch(1, 2, 0.2, normal=[1, 0, 0], gap=gaps[which], restitution=e),
            ],
        )

    sim = laws(12, 60) if e == 1.0 else None
    one, other = alike(both, lambda: made(slice(None)), sim)
    assert off(one.check(), other) < EQUAL
    for k in range(3):
        np.testing.assert_allclose(collide(made(k), sim).velocity, one.velocity[k], atol=1e-12)


@pytest.mark.slow
def test_a_chain_whose_matrix_is_sparse_is_that_of_python(both):  # noqa: F811
    one, other = alike(both, lambda: row(110, mu=0.1, spin=30.0), laws(2, 50))
    assert off(one.check(), other) < EQUAL


def between(gap, force=0.0):
    """Return a ball between two walls that close on it."""
    ball = Body(Sphere(0.01, STEEL), velocity=[0.1, 0, 0], force=[0, 0, -force])
    plane = HalfSpace(STEEL)
    walls = [
        Touch(0, plane, 0.0, normal=[side, 1e-3, 0], gap=gap, target_velocity=[-side, 0, 0])
        for side in (-1, 1)
    ]
    return Gathering([ball], walls)


@pytest.mark.parametrize(
    ("gap", "force"),
    [
        (0.0, 0.0),
        *(pytest.param(*each, marks=pytest.mark.slow) for each in ((1e-9, 1.0), (1e-5, 0.0))),
    ],
)
def test_what_is_given_up_has_the_sentence_of_python(both, gap, force):  # noqa: F811
    """By time, or after 50 touches."""
    one, other = alike(both, lambda: between(gap, force), laws(2, 40))
    assert one.status is Status.NOT_SEPARATED
    assert one.failures == other.failures
    assert np.isnan(one.velocity).all()


def test_laws_that_are_not_compiled_answer_by_python(both):  # noqa: F811
    one, other = both(lambda: collide(row(2, mu=0.1), laws(2, 30, "tsuji")))
    assert one.status is Status.SUCCESS
    assert np.array_equal(one.velocity, other.velocity)


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGINT"), reason="no such signal")
def test_control_c_is_heard_in_a_long_gathering():
    gathering = row(40, mu=0.15, spin=100.0)
    long = laws(2000, 20_000, create("normal.viscoelastic", restitution=0.8))
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    collide(row(3), laws(4, 40, long.normal))  # what is loaded once is loaded
    threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            collide(gathering, long)
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - begun < 30.0  # of minutes; a busy machine takes its time


def test_a_plan_says_what_marches(both):  # noqa: F811
    one, other = both(lambda: str(collide(row(2, mu=0.1)).plan))
    assert "resolution: the usual, in a compiled march" in one
    assert "the march is not compiled" in other
