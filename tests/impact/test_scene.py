"""Scenes: incidence, the paper's own parameters, batches."""

import math
import pickle

import attrs
import numpy as np
import pytest

from contactlab import HalfSpace, Material, Scene, Sphere
from contactlab.impact import hertz as closed_forms
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import entry_unit
from tests.solve.any_scene import BATCHES, ONES, one

STEEL = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
BALL = Sphere(0.01, STEEL)
PLATE = HalfSpace(STEEL)


def scene(**changes):
    arguments = {"friction_coefficient": 0.2, "normal_speed": 1.5, "tangential_velocity": 0.5}
    return Scene(BALL, PLATE, **(arguments | changes))


def test_psi1_is_eq_29():
    assert scene().psi1 == pytest.approx(2 * 0.7 * 0.5 / (0.2 * 1.7 * 1.5), rel=1e-14)


def test_spin_counts_through_the_local_velocity():
    """Eq. (20): v_x = v + omega R; spin alone, and spin that cancels the velocity."""
    assert scene(tangential_velocity=0.0, spin=50.0).psi1 == pytest.approx(scene().psi1)
    assert scene(spin=-50.0).psi1 == 0.0


def size_ratio(given):
    return hertz_scales(given).radius / given.pair.radius


def test_size_duration_and_radius_are_eqs_7_to_9():
    given = scene()
    shear, mass = STEEL.shear_modulus, BALL.mass
    size = (15 * mass * 1.5**2 * 0.7 / (16 * shear * 0.01**3)) ** 0.2
    scales = hertz_scales(given)
    assert size_ratio(given) == pytest.approx(size, rel=1e-14)
    assert scales.radius == pytest.approx(size * 0.01, rel=1e-14)
    constant = 4 * math.gamma(0.4) * math.sqrt(math.pi) / (5 * math.gamma(0.9))
    assert scales.duration == pytest.approx(constant * size**2 * 0.01 / 1.5, rel=1e-14)
    assert constant == pytest.approx(2.9432751843, abs=1e-10)


def test_size_does_not_underflow_at_tiny_speeds():
    """v1² underflows below 1e-162, C does not (theory §8)."""
    pair = scene().pair
    tiny, plain = (
        closed_forms.size_ratio(pair.normal_mass, pair.effective_modulus, pair.radius, speed)
        for speed in (1e-200, 1.5)
    )
    assert tiny == pytest.approx(plain * (1e-200 / 1.5) ** 0.4)


@pytest.mark.parametrize("psi1", [0.0, 1.2, -3.0, 1e-300, 1e16])
@pytest.mark.parametrize("chi", [0.05, 1.4411764706, 1e4])
def test_nondimensional_round_trip(psi1, chi):
    given = Scene.nondimensional(psi1=psi1, chi=chi)
    assert given.psi1 == psi1
    assert given.chi == pytest.approx(chi, rel=1e-15)
    assert size_ratio(given) == pytest.approx(1.0, rel=1e-15)


def test_no_friction_makes_psi_infinite_but_not_nan():
    assert scene(friction_coefficient=0).psi1 == math.inf
    assert scene(friction_coefficient=0, tangential_velocity=0).psi1 == 0.0


@pytest.mark.parametrize("bad", [math.nan, math.inf, -0.1, "0.1", None, 1j, []])
@pytest.mark.parametrize("name", ["friction_coefficient", "normal_speed"])
def test_bad_number_is_refused_by_name(name, bad):
    with pytest.raises(ValueError, match=name):
        scene(**{name: bad})


BARE = Scene.nondimensional(psi1=1.0, chi=1.0)
REFUSED = [
    (lambda: scene(normal_speed=0.0), r"normal_speed = 0\.0: must be positive and finite"),
    (lambda: scene(tangential_velocity=1.797e308, spin=1.7e308), "tangential_velocity"),
    (lambda: scene(tangential_velocity=[1.0, 2.0], spin=[1.0, 2.0, 3.0]), "broadcast"),
    (lambda: Scene.nondimensional(psi1=math.nan, chi=1.0), "psi1"),
    (lambda: Scene.nondimensional(psi1=1.0, chi=0.0), "chi"),
    (lambda: Scene.nondimensional(psi1=1.0, chi=-1.0), "chi"),
    (lambda: Scene.nondimensional(psi1="a", chi=1.0), "psi1"),
    (lambda: Scene(PLATE, PLATE, 0.1, 1.0), "sphere"),
    (lambda: Scene(BALL, STEEL, 0.1, 1.0), "target"),
    (lambda: Scene(None, PLATE, 0.1, 1.0), "both bodies"),
    (lambda: Scene(None, None, 0.2, 1.0, 0.3, pair=3.0), "pair"),
    (
        lambda: Scene(BALL, BALL, np.full(3, 0.1), np.ones(2)),
        r"friction_coefficient \(3,\), normal_speed \(2,\)",
    ),
    # The spin of the scene with bodies would be lost.
    (lambda: Scene.stack([scene(), BARE]), r"scenes\[1\].*must have a sphere"),
    (lambda: Scene.stack([BARE, scene()]), r"scenes\[1\].*must have a sphere"),
    (lambda: Scene.stack(None), "scenes = "),
    (lambda: Scene.stack(3), "scenes = "),
    (lambda: Scene.stack([scene(), 3.0]), r"scenes\[1\]"),
    (lambda: Scene.stack([]), "at least one"),
]


@pytest.mark.parametrize(("make", "words"), REFUSED)
def test_bad_input_is_refused_by_name(make, words):
    with pytest.raises(ValueError, match=words):
        make()


def test_other_bodies_make_another_pair():
    """A scene derived from one with other bodies must not keep the masses of the old ones."""
    steel = Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0)
    numbers = {"friction_coefficient": 0.2, "normal_speed": 1.0, "tangential_velocity": 0.3}
    small = Scene(Sphere(0.01, steel), HalfSpace(steel), **numbers)
    large = Scene(Sphere(0.1, steel), HalfSpace(steel), **numbers)
    assert attrs.evolve(small, sphere=large.sphere) == large
    assert Scene(small.sphere, small.target, **numbers, pair=large.pair) == small


def test_arrays_make_a_batch():
    batch = scene(tangential_velocity=np.linspace(0.0, 1.0, 5))
    assert batch.shape == (5,)
    assert batch.psi1[2] == pytest.approx(scene().psi1)


def test_stack_merges_what_differs():
    heavy = Sphere(0.02, Material(young_modulus=70e9, poisson_ratio=0.25, density=2500.0))
    one, two = scene(), Scene(heavy, BALL, 0.1, 2.0, spin=4.0)
    batch = Scene.stack([one, two])
    assert batch.shape == (2,)
    for name in ("psi1", "chi", "slip_velocity"):
        expected = [getattr(one, name), getattr(two, name)]
        assert getattr(batch, name) == pytest.approx(np.array(expected), rel=1e-15)
    scales = zip(*map(hertz_scales, (batch, one, two)), strict=True)
    for together, first, second in scales:
        assert together == pytest.approx(np.array([first, second]), rel=1e-15)
    assert batch.take(slice(1, 2)).psi1 == pytest.approx(np.array([two.psi1]))


def test_scenes_that_are_equal_have_one_hash():
    one, two = scene(), scene()
    assert one == two
    assert len({one, two}) == 1
    batch = Scene.nondimensional(psi1=np.array([1.0, 0.0]), chi=1.0)
    assert batch == Scene.nondimensional(psi1=np.array([1.0, -0.0]), chi=1.0)
    assert len({batch, Scene.nondimensional(psi1=np.array([1.0, 2.0]), chi=1.0)}) == 2
    assert len({batch, Scene.nondimensional(psi1=np.array([1.0, 1e-200]), chi=1.0)}) == 2


def test_masked_entries_are_refused():
    """They would be taken for data."""
    masked = np.ma.array([0.5, 99.0], mask=[False, True])
    with pytest.raises(ValueError, match=r"psi1 = .*masked"):
        Scene.nondimensional(psi1=masked, chi=1.0)
    assert Scene.nondimensional(psi1=masked[:1], chi=1.0).shape == (1,)


def test_an_impact_of_a_grid_has_the_numbers_of_its_row_and_column():
    grid = Scene.nondimensional(psi1=np.array([[0.5], [1.5]]), chi=np.array([[1.0, 2.0, 3.0]]))
    one = grid.take((1, 2))
    assert (one.psi1, one.chi) == (pytest.approx(1.5), pytest.approx(3.0))
    some = grid.take(np.array([[False, True, False], [False, False, True]]))
    assert some.chi == pytest.approx([2.0, 3.0])


def test_parts_of_a_batch_of_shared_numbers_keep_their_shape_and_places():
    """A spin for each of three impacts, of which none differs in a number that is taken."""
    batch = scene(tangential_velocity=np.array([[0.5], [1.0]]), spin=np.zeros((1, 3)))
    assert batch.shape == (2, 3)
    assert batch.take(slice(0, 2)) is batch
    assert batch.take((1, 2)).index == 5
    assert batch.take(slice(1, 2)).index.tolist() == [[3, 4, 5]]
    assert batch.take(np.eye(2, 3, dtype=bool)).tangential_velocity.tolist() == [0.5, 1.0]
    renamed = batch.with_index(np.arange(6).reshape(2, 3) + 10)
    assert renamed.take((0, 1)).index == 11
    assert renamed == batch
    yielding = Scene(
        Sphere(0.01, Material(young_modulus=208e9, poisson_ratio=0.3, density=7850.0,
                              yield_stress=[1e9, 2e9, 3e9])), PLATE, 0.2, 1.5,
    )  # fmt: skip
    assert yielding.take(slice(1, 3)).shape == (2,)


def test_psi_of_a_velocity():
    """kappa/(mu v1), eq. (29), with kappa = 14/17: of numbers, arrays, and without friction."""
    unit = 14.0 / 17.0 / (0.2 * 1.5)
    assert scene().psi_scale == pytest.approx(unit)
    assert scene().psi(2.0) == pytest.approx(2.0 * unit)
    assert scene().psi(np.array([0.0, 2.0])) == pytest.approx([0.0, 2.0 * unit])
    batch = scene(normal_speed=[1.5, 3.0])
    assert batch.psi_scale == pytest.approx([unit, 0.5 * unit])
    assert batch.psi(2.0) == pytest.approx([2.0 * unit, unit])
    assert batch.psi(0.0).tolist() == [0.0, 0.0]
    free = scene(friction_coefficient=0.0)
    assert (free.psi_scale, free.psi(0.0), free.psi(-1.0)) == (math.inf, 0.0, -math.inf)
    mixed = scene(friction_coefficient=[0.0, 0.2])
    assert mixed.psi(1.0) == pytest.approx([math.inf, unit])
    assert type(scene().psi1) is float


def test_the_units_of_entries():
    units = {
        "sphere.radius": "m", "normal_speed": "m/s", "spin": "rad/s", "speed": "m/s",
        "angle_deg": "deg", "psi1": "1", "target.material.density": "kg/m³", "mass": "kg",
        "sphere.material.young_modulus": "Pa", "friction_coefficient": "1",
    }  # fmt: skip
    assert {name: entry_unit(name) for name in units} == units


OTHERS = [
    ("central", {"psi1": 1.6}),
    ("central", {"chi": 1.5}),
    ("planar", {"psi1": 1.6}),
    ("planar", {"lam": 0.4, "eta": 1.0}),
    ("planar", {"eta": 0.6}),
    ("space", {"psi1": (0.8, 1.7)}),
    ("space", {"lam": (-0.2, 0.2)}),
    ("space", {"chi": [[0.6, 0.1], [0.1, 0.9]]}),
    ("space", {"rho": 0.2}),
]


@pytest.mark.parametrize(("kind", "changes"), OTHERS)
def test_scenes_are_equal_if_their_numbers_are(kind, changes):
    scene = one(kind)
    assert scene == one(kind) == attrs.evolve(scene) == pickle.loads(pickle.dumps(scene))
    assert hash(scene) == hash(one(kind))
    assert {scene: 1}[one(kind)] == 1
    other = one(kind, **changes)
    assert scene != other
    assert len({scene, other}) == 2


def test_scenes_of_other_kinds_are_not_equal():
    assert len(set(ONES.values())) == 3
    assert len(set(BATCHES.values())) == 4
    batch = BATCHES["mixed"]
    assert batch == attrs.evolve(batch) == Scene.stack(list(ONES.values()))
    assert batch != Scene.stack(list(reversed(ONES.values())))
    assert batch != BATCHES["space"]
