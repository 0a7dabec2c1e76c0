"""The exact impact in C under sanitizers, beside Python's solver of the same equations."""

import subprocess

import numpy as np
import pytest

from contactlab_laws.fronts import compiled
from contactlab_laws.fronts.path import Impact
from tests.kernels.test_kernels import needs_c, program

pytestmark = needs_c
#: Steps of an impact, and error of a step.
MOST, TOLERANCE = 20_000, 5e-13


@pytest.fixture(scope="module", params=["c99", pytest.param("c++", marks=pytest.mark.slow)])
def followed(request, tmp_path_factory):
    """Return a function of psi1, chi, lam, eta (4, n) that gives statuses and answers (7, n).

    As attributes it has those of the watched impacts, and their instants, a row each.
    """
    folder = tmp_path_factory.mktemp("impact")
    built = program("impact", request.param, folder)

    def run(numbers, tolerance=TOLERANCE, most=MOST):
        rows = np.full((np.shape(numbers)[1], 6), (0.0, 0.0, 0.0, 0.0, tolerance, most))
        rows[:, :4] = np.transpose(numbers)
        rows.tofile(folder / "in")
        command = [built, *(folder / name for name in ("in", "out", "instants"))]
        subprocess.run(command, check=True, timeout=300)
        answers = np.fromfile(folder / "out").reshape(-1, 16).T
        run.watched = answers[8].astype(int), answers[9:]
        run.instants = np.fromfile(folder / "instants").reshape(-1, 12).T
        return answers[0].astype(int), answers[1:8]

    return run


def drawn(count, seed):
    """Return random impacts: spheres, bodies, jams, and slip that begins or ends by a hair."""
    draw = np.random.default_rng(seed)
    chi = 10.0 ** draw.uniform(-0.5, 1.0, count)
    lam = draw.uniform(-3.0, 3.0, count) * draw.choice([0.0, 0.1, 1.0], count)
    most = np.minimum(1.9 * chi / np.maximum(np.abs(lam), 1e-9), 3.0)
    eta = np.sign(lam) * draw.uniform(0.0, 1.0, count) * most
    psi1 = draw.uniform(-6.0, 6.0, count)
    near = draw.choice([-1.0, 1.0], count) * 10.0 ** draw.uniform(-12.0, -1.0, count)
    psi1 = np.where(draw.random(count) < 0.2, 1.0 + near, psi1)
    return np.array([psi1, chi, lam, eta])


def by_python(numbers):
    answers = []
    for row in numbers.T.tolist():
        impact = Impact(*row, tolerance=TOLERANCE, most=MOST)
        assert impact.follow() == 0
        answers.append(impact.ends()[:6])
    return np.array(answers).T


def test_random_impacts_are_those_of_python(followed):
    numbers = drawn(150, 1)
    status, found = followed(numbers)
    assert not status.any()
    expected = by_python(numbers)
    scale = np.maximum(1.0, np.abs(expected))
    off = np.abs(found[:6] - expected) / scale
    assert off[:5].max() < 1e-11  # time and radius too; velocities by the next test
    assert off[1].max() < 1e-12 * 3.0  # jams multiply rounding
    assert np.array_equal(found[5], expected[5])


def test_spheres_to_rounding(followed):
    draw = np.random.default_rng(2)
    chi = draw.uniform(0.3, 10.0, 60)
    numbers = np.array([draw.uniform(0.0, 4.0 * chi), chi, 0.0 * chi, 0.0 * chi])
    status, found = followed(numbers)
    assert not status.any()
    off = np.abs(found[:5] - by_python(numbers)[:5])
    assert (off / np.maximum(1.0, numbers[0])).max() < 1e-12


def test_closed_forms(followed):
    """Slip throughout; chi = 1/2, where nothing is lost; Hertz's duration; the books."""
    chi = np.array([0.3, 1.0, 2.0])
    psi1 = np.maximum(1.0, 4.0 * chi - 1.0) * 1.5
    status, found = followed([psi1, chi, 0.0 * chi, 0.0 * chi])
    assert not status.any()
    assert found[1] == pytest.approx(-4.0 * chi, rel=1e-14)
    assert found[3] == pytest.approx(2.9432751843247043, rel=1e-14)
    _, found = followed([[0.2, 0.9], [0.5, 0.5], [0.0, 0.0], [0.0, 0.0]])
    assert found[1] == pytest.approx([-0.4, -1.8], abs=1e-12)
    assert found[2] == pytest.approx([0.0, 0.0], abs=1e-12)
    numbers = drawn(200, 3)
    numbers[2:] = 0.0
    _, found = followed(numbers)
    psi1, chi = numbers[:2]
    lost = -found[1] * (psi1 + 0.5 * found[1]) / chi  # over mu² v1² M_n/(2 kappa), twice
    assert 2.5 * found[2] == pytest.approx(lost, abs=1e-11 * np.max(np.maximum(1.0, psi1**2)))


def test_steps_that_are_shown_lead_to_the_answer(followed):
    """Gross slip is stepped there; in time they go on, and end where the impact ends."""
    numbers = drawn(60, 5)
    _, found = followed(numbers)
    status, watched = followed.watched
    assert not status.any()
    assert np.abs(watched[:5] - found[:5]).max() < 1e-10
    impact, part, *_, time, radius, rate, stick, psi, _ = followed.instants
    same = np.diff(impact) == 0
    assert np.diff(time)[same].min() > -1e-12
    assert set(np.diff(part)[same]) <= {0.0, 1.0}
    assert (stick <= radius + 1e-12).all()
    last = np.append(~same, True)
    assert radius[last] == pytest.approx(np.zeros(60), abs=1e-12)
    assert rate[last] == pytest.approx(found[0], abs=1e-11)
    assert time[last] == pytest.approx(watched[3], abs=1e-12)
    assert psi[last] - numbers[0] == pytest.approx(found[1], abs=1e-10)


def test_instants_of_spheres_obey_closed_forms(followed):
    """V² + u⁵ = 1; Coulomb's force where all slips; psi = psi1 V and F = psi1 P at chi = 1/2."""
    draw = np.random.default_rng(6)
    chi = np.append(draw.uniform(0.3, 10.0, 30), 0.5)
    psi1 = np.append(draw.uniform(-3.0, 3.0, 30) * chi[:30], 0.7)
    followed([psi1, chi, 0.0 * chi, 0.0 * chi])
    impact, _, phase, sign, change, _, _, u, rate, stick, psi, force = followed.instants
    assert np.abs(rate**2 + u**5 - 1.0).max() < 1e-11
    slips = phase == 3.0
    assert slips.any()
    assert np.abs(force - sign * u**3)[slips].max() < 1e-12
    assert np.abs(stick[slips]).max() == 0.0
    assert (np.abs(force) <= u**3 + 1e-12).all()
    half = impact == 30.0
    assert np.abs(psi - 0.7 * rate)[half].max() < 1e-12
    assert np.abs(force - 0.7 * u**3)[half].max() < 1e-12
    begins = np.arange(impact.size) % 3 == 0
    off = psi[begins] - psi1[impact[begins].astype(int)] - change[begins]
    assert np.abs(off).max() < 1e-12


@pytest.mark.slow
def test_no_impact_gains_energy(followed):
    """Of 20,000: V² + ... with W the inverse of the energy's matrix (theory §14)."""
    numbers = drawn(20_000, 4)
    numbers = numbers[:, np.abs(numbers[2] * numbers[3]) < 1.9 * numbers[1]]
    status, found = followed(numbers)
    assert not status.any()
    psi1, chi, lam, eta = numbers
    rho = np.where(lam == 0.0, 1.0, np.divide(lam, eta, out=np.ones_like(lam), where=eta != 0.0))

    def energy(rate, psi):  # over 1/(2 W_nn): (V, rho psi') on the inverse of W over W_nn
        slip = rho * psi
        whole = 2.0 * chi * rho - lam * lam
        return (2.0 * chi * rho * rate**2 - 2.0 * lam * rate * slip + slip**2) / whole

    with np.errstate(invalid="ignore"):
        start, end = energy(1.0, psi1), energy(found[0], psi1 + found[1])
    sound = (eta == 0.0) | (np.abs(lam) > 1e-6)
    sound &= (eta != 0.0) | (lam == 0.0)
    assert sound.sum() > 15_000
    assert (end - start)[sound].max() < 1e-9 * np.max(start[sound])


def test_what_ends_without_an_answer(followed):
    numbers = [[1.2], [1e6], [0.0], [0.0]]
    assert followed(numbers, most=5)[0].tolist() == [1]
    assert compiled.LOST[1].format(5) == "The contact neither ends nor settles in 5 steps"


@pytest.mark.parametrize(
    ("place", "values"),
    [
        (0, (np.nan, np.inf, -np.inf)),
        (1, (-1.0, 0.0, np.nan, np.inf)),
        (2, (np.nan, np.inf, 2.0)),
        (3, (np.nan, -np.inf, 3.0)),
        ("tolerance", (0.0, -1e-9, np.nan, 1.0)),
        ("most", (0, -5)),
    ],
)
def test_what_no_bodies_have_is_a_status_and_the_impact_before_first_touch(followed, place, values):
    """A number that is none, chi that is not positive, lam eta from 2 chi on."""
    for value in values:
        numbers = np.array([[0.5], [1.4], [1.5], [1.8]])
        given = {} if isinstance(place, int) else {place: value}
        if not given:
            numbers[place] = value
        status, left = followed(numbers, **given)
        assert status.tolist() == [4], (place, value)
        assert left[:, 0].tolist() == [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]


def test_no_finite_numbers_give_an_answer_that_is_none(followed):
    """Of any size: an answer of numbers, or a status."""
    draw = np.random.default_rng(12)
    size = 10.0 ** draw.uniform(-300.0, 300.0, (4, 400))
    numbers = draw.choice([-1.0, 1.0], (4, 400)) * size
    numbers[1] = np.abs(numbers[1])
    numbers[2:, :100] = 0.0
    status, left = followed(numbers, most=300)
    assert set(status) <= {0, 1, 2, 3, 4}
    assert np.isfinite(left[:2, status == 0]).all()
