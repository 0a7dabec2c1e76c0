"""Shapes: inertia and curvature against closed forms and differences; refusals."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from contactlab import Encounter, HalfSpace, Material, Simulation, shapes

STEEL = Material.named("steel")
PLAIN = Material(young_modulus=1e9, poisson_ratio=0.3)
TURN = Rotation.from_rotvec([0.3, -0.8, 0.5]).as_matrix()
DOWN = np.array([0.0, 0.0, -1.0])
ROD = {"length": 1.0, "radius": 0.01, "material": STEEL, "normal": DOWN, "axis": [0.5, 0, 1]}
BOX = {"sides": [1, 2, 3], "corner_radius": 0.1, "material": STEEL, "normal": [1, 1, 1]}
EGG = {"semi_axes": [1, 2, 3], "material": STEEL, "normal": [1, 1, 1]}


def test_a_capsule_has_the_closed_form():
    length, radius, mass = 0.5, 0.1, 2.0
    body, contact = shapes.rod(**ROD | {"length": length, "radius": radius, "mass": mass})
    straight, axis = length - 2 * radius, np.array([0.5, 0, 1]) / math.hypot(0.5, 1)
    tube, ball = math.pi * radius**2 * straight, 4 / 3 * math.pi * radius**3
    tube, ball = (mass * each / (tube + ball) for each in (tube, ball))
    along = tube * radius**2 / 2 + ball * 2 / 5 * radius**2
    across = tube * (3 * radius**2 + straight**2) / 12
    across += ball * (2 / 5 * radius**2 + straight**2 / 4 + 3 / 8 * straight * radius)
    assert axis @ body.inertia @ axis == pytest.approx(along, rel=1e-13)
    assert np.trace(body.inertia) == pytest.approx(along + 2 * across, rel=1e-13)
    assert contact == pytest.approx(-axis * straight / 2 + radius * DOWN, rel=1e-13)


def test_a_thin_rod_and_a_flat_dome_have_the_cylinders_moments():
    body, _ = shapes.rod(**ROD | {"axis": DOWN, "end_radius": 1e3, "radius": 0.1, "mass": 12.0})
    assert np.diag(body.inertia) == pytest.approx([1.03, 1.03, 0.06], rel=1e-4)


def test_a_rod_has_the_first_bending_period_of_free_ends():
    body, _ = shapes.rod(**ROD | {"mass": None})
    young = 2 * STEEL.shear_modulus * (1 + STEEL.poisson_ratio)
    frequency = 22.3733 / (2 * math.pi) * math.sqrt(young / STEEL.density) * 0.01 / 2
    assert body.bending_period == pytest.approx(1 / frequency, rel=1e-5)


def test_a_box_has_the_closed_form_in_its_axes():
    body, contact = shapes.box(**BOX | {"axes": TURN, "normal": TURN @ [1, -1, 1], "mass": 12.0})
    assert np.allclose(TURN.T @ body.inertia @ TURN, np.diag([13.0, 10.0, 5.0]), atol=1e-12)
    corner = [0.4, -0.9, 1.4] + 0.1 * np.array([1, -1, 1]) / math.sqrt(3)
    assert TURN.T @ contact == pytest.approx(corner, rel=1e-12)


@pytest.mark.parametrize("normal", [[1.0, 0.2, -0.5], [0.0, 0.0, 1.0], [0.3, 1.0, 0.0]])
def test_an_ellipsoid_has_the_curvature_of_its_surface(normal):
    lengths = np.array([1.0, 2.0, 3.0])
    outward = np.array(normal) / np.linalg.norm(normal)
    body, contact = shapes.ellipsoid(**EGG | {"axes": TURN, "normal": TURN @ outward, "mass": 5.0})
    point = TURN.T @ contact
    assert np.sum((point / lengths) ** 2) == pytest.approx(1.0, rel=1e-12)
    plane = np.linalg.svd(outward[None])[2][1:]

    def depth(step):  # of the surface below the tangent plane, from the quadratic for the depth
        at = point + step
        a, b = np.sum((outward / lengths) ** 2), np.sum(at * outward / lengths**2)
        return (b - math.sqrt(b * b - a * (np.sum((at / lengths) ** 2) - 1))) / a

    h = 1e-3
    second = [
        [
            sum(s * t * depth(h * (s * u + t * v)) for s in (1, -1) for t in (1, -1)) / (4 * h * h)
            for u in plane
        ]
        for v in plane
    ]
    curvatures = np.linalg.eigvalsh(second)
    assert 1 / body.curvature_radius == pytest.approx(curvatures.mean(), rel=1e-4)
    assert body.curvature_ratio == pytest.approx(curvatures[1] / curvatures[0], rel=1e-4)
    assert np.allclose(TURN.T @ body.inertia @ TURN, np.diag([13.0, 10.0, 5.0]), atol=1e-12)


@pytest.mark.parametrize(
    ("make", "given", "word"),
    [
        (shapes.rod, ROD | {"axis": [1, 0, 0]}, "along a line"),
        (shapes.rod, ROD | {"end_radius": 0.1}, "sharp edge"),
        (shapes.rod, ROD | {"end_radius": 0.001}, "at least radius"),
        (shapes.rod, ROD | {"length": 0.01}, "both rounded ends"),
        (shapes.rod, ROD | {"material": PLAIN}, "density"),
        (shapes.rod, ROD | {"axis": [0, 0, 0]}, "not zero"),
        (shapes.rod, ROD | {"radius": [0.1, 0.2]}, "one number"),
        (shapes.box, BOX | {"normal": [0, 1, 1]}, "along a line"),
        (shapes.box, BOX | {"normal": [0, 0, 1]}, "along a face"),
        (shapes.box, BOX | {"corner_radius": 0.6}, "half the shortest"),
        (shapes.box, BOX | {"sides": 1.0}, "three lengths"),
        (shapes.box, BOX | {"axes": 2 * np.eye(3)}, "right angles"),
        (shapes.ellipsoid, EGG | {"semi_axes": [1, -2, 3]}, "positive"),
    ],
)
def test_refusals(make, given, word):
    with pytest.raises(ValueError, match=word):
        make(**given)


@pytest.mark.parametrize(
    ("made", "words"),
    [
        (shapes.rod(**ROD), ["body rings"]),
        (shapes.ellipsoid(**EGG), ["elliptic"]),
        (shapes.ellipsoid(**EGG | {"semi_axes": [1, 1, 1]}), []),
    ],
)
def test_the_plan_cautions_of_ringing_and_of_elliptic_contacts(made, words):
    body, contact = made
    normal = DOWN if "body rings" in words else np.ones(3) / math.sqrt(3)
    encounter = Encounter(
        body, HalfSpace(STEEL), 0.3, normal=normal, velocity=normal, contact=contact
    )
    text = str(Simulation().plan(encounter.scene).cautions)
    assert [word for word in ("body rings", "elliptic") if word in text] == words
