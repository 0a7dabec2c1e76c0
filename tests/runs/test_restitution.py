"""A restitution in place of a normal law, one number or one for each impact."""

import pickle
from concurrent.futures import ThreadPoolExecutor

import attrs
import numpy as np
import pytest

from contactlab import (
    Encounter,
    HalfSpace,
    Material,
    Scene,
    Simulation,
    Sphere,
    Status,
    collide,
    create,
    rebound,
    shapes,
)

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
DOWN = (0.0, 0.0, -1.0)
E = np.linspace(0.0, 1.0, 12)
BALL, PLATE = Sphere(0.01, STEEL), HalfSpace(STEEL)


def balls():
    return Scene(BALL, PLATE, 0.3, 1.0, np.linspace(0.05, 2.0, E.size))


def rods():
    rod, contact = shapes.rod(
        length=0.1, radius=0.01, material=STEEL, normal=DOWN, axis=[0.6, 0.0, 0.8]
    )
    velocity = [(0.5, 0.0, -1.0), (0.1, 0.2, -2.0), (0.3, 0.0, -1.0)]
    return Encounter(rod, PLATE, 0.3, normal=DOWN, velocity=velocity, contact=contact)


def test_each_impact_of_spheres_has_its_own():
    """Against the table of ``rebound``, which knows no simulation."""
    scene = balls()
    result = Simulation(restitution=E).sweep(scene).check()
    assert result.normal_restitution == pytest.approx(E, abs=1e-8)
    assert result.psi2 == pytest.approx(rebound(scene.psi1, scene.chi, restitution=E), abs=2e-3)
    books = result.energy
    assert books.end == pytest.approx(
        books.start - books.normal_loss - books.friction_work - books.shear_loss,
        abs=1e-4 * books.start.max(),
    )
    lost = 0.5 * BALL.mass * (1.0 - E**2)
    assert books.normal_loss == pytest.approx(lost, abs=1e-5 * books.start.max())


@pytest.mark.parametrize("e", [0.0, 0.6, 1.0])
def test_one_impact_has_the_answer_of_rebound(e):
    scene = balls().take(3)
    result = Simulation(restitution=e).run(scene).check()
    assert result.psi2 == pytest.approx(rebound(scene.psi1, scene.chi, restitution=e), abs=2e-3)
    assert result.normal_restitution == pytest.approx(e, abs=1e-8)


def test_each_impact_of_bodies_has_its_own():
    e = np.array([0.5, 0.8, 0.9])
    whole = Simulation(restitution=e).run(rods().scene).check()
    for k in range(3):
        one = Simulation(restitution=float(e[k])).run(rods().take(k).scene)
        assert whole.velocity_in_space[k] == pytest.approx(one.velocity_in_space, abs=1e-9)
        assert whole[k].energy.imbalance == pytest.approx(one.energy.imbalance, abs=1e-9)
        hit = collide(rods().take(k), restitution=float(e[k]))
        assert whole.velocity_in_space[k] == pytest.approx(hit.velocity, abs=1e-3)


@pytest.mark.slow
def test_blocks_and_threads_change_no_bit():
    scene, laws = balls(), Simulation(restitution=E)
    whole = laws.run(scene)
    with ThreadPoolExecutor(2) as executor:
        parts = laws.sweep(scene, chunk=1, executor=executor)
    assert parts.psi2.tolist() == whole.psi2.tolist()
    assert pickle.loads(pickle.dumps(laws)).run(scene).psi2.tolist() == whole.psi2.tolist()
    assert whole.to_dict()["normal.restitution"] == E.tolist()


def test_what_fails_is_a_status():
    """Adaptive steps of few: each impact has its own end."""
    few = create("integrator.symplectic", steps=2)
    result = Simulation(restitution=[0.0, 0.5, 0.95], integrator=few).run(balls().take([0, 4, 8]))
    assert result.status[0] is Status.SUCCESS  # has no course
    assert np.isnan(result.psi2).tolist() == [not status for status in result.status]


def test_a_named_law_takes_it():
    tsuji = Simulation(normal="tsuji", restitution=0.7)
    assert tsuji == Simulation(normal=create("normal.tsuji", restitution=0.7))
    object_ = Simulation(normal=create("viscoelastic"), restitution=0.7)
    assert object_ == Simulation(normal=create("viscoelastic", restitution=0.7))
    assert Simulation(restitution=1.0) == Simulation()
    swapped = attrs.evolve(Simulation(restitution=0.6), restitution=0.7)
    assert swapped.normal == create("viscoelastic", restitution=0.7)
    other = attrs.evolve(Simulation(restitution=0.6), tangential="coulomb")
    assert other.normal.restitution == 0.6
    assert attrs.evolve(other, normal="hertz", restitution=None).normal == create("hertz")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"restitution": 1.2}, "restitution = 1.2: must be from 0 to 1"),
        ({"restitution": [0.5, -0.1]}, "restitution = .*: must be from 0 to 1"),
        ({"restitution": "0.5"}, "restitution = '0.5': must be a real number"),
        ({"restitution": 0.5, "normal": "hertz"}, "normal = hertz, which does not take it; leave"),
        (
            {"restitution": 0.5, "normal": create("normal.tsuji", restitution=0.5)},
            "normal = tsuji, which has one",
        ),
        ({"restitution": [0.5, 0.6], "normal": "tsuji"}, "must be one number"),
    ],
)
def test_what_is_refused(given, words):
    with pytest.raises(ValueError, match=words):
        Simulation(**given)


def test_it_has_the_shape_of_the_scene():
    with pytest.raises(ValueError, match=r"normal.restitution = .*of the shape \(12,\)"):
        Simulation(restitution=[0.5, 0.6]).run(balls())
