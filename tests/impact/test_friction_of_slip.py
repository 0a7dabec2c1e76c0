"""A friction coefficient as a function, or a table, of the slip speed before the impact."""

import pickle

import attrs
import numpy as np
import pytest

from contactlab import Encounter, HalfSpace, Material, Scene, Simulation, Sphere, collide, shapes
from contactlab.outcome.columns import columns
from contactlab.scene_file import read_scene

STEEL = Material.named("steel")
BALL, WALL = Sphere(0.01, STEEL), HalfSpace(STEEL)
ANGLES = np.array([10.0, 30.0, 60.0])
SLIPS = np.sin(np.radians(ANGLES))
TABLE = {0.0: 0.4, 0.5: 0.3, 2.0: 0.15}


def stribeck(slip):
    return 0.1 + 0.3 * np.exp(-slip / 0.5)


def scene(friction, angle_deg=ANGLES, **motion):
    return Scene.at_angle(BALL, WALL, friction, speed=1.0, angle_deg=angle_deg, **motion)


@pytest.mark.parametrize(
    ("friction", "expected"),
    [
        (stribeck, stribeck(SLIPS)),
        (lambda _: 0.2, [0.2] * 3),
        (TABLE, np.interp(SLIPS, list(TABLE), list(TABLE.values()))),
    ],
    ids=["function", "constant", "table"],
)
def test_each_impact_has_the_number_of_its_slip(friction, expected):
    batch = scene(friction)
    assert batch.friction_coefficient == pytest.approx(np.array(expected), rel=1e-14)
    by_numbers = scene(np.array(expected))
    assert Simulation().run(batch).psi2 == pytest.approx(Simulation().run(by_numbers).psi2)
    one = scene(friction, 30.0)
    assert type(one.friction_coefficient) is float
    assert one.friction_coefficient == pytest.approx(expected[1], rel=1e-14)


def test_the_slip_is_that_of_the_surface():
    assert scene(stribeck, 0.0, spin=20.0).friction_coefficient == pytest.approx(stribeck(0.2))
    assert scene(stribeck, -30.0).friction_coefficient == pytest.approx(stribeck(0.5))


def test_encounters_of_spheres_and_of_bodies():
    velocity = [[1.0, 0.3, 0.4], [1.0, 0.0, -1.0]]
    met = Encounter(BALL, BALL, stribeck, normal=[1, 0, 0], velocity=velocity)
    numbers = stribeck(np.array([0.5, 1.0]))
    assert met.friction_coefficient == pytest.approx(numbers)
    assert met.scene.friction_coefficient == pytest.approx(numbers)
    by_numbers = attrs.evolve(met, friction_coefficient=numbers)
    assert collide(met).velocity == pytest.approx(collide(by_numbers).velocity, abs=1e-14)
    rod, contact = shapes.rod(
        radius=0.01, length=0.1, normal=[0, 0, -1], axis=[0.6, 0.0, 0.8], material=STEEL
    )
    dropped = Encounter(
        rod, WALL, stribeck, normal=[0, 0, -1], velocity=[0.7, 0, -1], contact=contact
    )
    assert dropped.friction_coefficient == pytest.approx(stribeck(0.7))
    assert dropped.scene.friction_coefficient == pytest.approx(stribeck(0.7))


def test_other_velocities_have_their_own_and_another_friction_takes_its_place():
    batch = scene(stribeck)
    slower = attrs.evolve(batch, tangential_velocity=0.5 * batch.tangential_velocity)
    assert slower.friction_coefficient == pytest.approx(stribeck(0.5 * SLIPS))
    assert attrs.evolve(batch, friction_coefficient=0.3).friction_coefficient == 0.3
    turned = attrs.evolve(attrs.evolve(batch, friction_coefficient=0.3), tangential_velocity=0.1)
    assert turned.friction_coefficient == 0.3
    assert batch.take(1).friction_coefficient == pytest.approx(stribeck(SLIPS[1]))
    again = attrs.evolve(batch.take(slice(0, 2)), tangential_velocity=0.1)
    assert again.friction_coefficient == pytest.approx(np.full(2, stribeck(0.1)))


def test_stacks_grids_and_pickles():
    one, other = scene(stribeck, 30.0), scene(lambda _: 0.2, 30.0)
    assert Scene.stack([one, other]).friction_coefficient == pytest.approx([stribeck(0.5), 0.2])
    grid = Scene.grid(BALL, WALL, friction_coefficient=stribeck, speed=[1.0, 2.0], angle_deg=[30.0])
    assert grid.friction_coefficient == pytest.approx(stribeck(np.array([0.5, 1.0])))
    sent = pickle.loads(pickle.dumps(scene(lambda slip: 0.1 + slip)))
    assert sent.friction_coefficient == pytest.approx(0.1 + SLIPS)


def test_results_files_and_stores_have_the_numbers(tmp_path):
    result = Simulation().run(scene(stribeck))
    name, unit, values = columns(result)[0]
    assert (name, unit) == ("friction_coefficient", "1")
    assert values == pytest.approx(stribeck(SLIPS))
    assert "friction_coefficient" not in {
        name for name, *_ in columns(Simulation().run(scene(0.2)))
    }
    # A store is known by the numbers: any function that gives them is the same sweep.
    kept = Simulation().sweep(scene(stribeck), keep=tmp_path)
    assert kept.psi2.tolist() == result.psi2.tolist()
    with pytest.raises(ValueError, match="keep"):
        Simulation().sweep(scene(lambda slip: 0.5 * stribeck(slip)), keep=tmp_path)
    Simulation().sweep(scene(lambda slip: stribeck(slip)), keep=tmp_path)


TOML = """
sphere = {{radius = 0.01, material = "steel"}}
target = {{kind = "half-space", material = "steel"}}
[impact]
friction_coefficient = {friction}
speed = 1.0
angle_deg = 30
{sweep}
"""


def file(path, friction, sweep=""):
    (path / "scene.toml").write_text(TOML.format(friction=friction, sweep=sweep))
    return read_scene(path / "scene.toml").scene


def test_tables_of_scene_files(tmp_path):
    pairs = [[0.0, 0.4], [0.5, 0.3], [2.0, 0.15]]
    assert file(tmp_path, pairs).friction_coefficient == pytest.approx(0.3)
    swept = file(tmp_path, pairs, "[sweep]\nangle_deg = [10, 30, 60]")
    assert swept.friction_coefficient == pytest.approx(scene(TABLE).friction_coefficient)
    over = file(tmp_path, pairs, "[sweep]\nfriction_coefficient = [0.1, 0.2]")
    assert over.friction_coefficient.tolist() == [0.1, 0.2]


@pytest.mark.parametrize(
    ("friction", "words"),
    [
        ([0.1, 0.2], "must be one number, or pairs of slip speed and mu"),
        ([[0.1, 0.2]], "must be two or more pairs of speed and mu"),
        ([[0.1, 0.2], [0.1, 0.3]], "has a slip speed twice"),
        ([[0.1, 0.2], [0.2, 0.3]], "has speeds from 0.1 to 0.2 m/s, and an impact has 0.5 m/s"),
    ],
)
def test_bad_tables_of_scene_files(tmp_path, friction, words):
    with pytest.raises(ValueError, match=r"impact\.friction_coefficient") as refused:
        file(tmp_path, friction)
    assert words in str(refused.value)


@pytest.mark.parametrize(
    ("friction", "words"),
    [
        (lambda slip: -slip, "must be zero or positive"),
        (lambda slip: np.nan * slip, "must be zero or positive"),
        (lambda _: "much", "must be a real number"),
        (lambda _: None, "must be a real number"),
        (lambda slip: slip[:2], "must be one number, or of the shape (3,)"),
        (lambda _: 1.0 / 0, "raised ZeroDivisionError at speeds before the impact"),
        ({0.1: 0.2}, "must be two or more pairs"),
        ({0.1: 0.2, 0.6: 0.1}, "an impact has 0.866 m/s; add its mu to the table"),
        ({0.0: 0.2, "fast": 0.1}, "friction_coefficient"),
        ({0.0: 0.2, 1.0: -0.1}, "must be zero or positive"),
    ],
)
def test_bad_friction(friction, words):
    with pytest.raises(ValueError, match="friction_coefficient = ") as refused:
        scene(friction)
    assert words in str(refused.value)


def test_a_scene_without_units_has_no_slip_speed():
    with pytest.raises(ValueError, match="friction_coefficient"):
        Scene.nondimensional(psi1=1.0, chi=1.44, poisson_ratio=0.3, friction_coefficient=stribeck)
