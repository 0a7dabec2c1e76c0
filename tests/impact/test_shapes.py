"""Shapes: inertia and curvature against closed forms and differences; refusals."""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from scipy.special import iv, ivp, jv, jvp

from contactlab import Encounter, HalfSpace, Material, Simulation, collide, shapes

STEEL = Material.named("steel")
PLAIN = Material(young_modulus=1e9, poisson_ratio=0.3)
TURN = Rotation.from_rotvec([0.3, -0.8, 0.5]).as_matrix()
DOWN = np.array([0.0, 0.0, -1.0])
ROD = {"length": 1.0, "radius": 0.01, "material": STEEL, "normal": DOWN, "axis": [0.5, 0, 1]}
BOX = {"sides": [1, 2, 3], "corner_radius": 0.1, "material": STEEL, "normal": [1, 1, 1]}
DISC = {
    "radius": 1.0, "thickness": 0.3, "rim_radius": 0.05, "material": STEEL, "normal": [1, 0, 0.3],
    "axis": [0, 0, 1],
}  # fmt: skip
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


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_a_disc_bends_as_a_plate_with_a_free_rim(nu):
    """The equation of the first mode, about two diameters, by Bessel functions (Kirchhoff)."""
    free = 1.0 - nu

    def equation(x):
        j, j1, i, i1 = jv(2, x), jvp(2, x), iv(2, x), ivp(2, x)
        moment = x * x * j + free * (x * j1 - 4 * j), x * x * i - free * (x * i1 - 4 * i)
        shear = x**3 * j1 + 4 * free * (x * j1 - j), x**3 * i1 - 4 * free * (x * i1 - i)
        return moment[0] * shear[1] - moment[1] * shear[0]

    solid = Material(young_modulus=70e9, poisson_ratio=nu, density=2700.0)
    plate, _ = shapes.disc(
        radius=0.1, thickness=0.002, rim_radius=1e-5, material=solid, normal=[0.6, 0.0, -0.8],
        axis=[0.0, 0.0, 1.0],
    )  # fmt: skip
    bending = 70e9 * 0.002**2 / (12.0 * (1.0 - nu * nu) * 2700.0)
    omega = brentq(equation, 1.5, 2.8) ** 2 / 0.1**2 * math.sqrt(bending)
    assert plate.bending_period == pytest.approx(2.0 * math.pi / omega, rel=0.1)


def test_a_rod_has_the_first_bending_period_of_free_ends():
    body, _ = shapes.rod(**ROD | {"mass": None})
    young = 2 * STEEL.shear_modulus * (1 + STEEL.poisson_ratio)
    frequency = 22.3733 / (2 * math.pi) * math.sqrt(young / STEEL.density) * 0.01 / 2
    assert body.bending_period == pytest.approx(1 / frequency, rel=1e-5)


def test_a_box_with_small_corners_has_the_closed_form_in_its_axes():
    small = BOX | {"axes": TURN, "normal": TURN @ [1, -1, 1], "mass": 12.0, "corner_radius": 1e-6}
    body, _ = shapes.box(**small)
    assert np.allclose(TURN.T @ body.inertia @ TURN, np.diag([13.0, 10.0, 5.0]), atol=1e-5)
    _, contact = shapes.box(**small | {"corner_radius": 0.1})
    corner = [0.4, -0.9, 1.4] + 0.1 * np.array([1, -1, 1]) / math.sqrt(3)
    assert TURN.T @ contact == pytest.approx(corner, rel=1e-12)


def test_a_box_of_corners_alone_is_a_ball_and_of_edges_alone_a_capsule():
    ball, _ = shapes.box(**BOX | {"sides": [2.0, 2.0, 2.0], "corner_radius": 1.0})
    mass = 4 / 3 * math.pi * STEEL.density
    assert ball.mass == pytest.approx(mass, rel=1e-13)
    assert np.allclose(ball.inertia, 0.4 * mass * np.eye(3), rtol=1e-13)
    capsule, _ = shapes.box(**BOX | {"sides": [0.2, 0.2, 0.5], "corner_radius": 0.1})
    rod, _ = shapes.rod(**ROD | {"length": 0.5, "radius": 0.1, "axis": [0, 0, 1]})
    assert capsule.mass == pytest.approx(rod.mass, rel=1e-13)
    assert np.allclose(capsule.inertia, rod.inertia, rtol=1e-12, atol=1e-12)


def test_a_rounded_box_has_the_moments_of_its_points():
    """By points at random within the corner radius of the inner box."""
    sides, r = np.array([1.0, 2.0, 3.0]), 0.4
    points = np.random.default_rng(3).uniform(-0.5, 0.5, (1_000_000, 3)) * sides
    beyond = np.maximum(np.abs(points) - (0.5 * sides - r), 0.0)
    inside = points[np.sum(beyond**2, axis=1) < r * r]
    body, _ = shapes.box(**BOX | {"corner_radius": r})
    assert body.mass == pytest.approx(6 * len(inside) / 1e6 * STEEL.density, rel=2e-3)
    squares = np.mean(inside**2, axis=0)
    assert np.diag(body.inertia) / body.mass == pytest.approx(squares.sum() - squares, rel=3e-3)


def test_bars_needles_and_tubes_ring_as_slender_bodies_do():
    """A bar of the same length as a rod and a square section; a thin tube; a needle by shooting."""
    rod, _ = shapes.rod(**ROD)
    bar, _ = shapes.box(**BOX | {"sides": [1.0, 0.02, 0.02], "corner_radius": 1e-3})
    assert bar.bending_period == pytest.approx(
        rod.bending_period * 0.5 * 0.01 / (0.02 / math.sqrt(12)), rel=1e-12
    )
    tube, _ = shapes.rod(**ROD | {"mass": 0.02 * rod.mass})
    assert tube.bending_period == pytest.approx(rod.bending_period / math.sqrt(1.98), rel=1e-12)
    heavy, _ = shapes.rod(**ROD | {"mass": 4.0 * rod.mass})
    assert heavy.bending_period == pytest.approx(2.0 * rod.bending_period, rel=1e-12)
    needle, _ = shapes.ellipsoid(**EGG | {"semi_axes": [0.5, 0.01, 0.01]})
    young = 2 * STEEL.shear_modulus * (1 + STEEL.poisson_ratio)
    scale = 0.5**2 / (math.sqrt(young / STEEL.density) * 0.005)
    q = 2.0 * math.pi * scale / needle.bending_period

    def ends(q):
        """Return moment times shear, crosswise, at the tip of two symmetric vibrations."""

        def slope(s, y):
            w, dw, moment, shear = y
            return [dw, moment / (1 - s * s) ** 2, shear, q * q * (1 - s * s) * w]

        starts = ([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0])
        tips = [solve_ivp(slope, (0.0, 0.999), y, rtol=1e-9, atol=1e-12).y[2:, -1] for y in starts]
        return np.linalg.det(tips)

    assert ends(0.999 * q) * ends(1.001 * q) < 0.0  # free at both ends


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
    one, other, axis = body.curvatures(TURN @ plane[0], TURN @ plane[1])
    told = np.array([[axis.real, -axis.imag], [axis.imag, axis.real]])
    assert np.allclose(told @ np.diag([one, other]) @ told.T, second, rtol=0.0, atol=1e-4)
    assert np.allclose(TURN.T @ body.inertia @ TURN, np.diag([13.0, 10.0, 5.0]), atol=1e-12)


@pytest.mark.parametrize(
    ("make", "given", "word"),
    [
        (shapes.rod, ROD | {"end_radius": 0.1}, "sharp edge"),
        (shapes.rod, ROD | {"end_radius": 0.001}, "at least radius"),
        (shapes.rod, ROD | {"length": 0.01}, "both rounded ends"),
        (shapes.rod, ROD | {"material": PLAIN}, "density"),
        (shapes.rod, ROD | {"axis": [0, 0, 0]}, "not zero"),
        (shapes.rod, ROD | {"radius": [0.1, 0.2]}, "one number"),
        (shapes.box, BOX | {"crown_radius": 1.4}, "half the length"),
        (shapes.box, BOX | {"normal": [0, 0, 1]}, "along a face"),
        (shapes.box, BOX | {"corner_radius": 0.6}, "half the shortest"),
        (shapes.disc, DISC | {"normal": DISC["axis"]}, "along a face"),
        (shapes.disc, DISC | {"rim_radius": 0.2}, "half the thickness"),
        (shapes.disc, DISC | {"crown_radius": 0.1}, "half the length"),
        (shapes.box, BOX | {"sides": 1.0}, "three lengths"),
        (shapes.box, BOX | {"axes": 2 * np.eye(3)}, "right angles"),
        (shapes.ellipsoid, EGG | {"semi_axes": [1, -2, 3]}, "positive"),
    ],
)
def test_refusals(make, given, word):
    with pytest.raises(ValueError, match=word):
        make(**given)


def test_the_plan_cautions_of_ringing():
    body, contact = shapes.rod(**ROD)
    encounter = Encounter(body, HalfSpace(STEEL), 0.3, normal=DOWN, velocity=DOWN, contact=contact)
    assert "body rings" in str(Simulation().plan(encounter.scene).cautions)


def test_the_side_of_a_rod_is_flat_along_it():
    body, contact = shapes.rod(**ROD | {"axis": [0, 3, 0]})
    assert contact == pytest.approx(0.01 * DOWN)
    assert (body.curvature_radius, body.cross_radius) == (math.inf, 0.01)
    assert np.abs(body.curvature_axis) == pytest.approx([0, 1, 0])


@pytest.mark.parametrize("angle_deg", [2.0, 20.0, 60.0, 85.0])
def test_a_disc_touches_as_the_surface_of_a_torus(angle_deg):
    """The meridian has the rim's radius, the parallel the distance to the axis along the normal."""
    tilt = math.radians(angle_deg)
    normal = TURN @ [math.cos(tilt), 0.0, math.sin(tilt)]
    body, contact = shapes.disc(**DISC | {"axis": -TURN[:, 2], "normal": normal})
    point = [0.95 + 0.05 * math.cos(tilt), 0.0, 0.1 + 0.05 * math.sin(tilt)]
    assert TURN.T @ contact == pytest.approx(point, abs=1e-14)
    assert body.curvature_radius == 0.05
    assert body.cross_radius == pytest.approx(0.95 / math.cos(tilt) + 0.05)
    meridian = TURN @ [-math.sin(tilt), 0.0, math.cos(tilt)]
    assert abs(body.curvature_axis @ meridian) == pytest.approx(1.0)


def test_a_disc_has_the_moments_of_its_parts():
    """A flat cylinder with half a torus around it, by Pappus, and a round rim by quadrature."""
    body, _ = shapes.disc(**DISC | {"rim_radius": 0.15, "mass": None})
    rho, rim = 0.85, 0.15
    core = math.pi * rho**2 * 0.3
    ring = math.pi**2 * rim**2 * rho + 4 / 3 * math.pi * rim**3  # half a disc's centroid 4 r/(3 pi)
    assert body.mass == pytest.approx(STEEL.density * (core + ring), rel=1e-12)

    def moment(power_r, power_z):
        def density(z):
            return (rho + math.sqrt(rim * rim - z * z)) ** power_r * z**power_z

        return 2 * quad(density, 0.0, rim, epsabs=0.0, epsrel=1e-11)[0]

    own = 0.5 * math.pi * moment(4, 0)
    across = 0.5 * own + math.pi * moment(2, 2)
    assert np.diag(body.inertia) / STEEL.density == pytest.approx([across, across, own], rel=1e-9)


def test_the_side_of_a_disc_is_straight_or_crowned():
    side = DISC | {"normal": [1, 0, 0]}
    body, contact = shapes.disc(**side)
    assert contact == pytest.approx([1, 0, 0])
    assert (body.curvature_radius, body.cross_radius) == (math.inf, 1.0)
    crowned, _ = shapes.disc(**side | {"crown_radius": 5.0})
    assert (crowned.curvature_radius, crowned.cross_radius) == (5.0, 1.0)
    tilted = side | {"crown_radius": 5.0, "normal": [math.cos(0.01), 0.0, math.sin(0.01)]}
    body, contact = shapes.disc(**tilted)
    assert contact == pytest.approx([1 - 5 * (1 - math.cos(0.01)), 0, 5 * math.sin(0.01)])
    assert body.curvature_radius == 5.0


def test_an_edge_of_a_box_is_a_barrel():
    crowned = BOX | {"axes": TURN, "crown_radius": 20.0, "mass": 12.0}
    body, contact = shapes.box(**crowned | {"normal": TURN @ [1, 0, -1]})
    point = [0.4, 0.0, -1.4] + 0.1 * np.array([1, 0, -1]) / math.sqrt(2)
    assert TURN.T @ contact == pytest.approx(point, abs=1e-14)
    assert (body.curvature_radius, body.cross_radius) == (20.0, 0.1)
    assert TURN.T @ body.curvature_axis == pytest.approx([0, 1, 0])
    # a little aside the barrel rolls along, and far aside the corner touches
    body, contact = shapes.box(**crowned | {"normal": TURN @ [1, 0.01, -1]})
    assert (TURN.T @ contact)[1] == pytest.approx(20.0 * 0.01 / math.sqrt(2.0001))
    corner, _ = shapes.box(**crowned | {"normal": TURN @ [1, 0.1, -1]})
    assert (corner.curvature_radius, corner.cross_radius) == (0.1, None)


POSES = Rotation.from_rotvec(np.random.default_rng(5).normal(0.0, 0.3, (1000, 3))).as_matrix()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("make", "given", "oriented"),
    [
        (shapes.rod, ROD | {"axis": None}, POSES[:, :, 2]),
        (shapes.disc, DISC, POSES[:, :, 2]),
        (shapes.box, BOX | {"crown_radius": 5.0}, POSES),
        (shapes.ellipsoid, EGG, POSES),
    ],
)
def test_a_thousand_poses_are_those_of_a_thousand_calls(make, given, oriented):
    name = "axis" if "axis" in given else "axes"
    bodies, contacts = make(**given | {name: oriented})
    assert (bodies.shape, contacts.shape) == ((1000,), (1000, 3))
    for index in (0, 17, 999):
        one, contact = make(**given | {name: oriented[index]})
        taken = bodies.take((1000,), index)
        np.testing.assert_array_equal(contacts[index], contact)
        np.testing.assert_array_equal(taken.inertia, one.inertia)
        assert (taken.mass, taken.curvature_radius) == (one.mass, one.curvature_radius)
        assert taken.crossing == one.crossing
        assert taken.bending_period == one.bending_period


def test_poses_broadcast_and_a_bad_one_is_told():
    normals = np.array([[0.0, 0.1, -1.0], [0.0, 0.2, -1.0]])
    bodies, contacts = shapes.rod(**ROD | {"normal": normals[:, None], "axis": POSES[:5, :, 2]})
    assert (bodies.shape, contacts.shape) == ((2, 5), (2, 5, 3))
    with pytest.raises(ValueError, match=r"pose 1: normal .*along a face"):
        shapes.box(**BOX | {"normal": [[1.0, 1.0, 1.0], [0.0, 0.0, 1.0]]})
    met = Encounter(
        *(bodies, HalfSpace(STEEL), 0.3), normal=normals[:, None], velocity=DOWN, contact=contacts
    )
    found = collide(met)
    one, contact = shapes.rod(**ROD | {"normal": normals[1], "axis": POSES[3, :, 2]})
    alone = Encounter(one, HalfSpace(STEEL), 0.3, normal=normals[1], velocity=DOWN, contact=contact)
    np.testing.assert_allclose(found.velocity[1, 3], collide(alone).velocity, rtol=1e-9)
