"""What a gathering refuses, each with the contact and a remedy, and the contacts that it finds."""

import re

import attrs
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
    create,
)
from contactlab.impact import shapes
from tests.collisions.gathered import STEEL, laws, row, three_balls

BALL, WALL = Sphere(0.01, STEEL), HalfSpace(STEEL)
RELAXING = Sphere(
    0.01,
    Material(young_modulus=1e9, poisson_ratio=0.3, density=1e3,
             properties={"relaxation_time (s)": 1e-6}),
)  # fmt: skip
MOVES, RESTS = Body(BALL, velocity=[1, 0, 0]), Body(BALL)
X = [1, 0, 0]


def two(*touches, bodies=(MOVES, RESTS)):
    """Return a gathering of two balls."""
    return Gathering(list(bodies), list(touches))


def placed(distance):
    """Return two balls that touch, and whose centres stand so far apart."""
    bodies = Body(BALL, velocity=X, position=[0, 0, 0]), Body(BALL, position=[distance, 0, 0])
    return two(Touch(0, 1, 0.1, normal=X), bodies=bodies)


def lies(force, **first):
    """Return a ball that rolls into a wall on its cloth."""
    body = Body(BALL, velocity=[1, 0, 0], force=force)
    touches = [Touch(0, WALL, 0.2, normal=X, **first)]
    return Gathering([body], [*touches, Touch(0, WALL, 0.2, normal=[0, 0, -1], loaded=True)])


#: What is given, the argument, and a word of the sentence.
REFUSED = {
    "bodies part": (
        lambda: collide(two(Touch(0, 1, 0.1, normal=[-1, 0, 0]))), "nothing approaches",
    ),
    "rounding": (
        lambda: collide(two(Touch(0, 1, 0.1, normal=[1e-12, 1, 0]))), "nothing approaches",
    ),
    "bodies rest": (lambda: collide(two(Touch(0, 1, 0.1, normal=X), bodies=(RESTS, RESTS))),
                    "nothing approaches"),
    "no place": (lambda: two(Touch(0, 2, 0.1, normal=X)), "touches[0].second"),
    "negative place": (lambda: two(Touch(-1, 1, 0.1, normal=X)), "touches[0].first"),
    "no name": (lambda: Gathering({"ball": MOVES}, [Touch("bal", WALL, 0.1, normal=X)]), "'ball'"),
    "a truth is no place": (lambda: two(Touch(True, 0, 0.1, normal=X)), "touches[0].first"),
    "unlike topology": (lambda: two(Touch([0, 1], 1, 0.1, normal=X)), "one topology"),
    "itself": (lambda: two(Touch(0, 0, 0.1, normal=X)), "does not touch itself"),
    "two half-spaces": (lambda: two(Touch(WALL, WALL, 0.1, normal=X)), "not a half-space"),
    "a half-space first": (lambda: two(Touch(WALL, 0, 0.1, normal=X)), "second"),
    "twice": (lambda: two(Touch(0, 1, 0.1, normal=X), Touch(0, 1, 0.1, normal=X)), "given twice"),
    "twice, turned": (
        lambda: two(Touch(0, 1, 0.1, normal=X), Touch(1, 0, 0.1, normal=[-1, 0, 0])), "given twice",
    ),
    "against positions": (
        lambda: two(Touch(0, 1, 0.1, normal=X),
                    bodies=(Body(BALL, velocity=X, position=[0.02, 0, 0]),
                            Body(BALL, position=[0, 0, 0]))),
        "positions",
    ),
    "apart by positions": (lambda: placed(0.0221), "touches[0].gap"),
    "one in the other by positions": (lambda: placed(0.0179), "touches[0].gap"),
    "negative gap": (lambda: Touch(0, 1, 0.1, normal=X, gap=-1e-6), "gap"),
    "negative friction": (lambda: Touch(0, 1, -0.1, normal=X), "friction_coefficient"),
    "a normal of length zero": (lambda: two(Touch(0, 1, 0.1, normal=[0, 0, 0])), "touches[0]"),
    "e below 0.01": (lambda: Touch(0, 1, 0.1, normal=X, restitution=0.0), "from 0.01"),
    "e above 1": (lambda: Touch(0, 1, 0.1, normal=X, restitution=1.1), "restitution"),
    "loaded by a number": (lambda: Touch(0, 1, 0.1, normal=X, loaded=1), "loaded"),
    "loaded without force": (lambda: collide(lies([0, 0, 0])), "needs a force"),
    "force that lifts": (lambda: collide(lies([0, 0, 1.0])), "lifts"),
    "loaded and open": (
        lambda: two(Touch(0, WALL, 0.1, normal=X, gap=1e-6, loaded=True)), "open contact",
    ),
    "two loads of a body": (lambda: lies([0.1, 0, -1], loaded=True), "statics"),
    "shapes": (
        lambda: two(Touch(0, 1, 0.1, normal=X, gap=np.zeros(3)),
                    bodies=(Body(BALL, velocity=np.ones((2, 3))), RESTS)),
        "broadcast",
    ),
    "a number as a name": (
        lambda: Gathering({1: MOVES, 0: RESTS}, [Touch(1, 0, 0.1, normal=X)]), "bodies: name",
    ),
    "no bodies": (lambda: Gathering([], [Touch(0, WALL, 0.1, normal=X)]), "bodies"),
    "no contacts": (lambda: Gathering([MOVES], []), "touches"),
    "one contact": (lambda: Gathering([MOVES], Touch(0, WALL, 0.1, normal=X)), "touches"),
    "a shape as a body": (lambda: Gathering([BALL], [Touch(0, WALL, 0.1, normal=X)]), "Body("),
    "a half-space that moves": (lambda: Body(WALL), "Sphere"),
    "a contact of a sphere": (
        lambda: two(Touch(0, 1, 0.1, normal=X, contact=[0.01, 0, 0])), "touches[0]",
    ),
    "velocity of a body as a wall": (
        lambda: two(Touch(0, 1, 0.1, normal=X, target_velocity=X)), "target_velocity",
    ),
    "restitution of all": (lambda: collide(row(3), restitution=0.9), "to each contact"),
    "restitution beside laws": (
        lambda: collide(row(3, e=[1.0, 0.9]), Simulation(normal="hertz", tangential="springs",
                                                         integrator="symplectic")), "touches[1]",
    ),
    "separating": (lambda: collide(row(3), separating="pass"), "separating"),
    "a list of encounters": (
        lambda: collide([Encounter(BALL, WALL, 0.1, normal=X, velocity=X)]), "Gathering(",
    ),
    "fields": (lambda: collide(row(3), history="fields"), "history=True"),
    "a history of an encounter": (
        lambda: collide(Encounter(BALL, WALL, 0.1, normal=X, velocity=X), history=True), "run(",
    ),
    "a whole-impact law": (
        lambda: collide(row(3), Simulation(tangential="coulomb", integrator="events")), "several",
    ),
    "a law of one plane": (
        lambda: collide(row(3), Simulation(tangential="annulus", integrator="symplectic")),
        "one line",
    ),
    "adaptive steps": (
        lambda: collide(row(3), Simulation(tangential="springs", integrator="adaptive")),
        "each contact by itself",
    ),
    "an overlap": (
        lambda: Gathering.of_spheres([Body(BALL, position=[0, 0, 0]),
                                      Body(BALL, position=[0.0199, 0, 0])],
                                     friction_coefficient=0.1, reach=0.0), "overlap"),
    "no position": (
        lambda: Gathering.of_spheres([MOVES], friction_coefficient=0.1, reach=0.0), "position",
    ),
    "nothing in reach": (
        lambda: Gathering.of_spheres([Body(BALL, position=[0, 0, 0])], friction_coefficient=0.1,
                                     reach=1.0), "reach"),
    "a dome on its side": (
        lambda: shapes.flat_rod(length=0.1, radius=0.01, end_radius=0.02, material=STEEL,
                                normal=[0, 0, -1], axis=[1, 0, 0], reach=0.0), "end_radius"),
    "a face": (
        lambda: shapes.box(sides=[0.1, 0.1, 0.1], corner_radius=0.01, material=STEEL,
                           normal=[0, 0, -1]), "flat_box"),
    "a run": (lambda: Simulation().run(row(3)), "collide(gathering"),
    "a time of each impact": (
        lambda: collide(row(3), Simulation(
            normal=create("normal.viscoelastic", relaxation_time=[1e-6, 2e-6, 3e-6]),
            tangential="springs", integrator="symplectic")),
        "relaxation_time",
    ),
    "a property of a material": (
        lambda: collide(two(Touch(0, 1, 0.1, normal=X), bodies=(Body(RELAXING, velocity=X), RESTS)),
                        Simulation(normal="viscoelastic", tangential="springs",
                                   integrator="symplectic")),
        "properties of materials",
    ),
}  # fmt: skip


#: Refusals that have the number of a touch.
OF_A_TOUCH = (
    "bodies part", "rounding", "no place", "no name", "itself", "two half-spaces", "twice",
    "against positions", "unlike topology", "loaded without force", "force that lifts",
    "loaded and open", "two loads of a body", "velocity of a body as a wall",
    "restitution beside laws", "a property of a material", "a contact of a sphere",
    "a normal of length zero",
)  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_refusal_names_what_to_do(case):
    make, word = REFUSED[case]
    with pytest.raises(ValueError, match=re.escape(word)) as refused:
        make()
    sentence = str(refused.value)
    assert re.fullmatch(r"[^\n]+: [^\n]+; [^\n]+", sentence)  # argument, rule, remedy
    if case in OF_A_TOUCH:
        assert re.match(r"touches\[\d\]", sentence)


def test_a_batch_names_the_first_gathering_in_which_nothing_approaches():
    velocity = np.array([[1.0, 0, 0], [-1.0, 0, 0], [-2.0, 0, 0]])
    given = two(Touch(0, 1, 0.1, normal=X), bodies=(Body(BALL, velocity=velocity), RESTS))
    with pytest.raises(ValueError, match=r"the first of 2 has index \[1\]"):
        collide(given)


def test_two_contacts_of_one_pair_at_two_points_are_two():
    body = RigidBody(mass=1.0, inertia=np.eye(3) * 1e-3, material=STEEL, curvature_radius=0.01)
    arms = [[0.01, 0.02, 0], [0.01, -0.02, 0]]
    touches = [
        Touch(0, 1, 0.1, normal=X, contact=arm, target_contact=[-arm[0], *arm[1:]]) for arm in arms
    ]
    assert len(two(*touches, bodies=(Body(body, velocity=X), Body(body))).touches) == 2


def test_names_and_places_mean_the_same():
    named = Gathering({"a": MOVES, "b": RESTS}, [Touch("a", "b", 0.1, normal=X)])
    assert named.places == two(Touch(0, 1, 0.1, normal=X)).places == ((0, 1),)
    assert named.names == ("a", "b")
    assert attrs.evolve(named, touches=named.touches).names == named.names
    hit = collide(named)
    assert hit["b"].velocity.tobytes() == hit.velocity[1].tobytes()
    with pytest.raises(ValueError, match="'a', 'b'"):
        hit["c"]


def test_spheres_by_their_positions_are_those_that_are_written():
    given = three_balls()
    bodies = dict(zip(given.names, given.bodies, strict=True))
    floor = [(WALL, [0, 0, -0.01], [0, 0, -1])]
    found = Gathering.of_spheres(bodies, friction_coefficient=0.3, walls=floor, reach=1e-9)
    assert {frozenset(each) for each in found.places} == {frozenset(each) for each in given.places}
    np.testing.assert_allclose([np.max(each.gap) for each in found.touches], 0.0, atol=1e-16)
    hit, other = collide(found, laws(12, 50)), collide(given, laws(12, 50))
    np.testing.assert_allclose(hit.velocity, other.velocity, atol=1e-12)


@pytest.mark.parametrize("distance", [0.0181, 0.0219])
def test_positions_are_rounded_to_a_tenth_of_the_radii(distance):
    assert placed(distance).touches[0].gap == 0.0


def test_gaps_follow_from_the_positions():
    bodies = [Body(BALL, velocity=X, position=[0, 0, 0]), Body(BALL, position=[0.020003, 0, 0])]
    (touch,) = Gathering.of_spheres(bodies, friction_coefficient=0.1, reach=1e-5).touches
    assert touch.gap == pytest.approx(3e-6, abs=1e-15)


def turned(degrees, about):
    """Return a rotation about an axis of the frame."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = (about + 1) % 3, (about + 2) % 3
    turn = np.eye(3)
    turn[[i, i, j, j], [i, j, i, j]] = c, -s, s, c
    return turn


def test_a_box_that_lands_flat_has_four_corners():
    made = {"sides": [0.1, 0.2, 0.3], "corner_radius": 0.01, "material": STEEL}
    body, contacts, gaps = shapes.flat_box(**made, normal=[0, 0, -1], reach=0.0)
    assert contacts.shape == (4, 3)
    assert not gaps.any()
    np.testing.assert_allclose(contacts[:, 2], -0.15)
    np.testing.assert_allclose(np.abs(contacts[:, :2]), [[0.04, 0.09]] * 4)
    floor = Gathering(
        [Body(body, velocity=[0, 0, -1])],
        [Touch(0, WALL, 0.3, normal=[0, 0, -1], contact=each) for each in contacts],
    )
    hit = collide(floor, laws(12, 50))
    assert hit.velocity[0, 2] == pytest.approx(1.0, abs=2e-4)
    np.testing.assert_allclose(hit.spin, 0.0, atol=1e-9)


def test_a_tilt_opens_gaps_and_a_reach_leaves_corners_out():
    made = {
        "sides": [0.1, 0.2, 0.3],
        "corner_radius": 0.01,
        "material": STEEL,
        "normal": [0, 0, -1],
    }
    _, contacts, gaps = shapes.flat_box(**made, axes=turned(0.01, 0), reach=1e-3)
    lever = 0.18 * np.sin(np.radians(0.01))
    np.testing.assert_allclose(gaps, [0.0, 0.0, lever, lever], atol=1e-12)
    low = contacts[:, 2]
    np.testing.assert_allclose(low - low.min(), gaps, atol=1e-12)
    _, contacts, gaps = shapes.flat_box(**made, axes=turned(45.0, 0), reach=1e-3)
    assert len(gaps) == len(contacts) == 2  # an edge


def test_a_rod_on_its_side_has_two_ends():
    made = {"length": 0.2, "radius": 0.01, "material": STEEL, "normal": [0, 0, -1]}
    body, contacts, gaps = shapes.flat_rod(**made, axis=[1, 0, 0], reach=0.0)
    np.testing.assert_allclose(contacts, [[0.09, 0, -0.01], [-0.09, 0, -0.01]], atol=1e-15)
    np.testing.assert_allclose(body.inertia[0, 0], body.inertia.diagonal().min())
    assert not gaps.any()
    _, _, gaps = shapes.flat_rod(**made, axis=turned(0.01, 1) @ [1, 0, 0], reach=1e-3)
    np.testing.assert_allclose(gaps, [0.0, 0.18 * np.sin(np.radians(0.01))], atol=1e-12)
    _, contacts, _ = shapes.flat_rod(**made, axis=turned(1.0, 1) @ [1, 0, 0], reach=1e-3)
    assert len(contacts) == 1


def test_a_restitution_that_nobody_gave_is_told():
    simulation = Simulation(normal="viscoelastic", tangential="springs", integrator="symplectic")
    assert any("no restitution given, using 0.9" in text
               for text in collide(row(2), simulation).cautions)  # fmt: skip
