"""Every refusal of a body, a scene, a grid, an encounter or a material: name, rule and remedy."""

import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Material, RigidBody, Scene, Simulation, Sphere, shapes
from contactlab.impact import grid
from contactlab.impact import material as materials

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
BALL, PLATE = Sphere(0.01, STEEL), HalfSpace(STEEL)
BARE = Scene.nondimensional(psi1=1.0, chi=1.0)
MADE = Scene(BALL, PLATE, 0.2, 1.0)
AXIS = (0.0, 0.0, 1.0)
OWN = "or give your own: Material(young_modulus=..., poisson_ratio=..., density=...)"
BOTH = "give speed in m/s and angle_deg in degrees from the normal"


def met(**changes):
    given = {"normal": AXIS, "velocity": (0.0, 0.0, 1.0)}
    return Encounter(changes.pop("body", BALL), changes.pop("target", PLATE), 0.2,
                     **(given | changes))  # fmt: skip


def angled(**changes):
    return Scene.at_angle(BALL, PLATE, 0.2, **({"speed": 1.0, "angle_deg": 30.0} | changes))


REFUSED = [
    *(
        (
            lambda radius=radius: Sphere(radius, STEEL, mass=1.0),
            f"radius = {radius}: must be positive and finite, at most 1e100; give it in m",
        )
        for radius in (0.0, 1e101)
    ),
    (
        lambda: Sphere(0.01, "steel"),
        "material = 'steel': must be a Material; make one, Material(...), or by its name: "
        "Material.named('steel')",
    ),
    *(
        (
            make,
            "material = 'steel': must be a Material; make one, Material(...), or by its name: "
            "Material.named('steel')",
        )
        for make in (
            lambda: shapes.rod(
                length=0.1, radius=0.01, material="steel", normal=[0, 0, -1], axis=[1, 0, 1]
            ),
            lambda: shapes.disc(
                radius=0.1,
                thickness=0.05,
                rim_radius=0.01,
                material="steel",
                normal=[0, 0, -1],
                axis=[1, 0, 1],
            ),
            lambda: shapes.ellipsoid(
                semi_axes=(0.1, 0.1, 0.1), material="steel", normal=[0, 0, -1]
            ),
        )
    ),
    (
        lambda: RigidBody(mass=1.0, inertia=[1.0, 1.0, 1.0], material=STEEL),
        "inertia.shape = (3,): must end with (3, 3); give an array of shape (..., 3, 3) in kg m²; "
        "three moments are principal=[...]",
    ),
    (
        lambda: Sphere(0.01, Material(young_modulus=1e9, poisson_ratio=0.3)),
        "mass = None: is needed where the material has no density; give Sphere(mass=...) in kg "
        "or Material(density=...) in kg/m³",
    ),
    (
        lambda: Sphere(1e-110, STEEL),
        "radius, density = (1e-110, 7850.0): floating point cannot hold the mass that follows; "
        "check the units, or give mass",
    ),
    (
        lambda: Sphere(0.01, STEEL, gyration_ratio=1.5),
        "gyration_ratio = 1.5: must lie in (0, 1]: radius of gyration over radius, 1 with all "
        "mass at the surface; it has no unit",
    ),
    (
        lambda: Material(poisson_ratio=0.3),
        "shear_modulus, young_modulus = (None, None): exactly one of the two must be given; leave "
        "one out; the other follows from E = 2 G (1 + nu)",
    ),
    (
        lambda: Material(shear_modulus=1.0, young_modulus=2.0, poisson_ratio=0.3),
        "shear_modulus, young_modulus = (1.0, 2.0): exactly one of the two must be given; leave "
        "one out; the other follows from E = 2 G (1 + nu)",
    ),
    (
        lambda: Material(young_modulus=1e9, poisson_ratio=-1.0),
        "young_modulus = 1000000000.0: does not determine the shear modulus at poisson_ratio = "
        "-1; give shear_modulus instead",
    ),
    (
        lambda: Material(young_modulus=0.0, poisson_ratio=0.3),
        "young_modulus = 0.0: must be positive and finite; give it in Pa",
    ),
    (
        lambda: Material(shear_modulus=-1.0, poisson_ratio=0.3),
        "shear_modulus = -1.0: must be positive and finite; give it in Pa",
    ),
    (
        lambda: Material(young_modulus=1e9, poisson_ratio=0.6),
        "poisson_ratio = 0.6: must lie in [-1, 0.5], the range of a stable isotropic solid; "
        "it has no unit",
    ),
    (
        lambda: materials.entry(3),
        "name = 3: must be the name of a material; such as 'steel'",
    ),
    (
        lambda: materials.entry("Aluminum_Oxide"),
        "name = 'Aluminum_Oxide': is listed as 'alumina'; write that name",
    ),
    (lambda: angled(angle_deg=90.0),
     f"angle_deg = 90.0: must lie between -90 and 90, measured from the normal; {BOTH}"),
    (lambda: angled(speed=0.0), f"speed = 0.0: must be positive and finite; {BOTH}"),
    (
        lambda: angled(speed=[1.0, 2.0], angle_deg=[1.0, 2.0, 3.0]),
        "Scene.at_angle: the shapes of speed (2,), angle_deg (3,) must broadcast to one; give "
        "arrays of equal length, or every combination by Scene.grid(ball, plate, "
        "friction_coefficient=0.2, speed=[1, 2], angle_deg=[10, 20])",
    ),
    (
        lambda: Scene(BALL, PLATE, 0.2, [1.0, 2.0], [1.0, 2.0, 3.0]),
        "Scene: the shapes of normal_speed (2,), tangential_velocity (3,) must broadcast to one; "
        "give numbers, or arrays of equal length",
    ),
    *(
        (
            lambda each=each: Scene.nondimensional(psi1=[1.0, 2.0, 3.0], chi=1.4, **each),
            f"Scene.nondimensional: the shapes of psi1 (3,), {next(iter(each))} (2,) must "
            "broadcast to one; give arrays of equal length",
        )
        for each in (
            {"poisson_ratio": [0.1, 0.2]},
            {"friction_coefficient": [0.1, 0.2]},
            {"lam": [0.1, 0.2], "rho": 0.1},
            {"eta": [0.1, 0.2], "lam": 0.1},
        )
    ),
    (
        lambda: Scene(Sphere([], STEEL), PLATE, 0.2, 1.0),
        "shape = (0,): a scene must hold at least one impact",
    ),
    (
        lambda: Scene(None, None, 0.2, 1.0),
        "sphere, target = (None, None): both bodies must be given; or use "
        "Scene.nondimensional(psi1=, chi=)",
    ),
    (lambda: Scene(3, PLATE, 0.2, 1.0), "sphere = 3: must be a Sphere; make one: Sphere(...); of "
     "other bodies take Encounter(...).scene"),
    (
        lambda: Scene(BALL, 3, 0.2, 1.0),
        "target = 3: must be a HalfSpace or a Sphere; make one: HalfSpace(material)",
    ),
    (
        lambda: Scene(None, None, 0.2, 1.0, pair=3),
        "pair = 3: must be a Pair; or leave it out",
    ),
    (
        lambda: Scene.nondimensional(psi1="a", chi=1.0),
        "psi1 = 'a': must be a real number; give the non-dimensional angle of incidence, eq. (29) "
        "of the paper",
    ),
    (
        lambda: Scene.nondimensional(psi1=1.0, chi=0.0),
        "chi = 0.0: must be positive and finite; chi of eq. (38); 1.4412 for a solid sphere, "
        "nu = 0.3",
    ),
    (
        lambda: Scene.nondimensional(psi1=1.0, chi=1.0, coupling_number="a"),
        "coupling_number = 'a': must be a real number; Lambda = kappa beta/mu; 0 for like bodies",
    ),
    (
        lambda: Scene.nondimensional(psi1=1.0, chi=1.0, friction_coefficient=0.0),
        "friction_coefficient = 0.0: must be positive and finite",
    ),
    (lambda: Scene.stack(3), "scenes = 3: must be a sequence of Scene"),
    (lambda: Scene.stack([]), "scenes = []: must hold at least one Scene"),
    (lambda: Scene.stack([BARE, 3]), "scenes[1] = 3: must be a Scene"),
    (
        lambda: Scene.stack([BARE, Scene.nondimensional(psi1=[1.0, 2.0], chi=1.0)]),
        "scenes[1] = (2,): must be a single impact; batches go one after another into a folder: "
        "sweep(scenes, into=...)",
    ),
    (
        lambda: Scene.grid(psi1=1.0, chi=1.0),
        "entries = ('psi1', 'chi'): none of them varies; give a list of one or more",
    ),
    (
        lambda: Scene.grid(psi1=[[1.0]], chi=1.0),
        "psi1 = [[1.0]]: must be a number or a plain list of numbers",
    ),
    (
        lambda: Scene.nondimensional(psi1=[1.0, 2.0], chi=1.0).with_index([1, 2, 3]),
        "index = [1, 2, 3]: must be whole numbers of the shape (2,); such as scene.index of the "
        "whole batch",
    ),
    (
        lambda: BARE.with_index(0.5),
        "index = 0.5: must be whole numbers of the shape (); such as scene.index of the whole "
        "batch",
    ),
    (
        lambda: met(target_spin=AXIS),
        f"target_spin = {np.array(AXIS)!r}: must be zero: a half-space does not spin; give "
        "target_velocity, that of its surface at the contact",
    ),
    (
        lambda: met(normal=(0.0, 0.0, 9e-101)),
        "normal = [0.0, 0.0, 9e-101]: must be at least 1e-100 long, not zero; two bodies at one "
        "place have no normal",
    ),
    (lambda: met(body=PLATE).body, f"body = {str(PLATE)[:77]}...: must be a Sphere or a RigidBody; "
     "make one: Sphere(...)"),
    (
        lambda: met(velocity=(0.0, 0.0, -2.0)).scene,
        "velocity, target_velocity = -2.0: bodies separate: the speed of approach, in m/s, must be "
        "positive; turn normal from the first body to the target, or let such pairs pass: "
        "collide(encounter, separating='pass')",
    ),
    (
        lambda: met(velocity=[AXIS, (1.0, 0.0, 0.0), (1.0, 0.0, 0.0)]).scene,
        "velocity, target_velocity = 0.0: bodies separate, or rest: the speed of approach, in m/s, "
        "must be positive (the first of 2 has index [1]); let such pairs pass: collide(encounter, "
        "separating='pass')",
    ),
    (
        lambda: met(velocity=[AXIS] * 2, spin=[AXIS] * 3),
        "Encounter: the batch shapes of velocity (2,), spin (3,) must broadcast to one; give one "
        "vector, or as many as there are encounters",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("make", "words"), REFUSED, ids=[words[:40] for _, words in REFUSED])
def test_a_refusal_names_value_rule_and_remedy(make, words):
    with pytest.raises(ValueError, match=" ") as caught:
        make()
    assert str(caught.value) == words


@pytest.mark.parametrize(
    ("scenes", "words"),
    [
        (
            [MADE, BARE],
            ": must have a sphere if, and only if, scenes[0] has: else spin would be lost; give "
            "all of spheres, all of other bodies, or all by psi1 and chi",
        ),
        (
            [BARE, Scene.nondimensional(psi1=1.0, chi=1.0, friction_coefficient=0.1)],
            ": must have a friction coefficient if, and only if, scenes[0] has; give "
            "friction_coefficient to every Scene.nondimensional, or to none",
        ),
    ],
)
def test_scenes_of_two_sorts_are_not_stacked(scenes, words):
    for order in (scenes, scenes[::-1]):
        with pytest.raises(ValueError, match=r"^scenes\[1\] = Scene\(") as caught:
            Scene.stack(order)
        assert str(caught.value).endswith(words)


def test_a_grid_has_at_most_so_many_impacts(monkeypatch):
    monkeypatch.setattr(grid, "MOST_IMPACTS", 6)
    assert Scene.grid(psi1=[1.0, 2.0, 3.0], chi=[1.0, 2.0]).shape == (6,)
    with pytest.raises(ValueError, match=r"^product = 8: must be at most 6 impacts; vary less,"):
        Scene.grid(psi1=[1.0, 2.0, 3.0, 4.0], chi=[1.0, 2.0])


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("glass", "did you mean 'soda-lime glass' or 'borosilicate glass'"),
        ("steal", "did you mean 'steel'? "),
        ("qqq", "known: steel"),
    ],
)
def test_a_material_that_is_not_listed_has_the_nearest_ones(name, hint):
    with pytest.raises(ValueError, match=rf"^name = '{name}': no such material; ") as caught:
        Material.named(name)
    words = str(caught.value)
    assert words.partition("; ")[2].startswith(hint)
    assert words.endswith(f"known: {', '.join(materials.names())}; {OWN}")


@pytest.mark.parametrize(("moment", "told"), [(1e-15, True), (1e-6, False)])
def test_a_moment_that_hardly_resists_is_told_before_a_run(moment, told):
    """Of a needle that is met aside: its steps are raised with the root of chi."""
    needle = RigidBody(
        mass=1.0, principal=[1e-3, 1e-3, moment], material=STEEL, curvature_radius=0.01
    )
    about = {"normal": (0, 0, -1), "velocity": (1.0, 0, -1), "contact": (0.003, 0.002, -0.01)}
    met = Encounter(needle, HalfSpace(STEEL), 0.1, **about)
    cautions = " ".join(map(str, Simulation().plan(met.scene).cautions))
    assert ("least radius of gyration" in cautions) is told
    assert ("steps raised" in cautions) is told
