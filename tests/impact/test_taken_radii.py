"""Radii of curvature that nobody gave: what they move, and that the plan tells them."""

import numpy as np
import pytest

from contactlab import (
    Body,
    Encounter,
    Gathering,
    HalfSpace,
    Material,
    RigidBody,
    Simulation,
    Sphere,
    Touch,
    collide,
    shapes,
)

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
WALL, DOWN = HalfSpace(STEEL), (0.0, 0.0, -1.0)
LUMP = {"mass": 1.0, "inertia": np.diag([1.0, 1.5, 2.0]) * 1e-3, "material": STEEL}


def met(body, contact=(0.01, 0.02, -0.05), **more):
    given = {"velocity": (0.6, 0.3, -1.0), "spin": (1.0, 2.0, 3.0), "contact": contact} | more
    return Encounter(body, WALL, 0.3, normal=DOWN, **given)


def told(result, word):
    return [text for text in result.cautions if word in text]


@pytest.mark.parametrize("e", [1.0, 0.7])
def test_a_round_contact_needs_no_radius(e):
    """Velocities and spins do not depend on it."""
    taken = collide(met(RigidBody(**LUMP)), restitution=e)
    given = collide(met(RigidBody(**LUMP, curvature_radius=0.003)), restitution=e)
    assert taken.velocity == pytest.approx(given.velocity, abs=1e-12)
    assert taken.spin == pytest.approx(given.spin, abs=1e-11)
    assert taken.result.motion.duration < 0.8 * given.result.motion.duration
    (sentence,) = told(taken, "curvature_radius")
    ball = Sphere(0.0312, STEEL)
    assert "using 0.0312 m, that of a solid ball of this mass" in sentence
    assert "and velocities under laws of a rate or of yield" in sentence
    assert ball.mass == pytest.approx(1.0, rel=2e-3)
    assert not told(given, "curvature_radius")


def test_a_batch_of_it_is_told_once():
    velocity = [(0.6, 0.3, -1.0), (0.1, 0.0, -2.0)]
    hits = collide(met(RigidBody(**LUMP), velocity=velocity))
    assert len(told(hits, "curvature_radius")) == 1
    assert len(told(hits.result, "curvature_radius")) == 1
    assert len(told(hits.result[1], "curvature_radius")) == 1


def test_several_contacts_tell_it_otherwise():
    body = Body(RigidBody(**LUMP), velocity=(0.0, 0.0, -1.0))
    touches = [
        Touch(0, WALL, 0.3, normal=DOWN, contact=(side, 0.0, -0.05)) for side in (-0.02, 0.02)
    ]
    (sentence,) = told(collide(Gathering([body], touches)), "curvature_radius")
    assert "velocities as contacts act together" in sentence
    assert sentence.startswith("touches[0], touches[1]: body: ")


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"cross_radius": 0.01}, "curvature_radius = None: is needed beside cross_radius"),
        ({"mass": [1.0, 2.0]}, "curvature_radius = None: is taken from one mass and one density"),
        (
            {"material": Material(young_modulus=208e9, poisson_ratio=0.3)},
            "curvature_radius = None: is taken from one mass",
        ),
    ],
)
def test_where_it_cannot_be_taken_it_is_asked_for(more, words):
    with pytest.raises(ValueError, match=words):
        RigidBody(**LUMP | more)


def box(**more):
    """Return a box that lies on an edge along x, and its contact."""
    c, s = np.cos(0.6), np.sin(0.6)
    return shapes.box(
        sides=[0.1, 0.05, 0.05], corner_radius=0.005, material=STEEL,
        axes=[[1, 0, 0], [0, c, -s], [0, s, c]], **{"normal": DOWN} | more,
    )  # fmt: skip


def test_an_edge_takes_a_crown_and_tells_it():
    """From 1 to 100 times its length it moves velocities by what the caution says."""
    taken = collide(met(*box()))
    (sentence,) = told(taken, "crown_radius")
    assert "using 1 m along the edge, ten times the longest side" in sentence
    same = collide(met(*box(crown_radius=1.0)))
    assert same.velocity.tolist() == taken.velocity.tolist()
    assert not told(same, "crown_radius")
    for crown in (0.1, 0.3, 10.0):
        other = collide(met(*box(crown_radius=crown)))
        assert np.abs(other.velocity - taken.velocity).max() < 0.01
        assert other.velocity.tolist() != taken.velocity.tolist()


def test_poses_on_an_edge_take_it_together():
    edges, contacts = box(normal=[DOWN, DOWN])
    assert told(collide(met(edges, contacts)), "crown_radius")
    with pytest.raises(ValueError, match=r"crown_radius = None: .*some poses touch with an edge"):
        box(normal=[DOWN, (0.5, 0.1, -1.0)])


def test_a_result_of_a_simulation_tells_it_too():
    assert told(Simulation().run(met(RigidBody(**LUMP)).scene), "curvature_radius")
