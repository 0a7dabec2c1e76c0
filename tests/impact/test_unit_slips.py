"""Numbers that look as if they were in another unit are cautioned, and others are not."""

import math

import attrs
import numpy as np
import pytest

from contactlab import (
    Encounter,
    HalfSpace,
    Material,
    RigidBody,
    Scene,
    Simulation,
    Sphere,
    collide,
    shapes,
)
from contactlab.impact import material as materials
from contactlab.impact.cautions import unit_slips
from contactlab.scene_file import read_scene

STEEL = Material.named("steel")
BALL = Scene(Sphere(6.35e-3, STEEL), HalfSpace(STEEL), 0.15, 1.0, 0.5)


def steel(**changes):
    numbers = {"young_modulus": 207e9, "poisson_ratio": 0.3, "density": 7850.0}
    return Material(**(numbers | changes))


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (attrs.evolve(BALL, sphere=Sphere(6.35, STEEL)), "sphere.radius = 6.35 m: is"),
        (attrs.evolve(BALL, sphere=Sphere(6.35e-3, steel(density=7.85))),
         "sphere.material.density = 7.85 kg/m³: is the density in g/cm³?"),
        (attrs.evolve(BALL, target=HalfSpace(steel(young_modulus=207.0))), "in GPa?"),
        (attrs.evolve(BALL, target=Sphere(40.0, STEEL)), "target.radius = 40 m"),
        (attrs.evolve(BALL, spin=-9.5493 * 1.1 / 6.35e-3), "in turns a minute?"),
        (attrs.evolve(BALL, tangential_velocity=math.tan(math.radians(0.7854))),
         "45° in radians"),
        (attrs.evolve(BALL, tangential_velocity=-math.tan(math.radians(0.5236))), "30° in radians"),
        (attrs.evolve(BALL, target=HalfSpace(steel(young_modulus=207e3))), "in MPa?"),
        (attrs.evolve(BALL, target=HalfSpace(steel(young_modulus=3e3))), "in MPa?"),
        (attrs.evolve(BALL, tangential_velocity=np.tan(np.radians([0.5, 0.75, 1.0]))),
         "all angles of incidence lie below 1°"),
        (attrs.evolve(BALL, tangential_velocity=np.tan(np.radians(np.linspace(0, 1.5, 31)))),
         "all angles of incidence lie below 1.5°"),
    ],
)  # fmt: skip
def test_slips(scene, words):
    plan = Simulation().plan(scene)
    assert any(words in str(caution) for caution in plan.cautions)
    assert len(unit_slips(scene)) == 1


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (attrs.evolve(BALL, friction_coefficient=15.0), "friction_coefficient = 15"),
        (attrs.evolve(BALL, normal_speed=600.0), "0.12 of the speed of sound in the sphere"),
    ],
)
def test_numbers_that_few_contacts_have(scene, words):
    assert words in str(Simulation().plan(scene))
    assert "friction_coefficient" not in str(Simulation().plan(BALL).cautions)
    assert "sound" not in str(Simulation().plan(attrs.evolve(BALL, normal_speed=500.0)))


def test_a_restitution_that_nobody_gave_is_told():
    assert "no restitution given, using 0.9" in str(Simulation(normal="tsuji").run(BALL))


def test_a_batch_is_judged_by_its_extremes():
    angles = np.radians(np.radians([5.0, 15.0, 45.0]))
    batch = attrs.evolve(BALL, tangential_velocity=np.tan(angles), friction_coefficient=0.1)
    assert "45°" in unit_slips(batch)[0]


@pytest.mark.parametrize("name", materials.names())
@pytest.mark.parametrize("radius", [1e-6, 1e-3, 0.5])
def test_what_there_is_is_not_cautioned(name, radius):
    material = Material.named(name)
    scene = Scene(Sphere(radius, material), HalfSpace(material), 1.2, 1.0, 0.3)
    assert unit_slips(scene) == []


def test_spin_is_judged_against_the_greatest_speed_of_a_batch():
    spins = attrs.evolve(BALL, spin=np.array([0.0, 1.1 / 6.35e-3, 1000.0]))
    assert unit_slips(spins) == []
    slow = attrs.evolve(BALL, normal_speed=np.array([1e-9, 1.0]), spin=500.0)
    assert unit_slips(slow) == []
    assert "turns a minute" in unit_slips(attrs.evolve(slow, spin=2000.0))[0]
    met = Encounter(
        Sphere(0.0286, STEEL), Sphere(0.0286, STEEL), 0.06,
        normal=(1, 1, 0), velocity=(4, 0, 0), spin=(0, 0, 4 / 0.0286 * 9.5493),
    )  # fmt: skip
    assert "turns a minute" in str(collide(met, restitution=0.95).plan)


def test_round_angles_and_scenes_without_bodies_are_not_cautioned():
    for angle in (0.0, 0.5, 1.0, 1.5, 2.0, 45.0, 89.0):
        scene = attrs.evolve(BALL, tangential_velocity=math.tan(math.radians(angle)))
        assert unit_slips(scene) == []
    assert unit_slips(Scene.nondimensional(psi1=1.0, chi=1.0)) == []


def test_extremes_of_what_a_float_holds_raise_nothing():
    with np.errstate(all="raise"):
        scene = Scene(Sphere(1e-150, STEEL, mass=1e-3), HalfSpace(STEEL), 0.1, 1.0, 1e150)
        assert unit_slips(scene) == []
        for radius in (1e-150, 1e99):  # whose cubes are no numbers
            ball = Sphere(np.array([radius, radius]), STEEL, mass=1.0)
            assert "shell" in str(Simulation().plan(Scene(ball, HalfSpace(STEEL), 0.1, 1.0))) or (
                radius < 1.0
            )


PING_PONG = Material(young_modulus=2.2e9, poisson_ratio=0.35, density=1400.0)


@pytest.mark.parametrize(
    ("ball", "words"),
    [
        (Sphere(0.02, PING_PONG, mass=2.7e-3), "sphere.mass is 0.058 of"),
        (Sphere(0.02, PING_PONG, mass=2.7e-3), "so that the sphere is a shell"),
        (Sphere(0.02, PING_PONG, gyration_ratio=0.8), "is that of a "),
        (Sphere(0.02, PING_PONG, mass=47.0), "unit: sphere.mass = 47 kg: is the mass in g?"),
    ],
)
def test_a_shell_is_cautioned(ball, words):
    scene = Scene(ball, HalfSpace(STEEL), 0.2, 2.0, 0.5)
    assert words in str(Simulation().plan(scene).cautions)
    assert words in str(Simulation().run(scene))


def test_what_is_known_of_a_shell_is_told():
    """Wall m/(4 pi R² rho), Reissner's stiffness and pi sqrt(m/k), against 4 numbers by hand.

    A table-tennis ball lies on a table for about 1 ms: that of a solid one is a tenth of it.
    """
    ball = Sphere(0.02, PING_PONG, mass=2.7e-3)
    (told,) = [
        str(each) for each in Simulation().plan(Scene(ball, HalfSpace(STEEL), 0.2, 2.0)).cautions
        if "shell" in str(each)
    ]  # fmt: skip
    wall = 2.7e-3 / (4 * math.pi * 0.02**2 * 1400)
    spring = 4 * 2.2e9 * wall**2 / (0.02 * math.sqrt(3 * (1 - 0.35**2)))
    lasting = math.pi * math.sqrt(2.7e-3 / spring)
    assert f"wall of {wall * 1e3:.2g} mm" in told
    assert f"spring of {spring / 1e3:.2g} kN/m" in told
    assert f"lasts about {lasting * 1e3:.2g} ms" in told
    assert 0.5e-3 < lasting < 1.5e-3


@pytest.mark.parametrize("share", [0.7, 1.0, 1.3])
def test_balls_with_a_hole_or_a_core_are_not_cautioned(share):
    solid = Sphere(0.02, STEEL)
    ball = Sphere(0.02, STEEL, mass=share * solid.mass, gyration_ratio=0.66)
    assert "shell" not in str(Simulation().plan(Scene(ball, HalfSpace(STEEL), 0.2, 2.0)))


DOWN = np.array([0.0, 0.0, -1.0])
ROD = {"length": 0.5, "radius": 0.01, "material": STEEL, "normal": DOWN, "axis": [0.5, 0, 1]}


def of_rod(changes=(), body=(), **given):
    made, contact = shapes.rod(**ROD | dict(changes))
    if body:
        made = attrs.evolve(made, **dict(body))
    met = {"velocity": [0.3, 0, -1.0], "contact": contact} | given
    return Encounter(made, HalfSpace(STEEL), 0.3, normal=DOWN, **met)


@pytest.mark.parametrize(
    ("encounter", "words"),
    [
        (
            of_rod({"length": 1000.0, "radius": 10.0}),
            "m from the centre of mass: are lengths in mm",
        ),
        (of_rod(body={"inertia": 1e6 * shapes.rod(**ROD)[0].inertia}), "body.inertia has a radius"),
        (
            of_rod(body={"curvature_radius": 20.0}),
            "body.curvature_radius = 20 m: is the radius in mm?",
        ),
        (of_rod(spin=[0, -60 * 9.55, 0]), "in turns a minute?"),
        (of_rod({"material": steel(young_modulus=207e3)}), "in MPa?"),
    ],
)
def test_slips_of_bodies(encounter, words):
    assert words in str(Simulation().plan(encounter.scene).cautions)
    assert words in str(collide(encounter).plan.cautions)


def test_bodies_as_they_are_are_not_cautioned():
    thin = of_rod({"length": 2.0, "radius": 0.001})
    for met in (of_rod(), thin, of_rod(spin=[0, -20.0, 0])):
        assert unit_slips(met.scene) == []


NYLON = Material(young_modulus=2.5e9, poisson_ratio=0.4, density=1140.0)
#: Bodies some 40 mm wide of 2.7 g; solid ones have 16 to 73 g.
TABLE_TENNIS = {
    "ellipsoid": lambda mass: shapes.ellipsoid(
        semi_axes=[0.02, 0.02, 0.02], material=NYLON, normal=DOWN, mass=mass
    ),
    "rod": lambda mass: shapes.rod(
        length=0.1, radius=0.02, end_radius=0.02, material=NYLON, normal=DOWN, axis=[0, 0, 1],
        mass=mass,
    ),
    "disc": lambda mass: shapes.disc(
        radius=0.02, thickness=0.02, rim_radius=2e-3, material=NYLON, normal=DOWN,
        axis=[0.3, 0, 1], mass=mass,
    ),
    "box": lambda mass: shapes.box(
        sides=[0.04, 0.04, 0.04], corner_radius=2e-3, material=NYLON, normal=[1, 2, -3], mass=mass
    ),
    "numbers": lambda mass: (
        RigidBody(
            mass=7.6e-2 if mass is None else mass,
            inertia=0.4 * (7.6e-2 if mass is None else mass) * 0.025**2 * np.eye(3),
            material=NYLON, curvature_radius=0.02,
        ),
        np.array([0.0, 0.0, -0.02]),
    ),
}  # fmt: skip
OF_SHELL = "may be a shell"


def met_with(name, mass, target=None, count=None):
    """Return the encounter of a body of a mass in kg, one or many, with a plane or a target."""
    body, contact = TABLE_TENNIS[name](mass)
    outward = [1, 2, -3] if name == "box" else DOWN
    velocity = np.array([0.5, 0.0, -2.0]) if count is None else np.full((count, 3), (0.5, 0, -2.0))
    return Encounter(body, target or HalfSpace(NYLON), 0.2, normal=outward, contact=contact,
                     velocity=velocity)  # fmt: skip


@pytest.mark.parametrize("count", [None, 3])
@pytest.mark.parametrize("name", TABLE_TENNIS)
def test_a_shell_of_any_shape_is_cautioned_and_a_solid_is_not(name, count):
    hollow, solid = met_with(name, 2.7e-3, count=count), met_with(name, None, count=count)
    for said in (Simulation().plan(hollow.scene), collide(hollow).plan, collide(hollow)):
        assert OF_SHELL in str(said.cautions)
    assert "shell" not in str(Simulation().plan(solid.scene))
    thick = met_with(name, 0.75 * float(solid.body.mass), count=count)
    assert "shell" not in str(collide(thick).plan)


def test_a_shell_is_cautioned_beside_any_other_body_and_of_a_density_that_is_known_of_some():
    ball = Sphere(0.02, NYLON, mass=2.7e-3)
    struck = met_with("box", None, target=ball)
    assert "target.mass is 0.071 of" in str(collide(struck).plan.cautions)
    box = met_with("box", 2.7e-3, target=Sphere(0.02, NYLON))
    assert "body.mass is 0.0" in str(collide(box).plan.cautions)
    some = attrs.evolve(NYLON, density=[1140.0, np.nan])
    scene = Scene(Sphere(0.02, some, mass=2.7e-3), HalfSpace(NYLON), 0.2, [1.0, 2.0])
    assert "sphere.mass is 0.071 of" in str(Simulation().plan(scene).cautions)


def test_a_shell_in_a_file_is_cautioned(tmp_path):
    path = tmp_path / "shell.toml"
    path.write_text(
        "[body]\nmass = 0.0027\nprincipal = [4.3e-7, 4.3e-7, 4.3e-7]\ncurvature_radius = 0.02\n"
        "material = {young_modulus = 2.5e9, poisson_ratio = 0.4, density = 1140.0}\n"
        "[target]\nkind = 'half-space'\nmaterial = 'steel'\n"
        "[impact]\nfriction_coefficient = 0.2\nnormal = [0, 0, -1]\ncontact = [0, 0, -0.02]\n"
        "velocity = [0.5, 0, -2]\n",
        encoding="utf-8",
    )
    assert OF_SHELL in str(Simulation().plan(read_scene(path).scene).cautions)
