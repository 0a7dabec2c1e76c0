"""Every kind of number at every public door: the value of plain floats, or one refusal."""

import numpy as np
import pytest

import contactlab
from contactlab import (
    Encounter,
    HalfSpace,
    Material,
    Scene,
    Simulation,
    Sphere,
    collide,
    load_path,
    rebound,
    shapes,
)
from tests.present import extra

needs_pandas = extra("pandas")
STEEL = Material.named("steel")
BALL, PLATE = Sphere(0.01, STEEL), HalfSpace(STEEL)
#: One number in many kinds; float32 holds it exactly, as it holds the arrays below.
ONE = {
    "float": 1.25,
    "float64": np.float64(1.25),
    "float32": np.float32(1.25),
    "0-d": np.array(1.25),
    "0-d float32": np.array(1.25, dtype=np.float32),
}
VALUES = [0.5, 1.25, 3.0]
_PLAIN = np.array(VALUES)
MANY = {
    "list": VALUES,
    "tuple": tuple(VALUES),
    "array": _PLAIN,
    "float32": _PLAIN.astype(np.float32),
    "big-endian": _PLAIN.astype(">f8"),
    "strided": np.repeat(_PLAIN, 2)[::2],
    "reversed": _PLAIN[::-1].copy()[::-1],
    "unmasked": np.ma.array(VALUES, mask=False),
}
MANY["read-only"] = _PLAIN.copy()
MANY["read-only"].flags.writeable = False
#: Made by pandas, which is an extra; other indices: ``tests/collisions/test_labelled.py``.
OF_PANDAS = {
    "series": lambda pandas: pandas.Series(VALUES),
    "column": lambda pandas: pandas.DataFrame({"a": VALUES})["a"],
}
KINDS = [*MANY, *(pytest.param(kind, marks=needs_pandas) for kind in OF_PANDAS)]


class WithUnit(np.ndarray):
    """An array as those of astropy and unyt, which NumPy reads as plain numbers."""

    unit = "mm"


class Quantity:
    """A number as those of pint, which NumPy reads as a plain one."""

    units, magnitude = "millimeter", 1.25

    def __array__(self, *_, **__):
        return np.array(self.magnitude)


class Unreadable:
    """An array of another device, or of a type that NumPy has not."""

    def __array__(self, *_, **__):
        raise TypeError("implicit conversion is not allowed")


REFUSED = {
    "with a unit": np.array(VALUES).view(WithUnit),
    "quantity": Quantity(),
    "quantities": 3 * [Quantity()],
    "unreadable": Unreadable(),
    "rows of masked": 2 * [np.ma.array(VALUES, mask=[0, 1, 0])],
    "masked": np.ma.array(VALUES, mask=[0, 1, 0]),
    "object": np.array(["a", 1.0, None], dtype=object),
    "complex": _PLAIN + 0j,
    "text": "1.25",
    "bool": True,
    "nan": [0.5, np.nan, 3.0],
    "none": [None, 1.0, 2.0],
    "ragged": [[1.0, 2.0], [3.0]],
}


def law(name, **options):
    return contactlab.create(name, **options)


def along(normal, slip):
    return collide(
        Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1), velocity=np.stack(
            np.broadcast_arrays(slip, 0.0, -np.asarray(normal)), axis=-1))
    ).velocity  # fmt: skip


#: Doors that take one number or arrays, by the argument that their refusals name.
DOORS = {
    "rebound psi1": (lambda x: rebound(x, 1.44), "psi1"),
    "rebound chi": (lambda x: rebound(1.2, x), "chi"),
    "rebound both": (lambda x: rebound(x, x), "psi1"),
    "rebound restitution": (lambda x: rebound(1.2, 1.44, restitution=np.subtract(8, x) / 8)
                            if not isinstance(x, str) else rebound(1.2, 1.44, restitution=x),
                            "restitution"),
    "scene psi1": (lambda x: Scene.nondimensional(psi1=x, chi=1.44).psi1, "psi1"),
    "scene chi": (lambda x: Scene.nondimensional(psi1=1.0, chi=x).chi, "chi"),
    "scene": (lambda x: Scene(BALL, PLATE, 0.2, x, x, x).psi1, "normal_speed"),
    "friction": (lambda x: Scene(BALL, PLATE, x, 1.0, 1.0).psi1, "friction_coefficient"),
    "at_angle": (lambda x: Scene.at_angle(BALL, PLATE, 0.2, speed=x, angle_deg=x).psi1, "speed"),
    "sphere": (lambda x: Sphere(x, STEEL).mass, "radius"),
    "material": (lambda x: Material(young_modulus=x, poisson_ratio=0.3).shear_modulus,
                 "young_modulus"),
    "run": (lambda x: Simulation().run(Scene.nondimensional(psi1=x, chi=1.44)).psi2, "psi1"),
    "stepped": (lambda x: Simulation(tangential="springs").run(
        Scene.nondimensional(psi1=x, chi=1.44)).psi2, "psi1"),
    "encounter": (lambda x: Encounter(BALL, PLATE, x, normal=(0, 0, -1), velocity=(1, 0, -1))
                  .friction_coefficient, "friction_coefficient"),
}  # fmt: skip


def plain(answer):
    return np.asarray(answer, dtype=np.float64)


@pytest.mark.parametrize("door", DOORS)
def test_one_number_of_any_kind_gives_what_a_float_gives(door):
    enter, _ = DOORS[door]
    for kind, number in ONE.items():
        answer = enter(number)
        assert type(answer) is float, kind
        assert answer == enter(1.25), kind


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("door", DOORS)
def test_many_numbers_of_any_kind_give_what_an_array_gives(door, kind):
    enter, _ = DOORS[door]
    made = OF_PANDAS[kind](pytest.importorskip("pandas")) if kind in OF_PANDAS else MANY[kind]
    answer = enter(made)
    if kind in OF_PANDAS and door.startswith("rebound"):
        assert answer.index.tolist() == [0, 1, 2]
        answer = answer.to_numpy()
    assert type(answer) is np.ndarray
    assert answer.dtype == np.float64
    assert answer.tolist() == enter(np.array(VALUES)).tolist()


@pytest.mark.parametrize("door", sorted(set(DOORS) - {"rebound restitution"}))
def test_what_is_no_number_is_refused_by_name(door):
    enter, argument = DOORS[door]
    for kind, given in REFUSED.items():
        with pytest.raises(ValueError, match=argument):
            pytest.fail(f"{kind} is taken: {enter(given)}")


MASKED = np.ma.array([0.5, 0.75, 1.0], mask=[0, 1, 0])
SCENE = Scene(BALL, PLATE, 0.2, [1.0, 2.0, 3.0])


def of_inverse_mass(tensor):
    return Scene(None, None, 0.2, 1.0, inverse_mass=tensor, pair=SCENE.pair)


def rods(normal):
    return shapes.rod(material=STEEL, length=0.1, radius=0.01, axis=(0.6, 0, 0.8), normal=normal)


#: Doors that take no single number, by the begin of their refusals.
OTHER_DOORS = {
    "restitution = .*masked": lambda: collide(
        Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1), velocity=3 * [(0, 0, -1)]),
        restitution=lambda _: MASKED),
    "normal = .*masked": lambda: rods(np.ma.array(np.ones((3, 3)), mask=np.eye(3))),
    "normal = .*real number": lambda: rods(np.ones((3, 3)) + 0j),
    "inverse_mass = .*masked": lambda: of_inverse_mass(np.ma.array(np.eye(3), mask=np.eye(3))),
    "inverse_mass = .*real number": lambda: of_inverse_mass(np.eye(3) + 0j),
    "inverse_mass = .*regular array": lambda: of_inverse_mass([[1.0], [1.0, 2.0]]),
    "index = .*whole numbers": lambda: SCENE.with_index([1, [2]]),
    "psi1 = .*regular array": lambda: Scene.grid(psi1=[[1.0], [1.0, 2.0]], chi=[1.0, 2.0]),
}  # fmt: skip


@pytest.mark.parametrize("words", OTHER_DOORS)
def test_what_is_no_number_is_refused_at_other_doors(words):
    with pytest.raises(ValueError, match=words):
        OTHER_DOORS[words]()


@pytest.mark.parametrize("order", ["C", "F"])
def test_the_order_of_an_array_in_memory_does_not_matter(order):
    table = np.array([[0.5, 1.25], [3.0, 4.0]], order=order)
    assert rebound(table, 1.44).tolist() == [rebound(row, 1.44).tolist() for row in table]
    path = load_path(Scene(BALL, BALL, 0.3, 1.0), 1e-6 * table, 1e-7 * table)
    assert path.friction_force.shape == (2, 2)


def series(values):
    """Return a series of pandas."""
    return pytest.importorskip("pandas").Series(values, dtype=float)


@pytest.mark.parametrize("kind", [list, np.array, pytest.param(series, marks=needs_pandas)])
def test_no_numbers_give_no_answers_or_a_refusal(kind):
    empty = kind([])
    assert rebound(empty, 1.44).shape == (0,)
    with pytest.raises(ValueError, match="at least one"):
        Scene.nondimensional(psi1=empty, chi=1.44)


VECTOR = (0.5, 0.0, -1.25)


@pytest.mark.parametrize(
    "kind",
    [
        list,
        tuple,
        np.array,
        np.float32,
        lambda v: np.array(v, ">f8"),
        np.ma.array,
        pytest.param(series, marks=needs_pandas),
    ],
)
def test_vectors_of_any_kind(kind):
    given = kind(VECTOR) if kind is not np.float32 else np.array(VECTOR, np.float32)
    met = Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1), velocity=given)
    usual = Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1), velocity=VECTOR)
    assert collide(met).velocity.tolist() == collide(usual).velocity.tolist()


def test_a_vector_beyond_the_range_is_refused_in_one_sentence():
    with np.errstate(over="ignore"):
        vast = np.array([1e39, 0.0, -1.0]).astype(np.float32)
    for given in (vast, np.array([VECTOR, vast], np.float32)):
        with pytest.raises(ValueError, match="velocity"):
            Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1), velocity=given)
    many = np.array([VECTOR, VECTOR], np.float32)
    assert Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1), velocity=many).shape == (2,)
    dates = np.array(3 * ["2020-01-01"], dtype="M8[ns]")
    for bad in (np.ma.array(VECTOR, mask=[0, 1, 0]), dates, np.array(VECTOR).view(WithUnit)):
        with pytest.raises(ValueError, match="velocity"):
            Encounter(BALL, PLATE, 0.2, normal=(0, 0, -1), velocity=bad)


@pytest.mark.parametrize("number", ["64", "64.0", "0-d", "int64"])
def test_counts_and_options_of_laws(number):
    kinds = {"64": 64, "0-d": np.array(64), "int64": np.int64(64)}
    if number == "64.0":
        with pytest.raises(ValueError, match="springs"):
            law("tangential.springs", springs=64.0)
        return
    assert law("tangential.springs", springs=kinds[number]).springs == 64
    assert law("normal.tsuji", restitution=np.float32(0.5)).restitution == 0.5
