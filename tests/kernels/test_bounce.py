"""``bounce`` in C and JavaScript beside ``collide``, springs of fine steps and closed forms."""

import functools
import json
import re
import shutil
import subprocess
from fractions import Fraction

import numpy as np
import pytest

import contactlab
from contactlab import Encounter, HalfSpace, Material, Sphere, collide
from contactlab_laws.viscoelastic.batch import extrapolate_steps
from contactlab_laws.viscoelastic.relaxation import number_of
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
BODIES, FRICTION, RESTITUTION = slice(0, 10), 10, 11
NORMAL, VECTORS = slice(12, 15), slice(15, 27)


@pytest.fixture(scope="module", params=[pytest.param("c", marks=needs_c),
                                        pytest.param("js", marks=needs_node)])  # fmt: skip
def bounced(request, tmp_path_factory):
    """Return a function of rows (n, 27) that gives answers (n, 13), by the code in C or JS."""
    folder = tmp_path_factory.mktemp("bounce")
    if request.param == "c":
        words = [COMPILER, *STRICT, "-O0", *SANITIZERS, f"-I{KERNELS}", HERE / "bounce.c"]
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
    numbers = [radius, mass, np.full(radius.shape, gyration), young, poisson]
    if wall:
        spheres[1] = HalfSpace(materials[1])
        vectors[3] = 0.0
        for number in numbers[:3]:
            number[1] = 0.0
    rows = np.zeros((count, 27))
    rows[:, BODIES] = np.moveaxis(np.array(numbers), (0, 1, 2), (2, 1, 0)).reshape(count, 10)
    rows[:, FRICTION], rows[:, RESTITUTION], rows[:, NORMAL] = friction, 1.0, normal
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


@pytest.mark.parametrize("wall", [False, True])
def test_with_a_restitution_it_is_collide_to_a_ten_thousandth(bounced, wall):
    rows, met, _ = rows_and_laws(12, wall, (2.0 / 3.0) ** 0.5, FEW)
    e = np.random.default_rng(12).uniform(0.0, 1.0, FEW)
    made = collide(met, separating="pass", restitution=e)
    answers = bounced(np.insert(np.delete(rows, RESTITUTION, axis=1), RESTITUTION, e, axis=1))
    assert (answers[:, 0] == made.collided).all()
    assert gaps(answers, met, made).max() < 5e-5


@pytest.mark.slow
def test_a_dense_core_is_left_to_sixteen_springs(bounced):
    rows, met, made = rows_and_laws(4, False, 0.3, FEW)
    chi = met.take(made.collided).scene.chi
    assert 3.9 < chi.min() < chi.max() < 6.2
    error = gaps(bounced(rows), met, made)
    assert 1e-6 < error.max() < 0.02
    assert np.sqrt(np.mean(error**2)) < 0.003


def books(rows, vectors):
    """Return momentum and twice the energy of both bodies, shape (n, 3) and (n,)."""
    velocity, spin = vectors[:, [0, 2]], vectors[:, [1, 3]]
    mass = rows[:, [1, 6]]
    inertia = mass * (rows[:, [2, 7]] * rows[:, [0, 5]]) ** 2
    momentum = (mass[..., None] * velocity).sum(axis=1)
    energy = mass * (velocity**2).sum(axis=2) + inertia * (spin**2).sum(axis=2)
    return momentum, energy.sum(axis=1)


@pytest.mark.slow
def test_momentum_stays_and_energy_falls(bounced):
    """10⁵ encounters, half of them elastic; chi from 0.5 to 2.4."""
    rows, random = np.repeat(rows_and_laws(5, False, 0.6)[0], 100, axis=0), np.random.default_rng(5)
    rows[::2, RESTITUTION] = random.uniform(0.0, 1.0, rows[::2].shape[0])
    rows[:, [2, 7]] *= random.uniform(0.5, 1.8, len(rows))[:, None] ** 0.5
    rows[:, VECTORS] *= random.uniform(0.1, 3.0, rows[:, VECTORS].shape)
    after = bounced(rows)
    before = books(rows, rows[:, VECTORS].reshape(-1, 4, 3))
    momentum, energy = books(rows, after[:, 1:].reshape(-1, 4, 3))
    assert np.abs(momentum - before[0]).max() < 1e-12
    assert (energy <= before[1] * (1.0 + 1e-13)).all()
    assert (energy < 0.999 * before[1])[after[:, 0] == 1].mean() > 0.8


#: What the scaled encounters have in common: a ball of 1 kg on a wall.
LEAST_CHI = 0.67  # of a hoop, whose gyration ratio is 1, at a Poisson's ratio of 1/2
SCALED = {"friction": 0.3, "approach": 2.0, "radius": 0.01, "kappa": 2.0 / 3.0}


def scaled_rows(psi1, chi, e):
    """Return rows of encounters of psi1, chi and restitution, shape (n, 27)."""
    psi1, chi, e = np.broadcast_arrays(psi1, chi, e)
    friction, approach, radius, kappa = SCALED.values()
    rows = np.zeros((chi.size, 27))
    gyration = (2.0 * chi / kappa - 1.0) ** -0.5
    numbers = radius, 1.0, gyration, 1.0, 0.5
    rows[:, :5] = np.stack(np.broadcast_arrays(*numbers), axis=-1)
    rows[:, 8:10] = 1.0, 0.5
    rows[:, FRICTION], rows[:, RESTITUTION], rows[:, 14] = friction, e, -1.0
    rows[:, 15], rows[:, 17] = psi1 * friction * approach / kappa, -approach
    return rows


def psi2_of(rows, after):
    """Return psi2 of scaled encounters by the velocities of the contact point."""
    friction, approach, radius, kappa = SCALED.values()
    assert after[:, 3] == pytest.approx(rows[:, RESTITUTION] * approach, rel=1e-15)
    return (after[:, 1] - after[:, 5] * radius) * kappa / (friction * approach)


@pytest.mark.slow
def test_at_every_corner_of_the_rebound(bounced):
    """psi1 at 0, 1, 2 chi, 4 chi - 1 and beside them; chi from 0.84 to 2.5 and beyond."""
    chi = np.repeat([0.84, 1.0, 1.44, 1.75, 2.0, 2.5, np.nextafter(2.5, 3.0)], 15)
    corners = np.array([0.0 * chi[::15], 0.0 * chi[::15] + 1.0, 2.0 * chi[::15], 4 * chi[::15] - 1])
    beside = np.array([-1e-9, 0.0, 1e-9])
    psi1 = (corners.T[:, :, None] + beside).reshape(7, 12)
    psi1 = np.hstack([psi1, np.tile([1e-300, 1e6, 1e100], (7, 1))]).ravel()
    rows = scaled_rows(psi1, chi, 1.0)
    after = bounced(rows)
    friction, approach, radius, _ = SCALED.values()
    change = (after[:, 1] - rows[:, 15]) * 2.0 * chi / (friction * approach)
    expected = np.array([contactlab.rebound(*each) for each in zip(psi1, chi, strict=True)])
    few = np.abs(psi1) < 1e3  # beyond, the velocity has no digits for the change
    bound = np.where(chi > 2.5, 6e-3, 1e-6)
    assert (np.abs(psi1 + change - expected) <= bound * np.maximum(np.abs(psi1), 1.0))[few].all()
    # the impulse of friction, whatever the velocity: I w/R with I = m (K R)^2
    turned = after[:, 5] * rows[:, 1] * rows[:, 2] ** 2 * radius
    assert np.abs(turned[~few] * 2.0 * chi[~few] / (friction * approach)
                  ) == pytest.approx(4.0 * chi[~few], rel=1e-12)  # fmt: skip


@pytest.fixture
def psi2(bounced):
    """Return a function of psi1, chi and restitution that gives psi2."""

    def call(psi1, chi, e):
        rows = scaled_rows(psi1, chi, e)
        return psi2_of(rows, bounced(rows))

    return call


#: psi1 of the columns below, and of the rows restitution, chi and psi2 to 3e-6 (1e-5 in the last
#: two), by 800 springs and 4,000 steps, extrapolated: `trials/loss.py` of theory §15.
INCIDENCE = (0.1, 0.5, 1.0, 1.2, 2.0, 3.0, 4.0)
LOSSES = (
    (0.9122417, 49 / 34, 0.008928, 0.009160, -0.085073, -0.174580, -0.724878, -1.219935, -1.256848),
    (0.9122417, 7 / 6, -0.017317, -0.137768, -0.383082, -0.522071, -1.054454, -1.215194, -0.461897),
    (0.8364047, 49 / 34, 0.001063, -0.018386, -0.107094, -0.176153, -0.637783, -1.089706,
     -1.105620),
    (0.8364047, 7 / 6, -0.019273, -0.134426, -0.351641, -0.468823, -0.942747, -1.084370, -0.284944),
    (0.8364047, 2.5, -0.007737, -0.012076, 0.050040, 0.108260, 0.338853, 0.241275, -0.259180),
    (0.7123824, 49 / 34, -0.007853, -0.050955, -0.136844, -0.184068, -0.513880, -0.891083,
     -0.859514),
    (0.7123824, 1.0, -0.033383, -0.190251, -0.425932, -0.531852, -0.867797, -0.424765, 0.575235),
    (0.5387465, 49 / 34, -0.013432, -0.071125, -0.153547, -0.186051, -0.373254, -0.639568,
     -0.435211),
    (0.5387465, 1.75, -0.010535, -0.052723, -0.105150, -0.120047, -0.208623, -0.450809, -0.672458),
    (0.2872302, 49 / 34, -0.01115, -0.05644, -0.11454, -0.13466, -0.20683, -0.31989, 0.28975),
    (0.0877983, 49 / 34, -0.00396, -0.01989, -0.03995, -0.04683, -0.06807, -0.09356, 0.86458),
)  # fmt: skip


#: psi1, chi, restitution, psi2.
PLANAR = np.array([
    (0.7, 1.3, 0.7703426, -0.129268), (2.5, 1.6, 0.4246971, -0.324075),
    (2.6, 1.75, 0.7703426, -0.510490), (0.9, 0.7, 0.8654585, -0.703601),
])  # fmt: skip


def test_with_a_restitution_it_is_springs_of_fine_steps(psi2):
    """To 1e-4 by the table, and to 4e-3 by the springs at chi = 2.5."""
    e, chi, *expected = np.array(LOSSES).T[..., None]
    expected = np.hstack(expected)
    found = psi2(*(each.ravel() for each in np.broadcast_arrays(INCIDENCE, chi, e)))
    gap = np.abs(found.reshape(expected.shape) - expected)
    table = chi.ravel() <= 2.0
    assert gap[table].max() < 5e-5
    assert 5e-5 < gap[~table].max() < 4e-3
    # Planar impacts by springs and by rings, apart by 4e-7.
    assert psi2(*PLANAR.T[:3]) == pytest.approx(PLANAR.T[3], abs=5e-5)


@functools.cache
def impacts(lower, upper):
    """Return psi1, chi within limits, restitution and psi2 of random impacts."""
    random, count = np.random.default_rng(10), 100
    chi, e = random.uniform(lower, upper, count), random.uniform(0.01, 1.0, count)
    psi1 = random.uniform(0.0, 1.0, count) * np.maximum(1.0, 2.0 * chi * (1.0 + e) - e)
    return psi1, chi, e, extrapolate_steps(psi1, chi, number_of(e), springs=200, steps=1000)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("lower", "upper", "bound"),
    [(LEAST_CHI, 2.0, 7e-5), *longer((2.0, 4.0, 4e-3), (4.0, 10.0, 8e-3))],
)
def test_any_restitution_is_that_of_springs_in_python(psi2, lower, upper, bound):
    """Each impact with a restitution of its own, from 0.01 up, by the springs of the law."""
    psi1, chi, e, expected = impacts(lower, upper)
    assert np.abs(psi2(psi1, chi, e) - expected).max() < bound


def test_where_it_slips_throughout_or_does_not_rebound_psi2_is_in_closed_form(psi2):
    random = np.random.default_rng(8)
    chi = random.uniform(LEAST_CHI, 10.0, COUNT)
    e = random.uniform(0.0, 1.0, COUNT)
    psi1 = np.maximum(1.0, 2.0 * chi * (1.0 + e) - e) + random.exponential(1.0, COUNT)
    expected = psi1 - 2.0 * chi * (1.0 + e)
    assert psi2(psi1, chi, e) == pytest.approx(expected, abs=1e-9)
    psi1 = 2.0 * chi * random.uniform(0.0, 1.0, COUNT)
    assert psi2(psi1, chi, 0.0) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.slow
def test_small_restitutions_lead_to_none(psi2):
    """That at 0.004 is half way from e = 0 to 0.008; springs meet it there."""
    values = (0.7, 1.4, 3.0), (0.0, 0.004, 0.008, 0.00801), np.linspace(0.05, 0.95, 19)
    chi, e, psi1 = (each.ravel() for each in np.meshgrid(*values, indexing="ij"))
    found = psi2(psi1, chi, e)
    none, half, full, more = np.moveaxis(found.reshape(3, 4, 19), 1, 0)
    assert half == pytest.approx((none + full) / 2.0, abs=5e-5)
    assert more == pytest.approx(full, abs=5e-5)
    assert (np.abs(full - none).max(axis=1) > 1e-4).all()


#: psi1, chi, and velocity and spin after it at restitution 1, from the table of 201 patches.
DIGITS = (
    (0.1, 1.4411764705882353, 0.07346990895361276, 5.493824377181642),
    (0.5, 1.4411764705882353, 0.35587505168918865, 31.282703409181437),
    (1.0, 1.4411764705882353, 0.6794100468031642, 73.3137197389484),
    (0.9, 2.0, 0.7303762146683556, 39.81189266582225),
    (0.35, 1.2, 0.2116031592932499, 26.883178583755026),
    (0.7, 2.5, 0.5687262196261632, 39.82795724299392),
    (0.05, 0.84, 0.015353999549822302, 4.506192068427009),
    (9.0, 1.2, 6.8999999999999995, 312.0),
)


def test_at_restitution_one_all_digits_are_those_of_the_elastic_table(bounced):
    """But for the last, which both languages round in ways of their own."""
    psi1, chi, velocity, spin = np.array(DIGITS).T
    after = bounced(scaled_rows(psi1, chi, 1.0))
    assert after[:, [1, 5]] == pytest.approx(np.stack([velocity, spin], axis=-1), rel=1e-15)


@pytest.fixture
def builders():
    """Return the modules that make the tables of the kernels: of losses, and without."""
    pytest.importorskip("table_builders", reason="table_builders is not in the wheel")
    from table_builders.elastic import thin
    from table_builders.restituted import thin as restituted

    return restituted, thin


@pytest.mark.parametrize("name", ["contactlab_bounce.mjs", "contactlab_bounce.h"])
def test_the_table_of_losses_is_small(name, builders):
    restituted, _ = builders
    table = re.split(
        r"\n[]}];", (KERNELS / name).read_text("utf-8").partition(restituted.FILES[name])[2]
    )[0]
    assert 10_000 < len(table) < 60_000


PLACES = {"radius": 0, "mass": 1, "gyration": 2, "young": 3, "poisson": 4, "other mass": 6,
          "other poisson": 9, "friction": 10, "restitution": 11, "normal": 12, "velocity": 15,
          "spin": 18}  # fmt: skip


REFUSED = [
    ("radius", (-0.01, np.nan, 0.0)), ("mass", (-1.0, np.nan)),
    ("gyration", (-1.0, np.nan, 1e-300, 1.001)),
    ("young", (-1.0, 0.0, np.nan)), ("poisson", (-1.0, 0.51, np.nan)), ("other mass", (-1.0,)),
    ("other poisson", (0.6, np.nan)), ("friction", (-0.1, np.nan, np.inf)),
    ("restitution", (-1e-9, 1.0 + 1e-9, np.nan)),
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


def test_a_normal_of_no_length_fixed_bodies_and_too_large_impulses_are_refused(bounced):
    rows = rows_and_laws(7, True, 0.6, FEW)[0].copy()
    rows[0, NORMAL] = 0.0
    rows[1, [1, 2]] = 0.0
    rows[2:4, [1, 2]] = 1e290, 0.0  # a solid sphere, by its mass and a fast one
    rows[2, 1], rows[3, VECTORS] = 1e304, rows[3, VECTORS] * 1e20
    rows[4, PLACES["friction"]], rows[4, VECTORS] = 1e130, rows[4, VECTORS] * 1e200
    assert (bounced(rows[:5])[:, 0] == -1).all()


def test_a_normal_of_any_length_is_a_normal(bounced):
    rows = np.tile(rows_and_laws(9, False, 0.6, FEW)[0][:2], (7, 1))
    rows[:, NORMAL] *= np.repeat(10.0 ** np.array([0, 3, 149, 160, 307, -160, -300]), 2)[:, None]
    answers = bounced(rows).reshape(7, 26)
    assert answers == pytest.approx(np.tile(answers[0], (7, 1)), rel=1e-13)


#: Arguments of bounce in JavaScript, by name, and words of the sentence that refuses them.
BALL = "{radius: 0.025, mass: 0.065, poisson: 0.49"
SENTENCES = [
    ({"other": "undefined"}, "other = undefined must be a sphere or a wall; a wall"),
    ({"one": "null"}, "one = null must be a sphere"),
    ({"one": BALL + ", mas: 1}"}, "one.mas = 1 is not among radius, mass, young"),
    ({"one": BALL + ", restitution: 0.7}"}, "one.restitution = 0.7 .* stands beside friction"),
    ({"one": "{mass: 1, poisson: 0.3}"}, "one.radius = undefined must be positive"),
    ({"one": "{radius: 1, mass: 1}"}, "one.poisson = undefined must be above -1"),
    ({"one": "{radius: 1, poisson: 0.3}"}, "one.mass = undefined must be finite"),
    ({"one": BALL + ", gyration_ratio: 1e-3}"}, "one.gyration_ratio = 0.001 must be from"),
    ({"one": BALL + ", gyration_ratio: 1.01}"}, "one.gyration_ratio = 1.01 must be from 0.01 to 1"),
    ({"other": "{gyration_ratio: 2}"}, "other.gyration_ratio = 2 must be from 0.01 to 1"),
    ({"one": BALL + ", inertia: 2 / 3}"}, "one.inertia = .* sqrt.inertia/.mass radius²"),
    ({"one": BALL + ", mass: '1 kg'}"}, 'one.mass = "1 kg" must be positive'),
    ({"other": "{radius: 0, mass: 1, gyration_ratio: 1}"}, "other.radius = 0 must be positive"),
    ({"contact": "1e130", "velocity": "[1, 0, -1e200]"}, "are of a size that rounds away"),
    ({"other": "{young: 1e7, poisson: 0.3}"}, "other.young = 10000000 must be given for both"),
    ({"contact": "undefined"}, "contact = undefined must be a coefficient of friction"),
    ({"contact": "-0.1"}, "friction = -0.1 must be a finite number, at least 0"),
    ({"contact": "{restitution: 0.7}"}, "friction = undefined must be a finite number"),
    ({"contact": "{friction: 1, restituton: 1}"}, "contact.restituton = 1 is not among friction"),
    ({"contact": "{friction: 1, restitution: 1.1}"}, "restitution = 1.1 must be .* from 0 to 1"),
    ({"contact": "{friction: 1, restitution: null}"}, "restitution = null must be"),
    ({"normal": "{x: 0, y: 0, z: -1}"}, "normal = {x: 0, y: 0, z: -1} must be an array .* \\[v.x"),
    ({"normal": "[0, 0, 0]"}, "normal = \\[0, 0, 0\\] must lead from the centre"),
    ({"velocity": "{x: 2, y: 0, z: -4}"}, "velocity = {x: 2, y: 0, z: -4} must be an array"),
    ({"velocity": "[1, 2, NaN]"}, "velocity = \\[1, 2, NaN\\] must be an array"),
    ({"one": BALL.replace("0.065", "1e304") + "}"}, "are of a size that rounds away"),
    ({"velocity": "[1e308, 0, -1e308]"}, "are of a size that rounds away"),
    ({"spin": "{restitution: 0.7}"}, "spin = {restitution: 0.7} must be an array"),
    ({"more": "{restitution: 0.7}"}, "argument 9 = .* is one too many; restitution stands beside"),
]  # fmt: skip


@needs_node
def test_in_javascript_one_sentence_says_what_is_wrong(tmp_path):
    usual = {"one": BALL + "}", "other": "{}", "contact": "0.8", "normal": "[0, 0, -1]",
             "velocity": "[2, 0, -4]", "spin": "[0, 0, 0]", "otherVelocity": "[0, 0, 0]",
             "otherSpin": "[0, 0, 0]"}  # fmt: skip
    calls = [f"told(() => bounce({', '.join((usual | given).values())}))" for given, _ in SENTENCES]
    module = json.dumps((KERNELS / "contactlab_bounce.mjs").as_uri())
    told = "const told = call => { try { return call(); } catch (error) { return `${error}`; } }"
    script = (
        f"import {{bounce}} from {module}; {told}; console.log(JSON.stringify([{','.join(calls)}]))"
    )
    for sentence, (given, words) in zip(answered(script, tmp_path), SENTENCES, strict=True):
        assert re.match(f"RangeError: bounce: .*{words}", str(sentence)), given


def told_number(word):
    """Return the number of a word such as 0.5, 2/3 or sqrt(2/3)."""
    if word.startswith("sqrt("):
        return float(Fraction(word[5:-1])) ** 0.5
    return float(Fraction(word))


@needs_node
def test_the_notes_tell_the_balls_of_the_module(tmp_path):
    module = json.dumps((KERNELS / "contactlab_bounce.mjs").as_uri())
    balls = answered(
        f"import {{BALLS}} from {module}; console.log(JSON.stringify(BALLS))", tmp_path
    )
    rows = [
        [word.strip() for word in line.strip("|").split("|")]
        for line in (KERNELS / "README.md").read_text("utf-8").splitlines()
    ]
    told = {row[0]: [told_number(word) for word in row[1:]] for row in rows if row[0] in balls}
    assert set(told) == set(balls) == {"football", "tennisBall", "billiardBall", "superball"}
    for name, ball in balls.items():
        radius, mass = ball["body"]["radius"], ball["body"]["mass"]
        ratio = ball["body"].get("gyration_ratio", 0.4**0.5)
        numbers = radius, mass, ratio, ball["body"]["poisson"], *ball["contact"].values()
        assert told[name] == pytest.approx(numbers, rel=1e-12)


@needs_node
def test_rebound_without_restitution_below_chi_of_a_half_is_in_closed_form(tmp_path):
    psi1, chi = np.random.default_rng(8).uniform([[0.0], [0.34]], [[1.0], [0.49]], (2, 50))
    calls = ",".join(f"rebound({x},{c},0)" for x, c in zip(psi1, chi, strict=True))
    module = json.dumps((KERNELS / "contactlab_bounce.mjs").as_uri())
    script = f"import {{rebound}} from {module}; console.log(JSON.stringify([{calls}]))"
    left = (1.0 - 2.0 * chi) * psi1 ** (1.0 / (1.0 - 2.0 * chi))
    assert answered(script, tmp_path) == pytest.approx(left, abs=1e-12)


#: A football that drops at 3, 4 m/s on a floor: velocity along by ``collide``, and the numbers that
#: some give for its gyration ratio, sqrt(2/3): its square, its moment of inertia, a typing error.
FOOTBALL = {"radius": 0.11, "mass": 0.43, "gyration_ratio": (2.0 / 3.0) ** 0.5}


def test_a_shell_is_told_by_its_gyration_ratio(bounced):
    rubber = Material(young_modulus=1e7, poisson_ratio=0.5, density=1000.0)
    ball, floor = Sphere(material=rubber, **FOOTBALL), HalfSpace(rubber)
    met = Encounter(ball, floor, 0.5, normal=[0, -1, 0], velocity=[3, -4, 0])
    expected = collide(met, restitution=0.6).velocity
    row = np.zeros((1, 27))
    row[0, :5], row[0, 8:10] = (*FOOTBALL.values(), 1e7, 0.5), (1e7, 0.5)
    row[0, 10:18] = 0.5, 0.6, 0.0, -1.0, 0.0, 3.0, -4.0, 0.0
    after = bounced(row)[0]
    assert after[0] == 1.0
    assert after[1:4] == pytest.approx(expected, abs=1e-3)
    assert after[1] == pytest.approx(1.2594, abs=1e-4)


def test_a_ball_that_rolls_shows_whether_radius_speed_and_spin_have_one_unit(bounced):
    """As the notes tell: radii in m, or all in pixels; in mm, or only speeds in pixels."""
    rows = np.zeros((4, 27))
    radius, unit, along = 0.025, np.array([1.0, 40.0, 1.0, 100.0]), 2.0
    rows[:, 0] = radius * np.array([1.0, 40.0, 1000.0, 1.0])
    rows[:, [1, 3, 8]], rows[:, [4, 9]] = (0.065, 1.0, 1.0), 0.3
    rows[:, 10:12], rows[:, 14] = 0.5, -1.0
    rows[:, 15], rows[:, 17], rows[:, 19] = along * unit, -3.0 * unit, along / radius
    after = bounced(rows)
    change = np.abs(after[:, [1, 5]] / rows[:, [15, 19]] - 1.0)
    assert change[:2].max() < 1e-12
    assert change[2:, 0].min() > 0.1


@needs_node
def test_the_course_of_no_impact_is_refused(tmp_path):
    wrong = ("NaN, 1.4", "1, -1", "1, 0", "1, Infinity", "1, 1.4, 0", "1, 1.4, 50, NaN",
             "1, 1.4, 50, 200, 1.1", "1, NaN")  # fmt: skip
    told = "const told = call => { try { return call(); } catch (error) { return error.name; } }"
    calls = ",".join(f"told(() => impact({each}))" for each in wrong)
    module = json.dumps((KERNELS / "contactlab_bounce.mjs").as_uri())
    script = f"import {{impact}} from {module}; {told}; console.log(JSON.stringify([{calls}]))"
    assert answered(script, tmp_path) == ["RangeError"] * 8


@needs_node
def test_rebound_of_no_number_is_nan(tmp_path):
    pairs = [("NaN", 1.44), (1.2, "NaN"), (0.5, 0), (0.5, -1), (0.5, "Infinity"), ("Infinity", 2),
             (1, "1, -0.1"), (1, "1, 1.1"), (1, "1, NaN")]  # fmt: skip
    calls = ",".join(f"rebound({psi1},{chi})" for psi1, chi in pairs)
    module = json.dumps((KERNELS / "contactlab_bounce.mjs").as_uri())
    script = f"import {{rebound}} from {module}; console.log(JSON.stringify([{calls}]))"
    assert answered(script, tmp_path) == [None] * 9  # NaN and infinity in JSON


def test_the_table_is_the_one_that_is_built(tmp_path, builders):
    _, thin = builders
    for name in thin.FILES:
        text = (KERNELS / name).read_text("utf-8")
        (tmp_path / name).write_text(text.replace("\n1.", "\n0.,1.", 1), "utf-8")
    for file in thin.write(tmp_path):
        assert file.read_text("utf-8") == (KERNELS / file.name).read_text("utf-8")


@pytest.mark.slow
def test_the_table_of_losses_is_the_one_that_is_built(builders):
    """The first piece, to the rounding of its terms."""
    restituted, _ = builders
    built = np.array(restituted.tree(restituted.PIECES[0]))
    text = (KERNELS / "contactlab_bounce.mjs").read_text("utf-8")
    table = text.partition(restituted.FILES["contactlab_bounce.mjs"])[2].split(",")
    first = int(table[0])
    assert np.abs(built - np.array(table[first : first + built.size], dtype=int)).max() <= 1
