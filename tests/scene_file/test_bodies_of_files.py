"""``[body]`` and lam of a scene file, against the same bodies made in Python."""

import math
import re

import numpy as np
import pytest

from contactlab import (
    Encounter,
    HalfSpace,
    Material,
    RigidBody,
    Scene,
    Sphere,
    read_scene,
    shapes,
)

STEEL = Material.named("steel")
DOWN = np.array([0.0, 0.0, -1.0])
ROD = """
[body]
shape = "rod"
length = 1.0
radius = 0.02
material = "steel"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.3
normal = [0, 0, -1]
velocity = [0.2, 0, -1.0]
"""
FOOT = """
[body]
mass = 20.0
inertia = [[8, 0, 0], [0, 9, 0], [0, 0, 7]]
curvature_radius = 0.1
material = "rubber"
[target]
kind = "sphere"
radius = 0.05
material = "steel"
[impact]
friction_coefficient = 0.7
normal = [0, 0, -1]
velocity = [0.5, 0.1, -1.0]
spin = [0, 1, 0]
contact = [0.15, 0, -0.9]
"""


@pytest.fixture
def read(tmp_path):
    """Return a function that reads a file of the text, with some text replaced."""

    def call(text, *pairs):
        for old, new in pairs:
            assert old in text
            text = text.replace(old, new, 1)
        (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
        return read_scene(tmp_path / "scene.toml")

    return call


def rod(degrees):
    angle = math.radians(degrees)
    axis = (math.sin(angle), 0.0, math.cos(angle))
    body, contact = shapes.rod(length=1.0, radius=0.02, material=STEEL, normal=DOWN, axis=axis)
    velocity = (0.2, 0.0, -1.0)
    return Encounter(body, HalfSpace(STEEL), 0.3, normal=DOWN, velocity=velocity, contact=contact)


def same(found, expected):
    assert found.inverse_mass == pytest.approx(expected.inverse_mass, rel=1e-12, abs=1e-15)
    assert found.psi1 == pytest.approx(expected.psi1, rel=1e-12)
    assert found.pair.radius == pytest.approx(expected.pair.radius)


def test_a_rod_of_one_tilt_and_of_several(read):
    axis = f"axis = [{math.sin(0.5)!r}, 0, {math.cos(0.5)!r}]\nradius = 0.02"
    same(read(ROD, ("radius = 0.02", axis)).scene, rod(math.degrees(0.5)).scene)
    swept = read(ROD + "[sweep]\ntilt_deg = [10, 30, 60]\n")
    assert swept.varied["tilt_deg"].tolist() == [10.0, 30.0, 60.0]
    for place, degrees in enumerate((10, 30, 60)):
        same(swept.scene.take(place), rod(degrees).scene)


def test_a_body_by_its_inertia_against_a_ball(read):
    body = RigidBody(
        mass=20.0, inertia=np.diag((8.0, 9.0, 7.0)), curvature_radius=0.1,
        material=Material.named("rubber"),
    )  # fmt: skip
    met = Encounter(
        body, Sphere(0.05, STEEL), 0.7, normal=DOWN, velocity=(0.5, 0.1, -1.0), spin=(0, 1, 0),
        contact=(0.15, 0.0, -0.9),
    )  # fmt: skip
    file = read(FOOT)
    assert file.encounter.body == body
    same(file.scene, met.scene)
    assert not file.scene.planar


@pytest.mark.parametrize(
    ("shape", "options"),
    [("box", {"sides": [0.1, 0.2, 0.3], "corner_radius": 0.01}),
     ("ellipsoid", {"semi_axes": [0.02, 0.03, 0.04]})],
)  # fmt: skip
def test_other_shapes_are_turned(read, shape, options):
    told = "".join(f"{name} = {value}\n" for name, value in options.items())
    roll = [[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]]
    told = f'shape = "{shape}"\naxes = {roll}\ntilt_deg = 25\n{told}'
    file = read(ROD.replace('shape = "rod"\nlength = 1.0\nradius = 0.02\n', told))
    s, c = math.sin(math.radians(25)), math.cos(math.radians(25))
    axes = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ roll
    body, contact = getattr(shapes, shape)(**options, material=STEEL, normal=DOWN, axes=axes)
    assert file.encounter.contact == pytest.approx(contact)
    assert file.encounter.body.inertia == pytest.approx(body.inertia, rel=1e-12)


def test_numbers_in_the_plane_and_in_space(read):
    plane = read("[nondimensional]\npsi1 = 0.0\nchi = 0.764706\nlam = 0.222692\neta = 2.037707\n")
    assert plane.scene.planar
    assert (plane.scene.lam, plane.scene.eta) == pytest.approx((0.222692, 2.037707))
    swept = read(
        "[nondimensional]\npsi1 = 0.0\nchi = 1.0\nlam = 0.2\neta = 1.0\n[sweep]\npsi1 = [0, 1]\n"
    )
    assert swept.scene.psi1 == pytest.approx([0.0, 1.0])
    space = read(
        "[nondimensional]\npsi1 = [0.8, 1.6]\nchi = [[0.6, 0], [0, 0.8]]\nlam = [-0.2, 0]\n"
        "rho = 0.1\n"
    )
    expected = Scene.nondimensional(
        psi1=(0.8, 1.6), chi=np.diag((0.6, 0.8)), lam=(-0.2, 0.0), rho=0.1
    )
    same(space.scene, expected)


REFUSED = [
    (ROD, ('"rod"', '"cone"'), ("body.shape", "cone", "ellipsoid")),
    (ROD, ("length = 1.0\n", ""), ("body.length", "missing")),
    (ROD, ("radius", "raduis"), ("body.raduis", "radius")),
    (ROD, ("radius = 0.02", "radius = -1"), ("body.radius", "-1")),
    (ROD, ("normal = [0, 0, -1]\n", ""), ("impact.normal", "missing")),
    (ROD, ("velocity", "contact = [0, 0, 1]\nvelocity"), ("impact.contact", "shape")),
    (
        ROD,
        ("velocity = [0.2, 0, -1.0]", "speed = 1.0\nangle_deg = 5"),
        ("impact.speed", "velocity"),
    ),
    (ROD, ("[target]", "[sphere]\nradius = 1\n[target]"), ("sphere", "leave out")),
    (ROD, ("[impact]", "[sweep]\nlength = [1, 2]\n[impact]"), ("length", "not an entry")),
    (FOOT, ("mass = 20.0\n", ""), ("body.mass", "missing", "rod")),
    (FOOT, ("[0, 0, 7]", "[0, 0, 70]"), ("body.inertia",)),
    (FOOT, ("contact = [0.15, 0, -0.9]\n", ""), ("impact.contact", "is needed")),
    (FOOT, ('"sphere"', '"cube"'), ("target.kind", "body")),
]


@pytest.mark.parametrize(("text", "pair", "words"), REFUSED)
def test_refusals(read, text, pair, words):
    with pytest.raises(ValueError, match=re.escape(words[0])) as refused:
        read(text, pair)
    for word in words[1:]:
        assert word in str(refused.value)
    assert "\n" not in str(refused.value)


DISC = """
[body]
shape = "disc"
radius = 0.038
thickness = 0.025
rim_radius = 0.002
mass = 0.17
axis = [0.3, 0, 1]
material = "rubber"
[target]
kind = "half-space"
material = "steel"
[impact]
friction_coefficient = 0.3
normal = [0, 0, -1]
velocity = [0.5, 0.0, -1.0]
"""


def test_a_disc_and_two_radii_in_a_file(read):
    """A puck by its shape and by its numbers is one scene."""
    by_shape = read(DISC).scene
    body = by_shape.encounter.body
    told = {
        "mass": body.mass, "inertia": body.inertia.tolist(),
        "curvature_radius": body.curvature_radius, "cross_radius": body.cross_radius,
        "curvature_axis": body.curvature_axis.tolist(), "material": '"rubber"',
    }  # fmt: skip
    table = "\n".join(f"{name} = {value}" for name, value in told.items())
    contact = by_shape.encounter.contact.tolist()
    text = f"[body]\n{table}\n[target]{DISC.split('[target]')[1]}contact = {contact}\n"
    by_numbers = read(text).scene
    assert by_numbers.pair == by_shape.pair
    assert by_numbers.pair.axis_ratio != 1.0


def test_a_tilt_from_an_edge_to_a_corner_is_swept(read):
    """A bar on an edge, and on a corner from some tilt on: each as it is alone."""
    text = DISC.replace('shape = "disc"', 'shape = "box"\nsides = [0.2, 0.02, 0.02]')
    for line in ("radius = 0.038", "thickness = 0.025", "rim_radius = 0.002", "axis = [0.3, 0, 1]"):
        text = text.replace(line + "\n", "")
    roll = "axes = [[1, 0, 0], [0, 0.8, -0.6], [0, 0.6, 0.8]]\n"
    text = text.replace("mass", f"corner_radius = 0.001\ncrown_radius = 1.0\n{roll}mass")
    swept = read(text + "[sweep]\ntilt_deg = [0.0, 3.0, 20.0]\n").scene
    ratios = []
    for place, degrees in enumerate((0.0, 3.0, 20.0)):
        alone = read(text.replace("[target]", f"tilt_deg = {degrees}\n[target]")).scene
        part = swept.take(place)
        assert part.pair.radius == pytest.approx(alone.pair.radius, rel=1e-13)
        assert part.psi1 == pytest.approx(alone.psi1, abs=1e-12)
        ratios.append(alone.pair.axis_ratio)
    assert ratios[0] != 1.0
    assert ratios[1] != 1.0
    assert ratios[2] == 1.0


SPEEDS = ("velocity = [0.2, 0, -1.0]", "along = [1, 0, 0]\nspeed = 1.02\nangle_deg = 11.31")


def test_a_body_by_its_speed_and_angle_which_may_be_swept(read):
    tilted = ("radius = 0.02", "radius = 0.02\ntilt_deg = 30")
    by_number = ("velocity = [0.2, 0, -1.0]", "along = [2, 0, 5]\nnormal_speed = 1.0\n"
                 "tangential_velocity = 0.2")  # fmt: skip
    same(read(ROD, tilted, by_number).scene, rod(30).scene)
    moving = read(ROD, tilted, (by_number[0], f"{by_number[1]}\ntarget_normal_velocity = -0.5"))
    assert moving.scene.normal_speed == pytest.approx(1.5, rel=1e-14)
    swept = read(ROD + "[sweep]\nangle_deg = [0, 20, 40]\n", tilted, SPEEDS).scene
    slips = 1.02 * np.sin(np.radians([0, 20, 40]))
    np.testing.assert_allclose(np.abs(swept.slip_velocity), slips, atol=1e-12)


@pytest.mark.parametrize(
    ("new", "words"),
    [
        (SPEEDS[1].replace("1, 0, 0", "0, 0, 2"), "impact.along = [0, 0, 2]: must not lie along"),
        (SPEEDS[1].replace("1, 0, 0", "1, 0"), "must be a vector of three numbers"),
        (SPEEDS[1].replace("1.02", "-1.02"), "impact.speed = -1.02: must"),
        (SPEEDS[1].replace("11.31", "95"), "impact.angle_deg = 95.0: must lie between -90 and 90"),
        (f"{SPEEDS[0]}\n{SPEEDS[1]}", "velocity is a vector, but along"),
        (SPEEDS[1].partition("\n")[2], "along = [x, y, z]"),
        (
            f"{SPEEDS[1]}\ntarget_spin = 3.0",
            "impact.target_spin = 3.0: must be zero: a half-space does not spin",
        ),
        (f"{SPEEDS[1]}\ncontact = [0, 0, -1]", "follows from the shape; leave it out"),
    ],
)
def test_what_is_wrong_with_speeds_of_a_body(read, new, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        read(ROD, ("velocity = [0.2, 0, -1.0]", new))


def test_speeds_of_a_body_by_its_inertia_need_a_normal(read):
    speeds = (
        "velocity = [0.5, 0.1, -1.0]\nspin = [0, 1, 0]",
        "along = [1, 0, 0]\nnormal_speed = 1",
    )
    assert read(FOOT, speeds).scene.normal_speed == pytest.approx(1.0)
    with pytest.raises(ValueError, match=r"impact\.normal = .*must not be zero"):
        read(FOOT, speeds, ("normal = [0, 0, -1]", "normal = [0, 0, 0]"))
