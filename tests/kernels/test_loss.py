"""Shear that takes the loss of a damped normal force: kernels in C and JavaScript."""

import ctypes
import functools
import itertools
import subprocess

import numpy as np
import pytest

from tests.kernels.motions import MODULUS, TIME, by_vectors, damped, sliding, wandering
from tests.kernels.test_kernels import (
    COMPILER,
    HERE,
    KERNELS,
    NODE,
    SANITIZERS,
    STRICT,
    driven,
    driven_each,
    held_by_the_rules,
    needs_c,
)
from tests.kernels.test_kernels import built as built
from tests.kernels.test_kernels import words as words
from tests.longer import longer

CHI = 49.0 / 34.0
#: Duration of a contact in the scaled time, about.
CONTACT = 3.2
ELASTIC, DAMPING, VELOCITY = 8, 9, slice(10, 13)
EXPORTED = """
#include "contactlab_springs.h"
double damped_step(double *state, int n, const double *moved, const double *normal, double radius,
                   double limit, double unit, double modulus, double *force, double elastic,
                   double damping, const double *velocity, double time)
{
  return contactlab_springs_damped_step(state, n, moved, normal, radius, limit, unit, modulus,
                                        force, elastic, damping, velocity, time);
}
"""


@functools.cache
def in_space(springs):
    """Return four motions with turning normals and loss, and the forces by the rules."""
    motions = [damped(wandering(seed), seed) for seed in range(4)]
    return motions, [by_vectors(springs, rows) for rows in motions]


@pytest.mark.parametrize("springs", [*longer(2), 4, *longer(8)])
def test_it_is_the_rules_for_vectors(words, springs, tmp_path):
    """Through doublings, damping that presses, pulls and parts, lags from none to 100 steps."""
    motions, forces = in_space(springs)
    answers = driven_each(words, tmp_path, springs, motions)
    for rows, expected, found in zip(motions, forces, answers, strict=True):
        length = held_by_the_rules(rows, expected, found)
        assert 0.2 < (length < 0.99 * rows[:, 7]).mean() < 0.9  # both stick and slip


def test_without_damping_it_is_the_elastic_step_to_the_last_bit(words, tmp_path):
    rows = damped(wandering(5), 5)
    rows[:, DAMPING] = 0.0
    elastic, lossy = (driven(words, tmp_path, 8, each) for each in (rows[:, :8], rows))
    assert np.array_equal(elastic, lossy)


def test_no_rough_motion_gains_energy(words, tmp_path):
    """Of springs that slip, stick, merge and split; by the force at the end of each step."""
    motions = []
    for seed in range(20):
        rows = damped(wandering(seed, 300), seed)
        rows[:, 3:6] = 0.6, 0.0, 0.8
        if seed % 2:  # slip that goes on and turns back slowly
            rows[:, :3] = 0.05 * np.cumsum(rows[:, :3], axis=0)
        rows[:, VELOCITY] = rows[:, :3] / TIME
        motions.append(rows)
    for rows, found in zip(motions, driven_each(words, tmp_path, 4, motions), strict=True):
        given = np.cumsum(-np.einsum("ki,ki->k", found[:, :3], rows[:, :3]))
        assert given.min() >= -1e-14 * given.max()


def test_no_cycle_of_few_steps_pumps(words, tmp_path):
    """Loads and slips that repeat every two to five steps, the worst that a pump could ask for."""
    random, motions = np.random.default_rng(3), []
    for count in (2, 3, 4, 5) * 15:
        radius = 0.1 * random.uniform(0.3, 1.0, count) ** random.choice([0.2, 1.0, 3.0])
        limit = 4.0 * radius**3
        moved = random.normal(size=count) * 10.0 ** random.uniform(-8.0, -4.0)
        rows = np.zeros((count, 13))
        rows[:, 0], rows[:, 5], rows[:, 6] = moved - moved.mean(), 1.0, radius
        rows[:, ELASTIC] = limit
        rows[:, 7] = limit * (1.0 + random.uniform(-0.999, 3.0, count))
        rows[:, DAMPING] = TIME * 10.0 ** random.uniform(-2.0, 1.0) * MODULUS * radius
        rows[:, VELOCITY] = rows[:, :3] / TIME
        rows = np.tile(rows, (400 // count, 1))
        rows[0, 0] += random.choice([0.0, 1e-6])
        rows[0, VELOCITY] = rows[0, :3] / TIME
        motions.append(rows)
    for rows, found in zip(motions, driven_each(words, tmp_path, 4, motions), strict=True):
        given = np.cumsum(-found[:, 0] * rows[:, 0])
        assert given.min() >= -1e-14 * given.max()


def test_at_rest_and_after_a_loss_of_contact_there_is_no_friction(words, tmp_path):
    rows = np.zeros((40, 13))
    rows[:, 5], rows[:, 6] = 1.0, 0.1
    rows[:, 7], rows[:, ELASTIC], rows[:, DAMPING] = 1e-3, 8e-4, 10.0 * TIME * MODULUS * 0.1
    rows[10:20, 0] = 1e-7  # ten steps of slip
    rows[10:20, 10] = 1e-7 / TIME
    rows[30, 7] = 0.0  # damping pulls as hard as the spring presses
    force = driven(words, tmp_path, 8, rows)[:, 0]
    assert (force[:10] == 0.0).all()
    assert (force[20:30] < 0.0).all()
    assert (force[30:] == 0.0).all()


@pytest.mark.parametrize(
    ("column", "value"), [(ELASTIC, -1e-6), (DAMPING, -1e-6), ("time", -TIME), (11, np.nan),
                          *longer((ELASTIC, np.inf), (DAMPING, np.nan), ("time", np.nan))]
)  # fmt: skip
def test_what_is_no_damping_is_nan_until_the_contact_ends(words, column, value, tmp_path):
    rows, more = damped(sliding(1, 130)[0], 1), {}
    rows[:100, 7] += 1e-6  # in contact until 100
    if column == "time":
        more["time"] = value
    else:
        rows[90:, column] = value
    found = driven(words, tmp_path, 8, rows, **more)
    assert np.isnan(found[90:100]).all()
    if column != "time":
        assert np.isfinite(found[:90]).all()


@pytest.mark.slow
@needs_c
def test_no_undefined_behaviour(built, tmp_path):
    rows = damped(wandering(3), 3)
    rows[300, 6:9] = 5e-324, 1.0, 1.0
    rows[301, 6:9] = 1e300, 1.0, 0.5
    rows[302, 6:9] = 1e-300, 1e-300, 5e-324
    rows[303, DAMPING] = 1e300
    rows[304, DAMPING] = 5e-324
    rows[310:320, ELASTIC] = np.nan
    plain = driven([built()], tmp_path, 8, rows)
    found = driven([built(*SANITIZERS)], tmp_path, 8, rows)
    assert np.array_equal(found, plain, equal_nan=True)
    assert np.isfinite(plain[360:]).all()


@pytest.mark.slow
@needs_c
def test_single_precision(built, tmp_path):
    rows = damped(wandering(2), 2)
    double = driven([built()], tmp_path, 8, rows)
    single = driven([built("-DCONTACTLAB_REAL=float")], tmp_path, 8, rows)
    gap = np.linalg.norm(single[:, :3] - double[:, :3], axis=1)
    assert 0.0 < gap.max() <= 1e-3 * np.linalg.norm(double[:, :3], axis=1).max()


@pytest.fixture(scope="module")
def step(tmp_path_factory):
    """Return the step in C as a function of Python."""
    if COMPILER is None:
        pytest.skip("no C compiler (cc, gcc, clang) is there")
    folder = tmp_path_factory.mktemp("library")
    (folder / "springs.c").write_text(EXPORTED)
    made = folder / "springs.so"
    command = [COMPILER, *STRICT, "-Wno-unused-function", "-fPIC", "-shared", f"-I{KERNELS}"]
    subprocess.run([*command, folder / "springs.c", "-o", made, "-lm"], check=True, timeout=120)
    function = ctypes.CDLL(str(made)).damped_step
    number, several = ctypes.c_double, ctypes.POINTER(ctypes.c_double)
    function.restype = number
    function.argtypes = [several, ctypes.c_int, several, several, *[number] * 4, several]
    function.argtypes += [number, number, several, number]
    return function


def numbers(*values):
    """Return numbers as the kernel takes them."""
    return (ctypes.c_double * len(values))(*values)


def tsuji(overlap, rate, share=0.2):
    """Return elastic and viscous force, and damping, of P = z^1.5 + share z^.25 V."""
    return overlap**1.5, share * overlap**0.25 * rate, share * overlap**0.25


def hunt_crossley(overlap, rate, share=0.2):
    """Return the three of P = z^1.5 (1 + share V)."""
    return overlap**1.5, share * overlap**1.5 * rate, share * overlap**1.5


def viscoelastic(overlap, rate, lag=0.1):
    """Return the three of the viscoelastic contact."""
    elastic, damping = overlap**1.5, 1.5 * lag * overlap**0.5
    if rate >= 0.0:
        return elastic, damping * rate, damping
    return elastic, max(overlap + lag * rate, 0.0) ** 1.5 - elastic, damping


def impact(step, law, psi1, *, springs, steps=200, unit=1.0, start=0.5, shear_loss=1.0):
    """Return psi2, V2, and the energy lost in shear, in the scaled variables; velocity Verlet.

    The rate of the overlap at the end of a step is iterated. The slip velocity there is not
    known: it is continued from the middles of this step and of the one before.
    """
    time, along = CONTACT / steps, np.array([0.8, 0.6, 0.0])
    state, force = numbers(*[0.0] * (2 + 3 * springs)), numbers(0.0, 0.0, 0.0)
    overlap, rate, load = -start * time, 1.0, 0.0
    slip, friction, last, heat = psi1 * along, np.zeros(3), None, 0.0
    while load > 0.0 or rate > 0.0:
        middle, half = rate - 0.625 * time * load, slip + 1.25 * CHI * time * friction
        overlap, rate, slip, load, friction = overlap + time * middle, middle, half, 0.0, 0.0
        if overlap <= 0.0:
            continue
        for _ in range(5):
            elastic, viscous, damping = law(overlap, rate)
            load = max(elastic + viscous, 0.0)
            rate = middle - 0.625 * time * load
        velocity = half if last is None else 1.5 * half - 0.5 * last
        heat += step(
            state, springs, numbers(*time * half), numbers(0.0, 0.0, 1.0), overlap**0.5, load,
            unit, 1.5, force, elastic, shear_loss * damping, numbers(*velocity), time,
        )  # fmt: skip
        friction, last = np.array(force[:]), half
        slip = half + 1.25 * CHI * time * friction
    assert abs(np.cross(slip, along)).max() <= 1e-12
    return slip @ along, rate, heat


#: psi2 of springs that share the loss of a law, by psi1.
PSI1 = (0.5, 1.0, 2.0, 3.0, 4.0, 8.0)
TSUJI = dict(zip(PSI1, (-0.04377, -0.13498, -0.59223, -0.99929, -0.94568, 2.97295), strict=True))
STRONG = dict(zip(PSI1, (-0.06384, -0.13210, -0.27882, -0.44378, 0.17026, 4.17026), strict=True))
HUNT = dict(zip(PSI1, (-0.01521, -0.10221, -0.61957, -1.09486, -1.18397, 2.57486), strict=True))
VISCOUS = {
    0.05: {0.5: 0.009160, 1.0: -0.085073, 2.0: -0.724878, 3.0: -1.219935, 4.0: -1.256848},
    0.1: {0.5: -0.018386, 1.0: -0.107094, 2.0: -0.637783, 3.0: -1.089706, 4.0: -1.105620},
    0.2: {0.5: -0.050955, 1.0: -0.136844, 2.0: -0.513880, 3.0: -0.891083, 4.0: -0.859514},
    0.4: {0.5: -0.071125, 1.0: -0.153547, 2.0: -0.373254, 3.0: -0.639568, 4.0: -0.435211},
}


@pytest.mark.parametrize(
    ("law", "expected", "springs", "bound"),
    [
        (tsuji, TSUJI, 8, 8e-3),
        (tsuji, TSUJI, 50, 2e-3),
        (hunt_crossley, HUNT, 50, 2e-3),
        *longer((functools.partial(tsuji, share=0.9), STRONG, 50, 3.5e-3)),
        (functools.partial(viscoelastic, lag=0.4), VISCOUS[0.4], 50, 3e-3),
        *longer(*[(functools.partial(viscoelastic, lag=lag), VISCOUS[lag], 50, 2e-3)
                  for lag in (0.05, 0.1, 0.2)]),
    ],
)  # fmt: skip
def test_impacts_are_those_of_the_theory(step, law, expected, springs, bound):
    """200 steps a contact."""
    for psi1, psi2 in expected.items():
        assert impact(step, law, psi1, springs=springs)[0] == pytest.approx(psi2, abs=bound)


@pytest.mark.parametrize(("springs", "bound"), [(8, 8e-3), *longer((50, 2e-3))])
def test_contacts_of_any_size_and_any_start(step, springs, bound):
    """Units over an octave, within which the grid grows three times; any first touch in a step."""
    for unit, start in zip(2.0 ** np.linspace(0.0, 1.0, 20), itertools.cycle((0.1, 0.4, 0.9))):
        for psi1 in PSI1[1:4]:
            found = impact(step, tsuji, psi1, springs=springs, unit=unit, start=start)[0]
            assert found == pytest.approx(TSUJI[psi1], abs=bound)


@pytest.mark.parametrize(
    ("shear_loss", "ratios"), [(0.5, (0.155, 0.376, 0.398)), (2.0, (0.094, 0.235, 0.298)),
                               *longer((4.0, (0.105, 0.150, 0.199)))]
)  # fmt: skip
def test_shear_loss_is_a_number(step, shear_loss, ratios):
    """-psi2/psi1 of the theory, to three digits."""
    for psi1, ratio in zip((1.0, 2.0, 3.0), ratios, strict=True):
        found = impact(step, viscoelastic, psi1, springs=50, shear_loss=shear_loss)[0]
        assert -found / psi1 == pytest.approx(ratio, abs=1e-3)


@pytest.mark.parametrize("law", [tsuji, hunt_crossley, viscoelastic])
def test_slip_throughout_has_the_whole_limit(step, law):
    """psi2 = psi1 - 2 chi (1 + e), e of the engine's own normal motion."""
    psi2, rate, _ = impact(step, law, 6.0, springs=8, steps=50)
    assert psi2 == pytest.approx(6.0 - 2.0 * CHI * (1.0 - rate), abs=1e-12)


@pytest.mark.parametrize("psi1", [0.5, 2.0])
def test_what_the_step_returns_is_the_energy_lost(step, psi1):
    """Slip and springs begin with 1/(5 chi) psi1² and end with that of psi2."""
    errors = []
    for steps in (200, 400):
        psi2, _, heat = impact(step, tsuji, psi1, springs=50, steps=steps)
        errors.append(heat / ((psi1**2 - psi2**2) / (5.0 * CHI)) - 1.0)
    assert np.abs(errors).max() <= 5e-3
    assert abs(errors[1]) <= 0.6 * abs(errors[0])


@pytest.mark.skipif(NODE is None, reason="node is not there")
@needs_c
def test_c_and_javascript_lose_the_same(built, tmp_path):
    rows = damped(wandering(6), 6)
    javascript = [NODE, HERE / "drive.mjs"]
    javascript.append(KERNELS / "contactlab_springs.mjs")
    one, other = (driven(each, tmp_path, 8, rows) for each in ([built()], javascript))
    assert (np.abs(one - other).max(axis=0) <= 1e-13 * np.abs(one).max(axis=0)).all()
