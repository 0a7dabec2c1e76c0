"""``bounce`` in C and JavaScript against ``contactlab.collide``, on random encounters."""

import functools
import json
import shutil
import subprocess

import numpy as np
import pytest

import contactlab
from contactlab import Encounter, HalfSpace, Material, Sphere, collide
from table_builders.elastic import thin
from tests.kernels.test_kernels import (
    COMPILER,
    HERE,
    KERNELS,
    NODE,
    SANITIZERS,
    STRICT,
    answered,
    needs_c,
    needs_node,
)
from tests.longer import longer

#: Encounters of each test; few where contactlab answers without its table.
COUNT, FEW = 1000, 200
#: Places in a row, as bounce.c reads them.
BODIES, FRICTION, NORMAL, VECTORS = slice(0, 10), 10, slice(11, 14), slice(14, 26)


@pytest.fixture(scope="module", params=[pytest.param("c", marks=needs_c),
                                        pytest.param("js", marks=needs_node)])  # fmt: skip
def bounced(request, tmp_path_factory):
    """Return a function of rows (n, 26) that gives answers (n, 13), by the code in C or JS."""
    folder = tmp_path_factory.mktemp("bounce")
    if request.param == "c":
        words = [COMPILER, *STRICT, *SANITIZERS, f"-I{KERNELS}", HERE / "bounce.c"]
        subprocess.run([*words, "-o", folder / "bounce", "-lm"], check=True, timeout=120)
        command = [folder / "bounce"]
    else:  # as npm lays a package out
        shutil.copytree(KERNELS, folder / "node_modules" / "contactlab")
        command = [NODE, shutil.copy(HERE / "bounce.mjs", folder)]

    def run(rows):
        np.asarray(rows, float).tofile(folder / "in")
        subprocess.run([*command, folder / "in", folder / "out"], check=True, timeout=60)
        return np.fromfile(folder / "out").reshape(-1, 13)

    return run


@functools.cache
def rows_and_laws(seed, wall, gyration, count=COUNT):
    """Return rows of random encounters, and what contactlab answers."""
    random = np.random.default_rng(seed)
    radius, mass = random.uniform(0.005, 0.05, (2, count)), random.uniform(0.01, 1.0, (2, count))
    young, poisson = (
        10.0 ** random.uniform(7.0, 9.0, (2, count)),
        random.uniform(0, 0.5, (2, count)),
    )
    friction, normal = random.uniform(0.02, 1.0, count), random.normal(size=(count, 3))
    vectors = random.normal(size=(4, count, 3)) * [[[1.0]], [[50.0]], [[1.0]], [[50.0]]]
    materials = [
        Material(young_modulus=young[k], poisson_ratio=poisson[k], density=1000.0) for k in (0, 1)
    ]
    spheres = [
        Sphere(radius[k], materials[k], mass=mass[k], gyration_ratio=gyration) for k in (0, 1)
    ]
    numbers = [radius, mass, gyration**2 * mass * radius**2, young, poisson]
    if wall:
        spheres[1] = HalfSpace(materials[1])
        vectors[3] = 0.0
        for number in numbers[:3]:
            number[1] = 0.0
    rows = np.zeros((count, 26))
    rows[:, BODIES] = np.moveaxis(np.array(numbers), (0, 1, 2), (2, 1, 0)).reshape(count, 10)
    rows[:, FRICTION], rows[:, NORMAL] = friction, normal
    rows[:, VECTORS] = np.moveaxis(vectors, 0, 1).reshape(count, 12)
    names = ("velocity", "spin", "target_velocity", "target_spin")
    met = Encounter(
        *spheres, friction, normal=normal, **dict(zip(names, vectors, strict=True))
    )  # fmt: skip
    return rows, met, collide(met, separating="pass")


def gaps(answers, met, made):
    """Return the largest error of a surface's velocity over approach + slip, per encounter."""
    contact = met.meeting()
    speed = np.abs(contact.approach) + contact.slip
    arms = (met.body.radius, getattr(met.target, "radius", np.zeros(len(answers))))
    errors = [
        answers[:, 1:4] - made.velocity,
        (answers[:, 4:7] - made.spin) * arms[0][:, None],
        answers[:, 7:10] - made.target_velocity,
        (answers[:, 10:13] - made.target_spin) * arms[1][:, None],
    ]
    return np.abs(errors).max(axis=(0, 2)) / speed


@pytest.mark.parametrize("wall", [False, True])
@pytest.mark.parametrize("gyration", [0.4**0.5, (2.0 / 3.0) ** 0.5, *longer(0.55)])
def test_from_the_table_it_is_collide_to_a_millionth(bounced, wall, gyration):
    rows, met, made = rows_and_laws(3, wall, gyration)
    chi = met.scene.chi if made.collided.all() else met.take(made.collided).scene.chi
    assert 0.8 < chi.min() < chi.max() < 2.5
    answers = bounced(rows)
    assert (answers[:, 0] == made.collided).all()
    assert 0.2 < made.collided.mean() < 0.8
    assert gaps(answers, met, made).max() < 1e-6
    assert (answers[~made.collided, 1:] == rows[~made.collided, VECTORS]).all()


def test_a_dense_core_is_left_to_sixteen_springs(bounced):
    rows, met, made = rows_and_laws(4, False, 0.3, FEW)
    chi = met.take(made.collided).scene.chi
    assert 3.9 < chi.min() < chi.max() < 6.2
    error = gaps(bounced(rows), met, made)
    assert 1e-6 < error.max() < 0.02
    assert np.sqrt(np.mean(error**2)) < 0.003


def test_momentum_stays_and_energy_falls(bounced):
    rows, _, _ = rows_and_laws(5, False, 0.6)
    after = bounced(rows)
    mass, inertia = rows[:, [1, 6]], rows[:, [2, 7]]

    def books(vectors):
        velocity, spin = vectors[:, [0, 2]], vectors[:, [1, 3]]
        momentum = (mass[..., None] * velocity).sum(axis=1)
        energy = mass * (velocity**2).sum(axis=2) + inertia * (spin**2).sum(axis=2)
        return momentum, energy.sum(axis=1)

    before = books(rows[:, VECTORS].reshape(-1, 4, 3))
    momentum, energy = books(after[:, 1:].reshape(-1, 4, 3))
    assert np.abs(momentum - before[0]).max() < 1e-13
    assert (energy <= before[1] * (1.0 + 1e-13)).all()
    assert (energy < 0.999 * before[1])[after[:, 0] == 1].mean() > 0.3


def test_at_every_corner_of_the_rebound(bounced):
    """psi1 at 0, 1, 2 chi, 4 chi - 1 and beside them; chi from 0.84 to 2.5 and beyond."""
    chi = np.repeat([0.84, 1.0, 1.44, 1.75, 2.0, 2.5, np.nextafter(2.5, 3.0)], 15)
    corners = np.array([0.0 * chi[::15], 0.0 * chi[::15] + 1.0, 2.0 * chi[::15], 4 * chi[::15] - 1])
    beside = np.array([-1e-9, 0.0, 1e-9])
    psi1 = (corners.T[:, :, None] + beside).reshape(7, 12)
    psi1 = np.hstack([psi1, np.tile([1e-300, 1e6, 1e100], (7, 1))]).ravel()
    poisson, friction, approach = 0.5, 0.3, 2.0
    kappa, radius = 2.0 / 3.0, 0.01
    inertia = radius**2 / (2.0 * chi / kappa - 1.0)
    rows = np.zeros((chi.size, 26))
    rows[:, :5] = np.stack(
        np.broadcast_arrays(radius, 1.0, inertia, 1.0, poisson), axis=-1
    )  # fmt: skip
    rows[:, 8:10] = 1.0, poisson
    rows[:, FRICTION], rows[:, 13] = friction, -1.0
    rows[:, 14], rows[:, 16] = psi1 * friction * approach / kappa, -approach
    after = bounced(rows)
    change = (after[:, 1] - rows[:, 14]) * 2.0 * chi / kappa * kappa / (friction * approach)
    expected = np.array([contactlab.rebound(*each) for each in zip(psi1, chi, strict=True)])
    few = np.abs(psi1) < 1e3  # beyond, the velocity has no digits for the change
    bound = np.where(chi > 2.5, 6e-3, 1e-6)
    assert (np.abs(psi1 + change - expected) <= bound * np.maximum(np.abs(psi1), 1.0))[few].all()
    turned = after[:, 5] * inertia / radius  # the impulse of friction, whatever the velocity
    assert np.abs(turned[~few] * 2.0 * chi[~few] / (friction * approach)
                  ) == pytest.approx(4.0 * chi[~few], rel=1e-12)  # fmt: skip


PLACES = {"radius": 0, "mass": 1, "inertia": 2, "young": 3, "poisson": 4, "other mass": 6,
          "other poisson": 9, "friction": 10, "normal": 11, "velocity": 14, "spin": 17}  # fmt: skip


REFUSED = [
    ("radius", (-0.01, np.nan, 0.0)), ("mass", (-1.0, np.nan)), ("inertia", (-1.0, np.nan, 1e-300)),
    ("young", (-1.0, 0.0, np.nan)), ("poisson", (-1.0, 0.51, np.nan)), ("other mass", (-1.0,)),
    ("other poisson", (0.6, np.nan)), ("friction", (-0.1, np.nan, np.inf)),
    ("normal", (np.nan, np.inf)), ("velocity", (np.nan, np.inf)), ("spin", (np.nan,)),
]  # fmt: skip


def test_what_is_no_number_is_refused_and_changes_nothing(bounced):
    spoilt = [(PLACES[name], value) for name, values in REFUSED for value in values]
    rows = rows_and_laws(6, False, 0.6, FEW)[0][: len(spoilt)]
    for row, (place, value) in zip(rows, spoilt, strict=True):
        row[place] = value
    answers = bounced(rows)
    assert (answers[:, 0] == -1).all()
    assert np.array_equal(answers[:, 1:], rows[:, VECTORS], equal_nan=True)


def test_a_normal_of_no_length_and_two_fixed_bodies_are_refused(bounced):
    rows, _, _ = rows_and_laws(7, True, 0.6, FEW)
    rows[0, NORMAL] = 0.0
    rows[1, [1, 2]] = 0.0
    assert (bounced(rows[:2])[:, 0] == -1).all()


@needs_node
def test_rebound_of_no_number_is_nan(tmp_path):
    pairs = [("NaN", 1.44), (1.2, "NaN"), (0.5, 0), (0.5, -1), (0.5, "Infinity"), ("Infinity", 2)]
    calls = ",".join(f"rebound({psi1},{chi})" for psi1, chi in pairs)
    module = json.dumps((KERNELS / "contactlab_bounce.mjs").as_uri())
    script = f"import {{rebound}} from {module}; console.log(JSON.stringify([{calls}]))"
    assert answered(script, tmp_path) == [None] * 6  # NaN and infinity in JSON


def test_the_table_is_the_one_that_is_built(tmp_path):
    for name in thin.FILES:
        text = (KERNELS / name).read_text("utf-8")
        (tmp_path / name).write_text(text.replace("\n1.", "\n0.,1.", 1), "utf-8")
    for file in thin.write(tmp_path):
        assert file.read_text("utf-8") == (KERNELS / file.name).read_text("utf-8")


def test_the_package_is_of_this_version():
    package = json.loads((KERNELS / "package.json").read_text("utf-8"))
    assert package["version"] == contactlab.__version__
    named = {*package["files"], *(each.removeprefix("./") for each in package["exports"].values())}
    assert named == {each.name for each in KERNELS.iterdir()} - {"package.json", "README.md"}
