"""The half-space with spin about the normal: exact torsion, square cells, rings with modes."""

import itertools
import math
import re

import numpy as np
import pytest
from scipy.integrate import quad, trapezoid

import contactlab
from contactlab import Scene, Simulation
from contactlab.contracts.status import Status
from contactlab.impact.normal_spin import nodes
from contactlab_halfspace import checks
from tests.halfspace.square_grid import SquareGrid, rebound
from tests.halfspace.test_halfspace import CHI, simulation
from tests.halfspace.torsion import torsion
from tests.house.test_guide import rows
from tests.longer import longer

NU = 0.3
#: w in the unit of sigma, and chi_w in that of chi_t.
UNIT = 1.0 - 0.5 * NU
#: Pure torsion by springs and by integrals, theory §17, to 1e-9: sigma1, chi_t, sigma2.
TORSION = [
    (1.0, 0.1, 0.792230865),
    (2.0, 0.05, 1.894555291),
    (0.2, 0.05, 0.145379967),
    (0.5, 0.05, 0.408654101),
    (0.5, 0.3, -0.02858620),
]
#: Where the edge slips back while an annulus still slips forward: points of a half-space.
BEYOND = [(2.0, 1.0, -0.108821), (0.2, 1.0, -0.17460), (1.0, 3.0, 0.09250)]
#: psi1, w1, chi, chi_w, and psi2 and w2 by rings with Fourier modes and by a trial of this law.
BOTH = [
    (1.0, 0.5, CHI, 0.01, -0.3853, 0.48494),
    (0.5, 0.2, CHI, 0.01, -0.0514, 0.19081),
    (2.0, 0.35, CHI, 0.01, -0.9060, 0.34243),
    (0.988235, 0.399396, CHI, 0.00242147, -0.3145, 0.39614),
    (0.8, 0.3, 1.0, 0.005, -0.5907, 0.29371),
    (3.0, 2.0, 1.75, 0.03, -0.640, 1.95694),
]


def spun(psi1, w1, chi=CHI, chi_w=0.01, nu=NU):
    return Scene.nondimensional(psi1=psi1, chi=chi, poisson_ratio=nu, spin=w1, spin_inertia=chi_w)


def pure(sigma1, chi_t, **options):
    """sigma2 of an impact without slip."""
    result = simulation(**options).run(spun(0.0, sigma1 / UNIT, chi_w=chi_t / UNIT)).check()
    assert result.psi2 == 0.0
    return result.w2 * UNIT


@pytest.mark.parametrize(("sigma1", "chi_t", "sigma2"), [TORSION[0], *longer(*TORSION[1:])])
def test_two_programs_agree_on_torsion_to_nine_digits(sigma1, chi_t, sigma2):
    """The referee of the others, whose integrals share nothing with the springs."""
    assert torsion(sigma1, chi_t) == pytest.approx(sigma2, abs=1e-8)


def test_torsion_of_little_and_of_much_slip_is_a_closed_form():
    """All stuck the loss is linear; all slipping it is (15 pi/32)(4/5) B(6/5, 1/2)."""
    beta = math.gamma(1.2) * math.gamma(0.5) / math.gamma(1.7)
    assert (100.0 - torsion(100.0, 1e-3)) / 1e-3 == pytest.approx(0.375 * math.pi * beta, abs=1e-6)
    assert (1e-7 - torsion(1e-7, 1e-6, nodes=40)) / 1e-13 == pytest.approx(7.5462014746, rel=2e-5)


@pytest.mark.slow
@pytest.mark.parametrize(("sigma1", "chi_t", "sigma2"), TORSION)
def test_pure_spin_of_the_half_space(sigma1, chi_t, sigma2):
    assert pure(sigma1, chi_t, rings=64) == pytest.approx(sigma2, abs=1e-4)


@pytest.mark.parametrize("seed", longer(0, 1, 2, 3))
def test_pure_spin_of_any_size_is_that_of_the_integrals(seed):
    draw = np.random.default_rng(seed)
    sigma1, chi_t = 10.0 ** draw.uniform(-1.0, 0.5), 10.0 ** draw.uniform(-4.0, -1.0)
    loss = sigma1 - torsion(sigma1, chi_t)
    assert sigma1 - pure(sigma1, chi_t) == pytest.approx(loss, rel=2e-3)


@pytest.mark.parametrize(("sigma1", "chi_t", "sigma2"), longer(*BEYOND))
def test_beyond_a_stuck_disc_springs_are_no_more_exact(sigma1, chi_t, sigma2):
    assert pure(sigma1, chi_t, rings=64) == pytest.approx(sigma2, abs=1e-3)


@pytest.mark.slow
def test_a_small_steel_ball_loses_little():
    """C = 0.1, w1 = 0.5: theory §17's third program."""
    chi_w = 5.0 / 7.0 * CHI * 0.01
    result = simulation(rings=32).run(spun(0.0, 0.5, chi_w=chi_w)).check()
    assert result.w2 == pytest.approx(0.482234, abs=3e-5)
    assert torsion(0.5 * UNIT, chi_w * UNIT) / UNIT == pytest.approx(0.482234, abs=5e-7)


@pytest.mark.slow
@pytest.mark.parametrize(("sigma1", "chi_t", "sigma2"), TORSION)
def test_the_error_of_spin_is_of_second_order(sigma1, chi_t, sigma2):
    """Extrapolated; over one number of rings alone it is of order 1.2 to 1.5."""
    rings = np.array([32, 48, 64, 96])
    for options, order, room in (({}, 2.0, 0.2), ({"extrapolate": False}, 1.37, 0.15)):
        errors = [abs(pure(sigma1, chi_t, rings=int(n), **options) - sigma2) for n in rings]
        slope = np.polyfit(np.log(rings), np.log(errors), 1)[0]
        assert -slope == pytest.approx(order, abs=room)


@pytest.mark.parametrize(
    ("rings", "case"),
    [(32, BOTH[0]), *longer(*((64, case) for case in BOTH))],
)
def test_slip_and_spin_against_two_other_programs(rings, case):
    psi1, w1, chi, chi_w, psi2, w2 = case
    result = simulation(rings=rings).run(spun(psi1, w1, chi, chi_w)).check()
    bound = 2e-3 if w1 <= 0.5 else 5e-3
    assert result.psi2 == pytest.approx(psi2, abs=bound)
    assert result.w2 == pytest.approx(w2, abs=5e-5)
    (told,) = re.findall(r"numerical error of w2 (\S+)", str(result.plan))
    assert abs(result.w2 - w2) <= float(told) + 2e-5
    assert abs(result.psi2 - psi2) <= result.plan.psi2_error + 1e-3
    assert abs(result.energy.relative_imbalance) < 3e-4
    assert result.energy.checked


@pytest.mark.parametrize(("cells", "steps", "bound"), longer((16, 30, 7e-3), (32, 60, 5e-3)))
def test_square_cells(cells, steps, bound):
    """Another discretisation, another solver, other steps, and no mirror."""
    grid = SquareGrid(cells, NU, 0.0, 0.0)
    for psi1, w1, chi, chi_w, *_ in (BOTH[0], BOTH[4]):
        psi2, _, w2 = rebound(grid, psi1, chi, steps=steps, w1=w1, chi_w=chi_w)
        result = simulation().run(spun(psi1, w1, chi, chi_w)).check()
        assert result.psi2 == pytest.approx(psi2, abs=bound)
        assert w1 - result.w2 == pytest.approx(w1 - w2, rel=5e-3)


@pytest.mark.slow
def test_the_table_of_shifts():
    """psi2 and loss of a program of rings and modes, both at 32 rings."""
    axes, psi2, loss = nodes()
    for entry in itertools.product((0.5, 1.0, 2.0, 4.0), (1.0, 1.75), (0.1, 0.5, 2.0)):
        place = tuple(int(np.argmin(np.abs(axis - x))) for axis, x in zip(axes, entry, strict=True))
        psi1, chi, w1 = (float(axis[at]) for axis, at in zip(axes, place, strict=True))
        law = simulation(extrapolate=False)
        result = law.run(spun(psi1, w1, chi, 1e-5)).check()
        assert result.psi2 == pytest.approx(psi2[place], abs=6e-3)
        assert (w1 - result.w2) / 1e-5 == pytest.approx(loss[place], abs=0.01)


@pytest.mark.parametrize(("psi1", "chi"), [(7.0, CHI), *longer((9.0, 0.9), (14.0, 3.0))])
def test_slip_throughout_is_a_closed_form(psi1, chi):
    """To second order in w, friction mu P (1 - eps²/10) and its moment mu P a eps/5, theory §17."""

    def integral(power):
        def slip(rate):
            return (1.0 - rate**2) ** 0.4 / (psi1 - 2 * chi + (2 * chi - 1) * rate) ** power

        return quad(slip, -1.0, 1.0)[0]

    w1, chi_w = 0.5, 1e-4
    result = simulation().run(spun(psi1, w1, chi, chi_w)).check()
    alone = contactlab.rebound(psi1, chi)
    assert result.psi2 - alone == pytest.approx(0.2 * chi * w1**2 * integral(2), rel=0.04)
    assert (w1 - result.w2) / chi_w == pytest.approx(0.4 * w1 * integral(1), rel=0.01)


@pytest.mark.parametrize("psi1", [1.0, *longer(0.1, 0.5, 2.0, 4.0)])
def test_a_spin_that_vanishes_leaves_the_answer_without(psi1):
    """Two mirror classes, two tables: they meet where nothing turns."""
    still = simulation().run(Scene.nondimensional(psi1=psi1, chi=CHI, poisson_ratio=NU))
    hardly = simulation().run(spun(psi1, 1e-6))
    assert hardly.psi2 == pytest.approx(still.psi2, abs=1e-3)
    assert abs(hardly.psi2 - still.psi2) <= hardly.plan.psi2_error + still.plan.psi2_error


@pytest.mark.slow
@pytest.mark.parametrize(
    ("psi1", "w1", "bound"),
    [([0.5, 1.0, 2.0, 3.0], [0.2, 0.5, 0.35, 0.5], 1e-3), ([1.0, 3.0, 4.0, 7.0], 5.0, 5e-3)],
)
def test_eight_angles_are_enough(psi1, w1, bound):
    """As far as the law declares."""
    scene = spun(np.array(psi1), np.array(w1))
    runs = [simulation(rings=24, angles=n).run(scene) for n in (8, 12, 16)]
    assert np.ptp([run.psi2 for run in runs], axis=0).max() < bound
    assert np.ptp([run.w2 for run in runs], axis=0).max() < 0.1 * bound
    assert (runs[0].plan.psi2_error >= bound).all()


def test_a_batch_with_and_without_spin_is_its_impacts():
    psi1, w1 = np.array([1.0, 0.5, 0.0, 2e7, -1.0]), np.array([0.5, 0.0, 0.3, 1.0, -0.5])
    law = simulation(rings=8)
    whole = law.run(spun(psi1, w1)).check()
    for place, pair in enumerate(zip(psi1.tolist(), w1.tolist(), strict=True)):
        one = law.run(spun(*pair)).check()
        assert (whole.psi2[place], whole.w2[place]) == pytest.approx((one.psi2, one.w2), rel=1e-12)
    without = law.run(Scene.nondimensional(psi1=0.5, chi=CHI, poisson_ratio=NU))
    assert (whole.psi2[1], whole.w2[1]) == (without.psi2, 0.0)
    assert (whole.psi2[4], whole.w2[4]) == (-whole.psi2[0], -whole.w2[0])
    assert whole.w2[3] == pytest.approx(1.0, abs=1e-6)
    said = [str(one) for one in whole.plan.computed if "about the normal" in str(one)]
    assert said == [
        "spin about the normal (4 of 5 impacts): slip and spin share the friction",
    ]


def test_a_viscous_normal_motion_takes_spin_by_its_own_radius():
    """The moment of a contact that slips throughout is (3 pi/16) mu P a, whatever made P."""
    normal = contactlab.create("normal.tsuji", restitution=0.7)
    scene = spun(0.0, 200.0, chi_w=1e-4)
    result = simulation(normal).run(scene).check()
    phase = np.linspace(0.0, np.pi, 4001)
    motion = Simulation(normal=normal, tangential="coulomb").normal_motion(scene)
    sample = motion.at(phase)
    moment = 3.0 * np.pi / 16.0 * scene.friction_coefficient * sample.contact.radius
    impulse = trapezoid(moment * sample.contact.friction_load, sample.time)
    change = impulse * scene.pair.inverse_spin_mass / scene.pair.radius**2
    assert -result.motion.normal_spin_change == pytest.approx(change, rel=2e-3)
    assert abs(result.energy.relative_imbalance) < 1e-3


def test_fields_carry_force_and_moment():
    """Their sum over the half circle and its mirror image is the force, for all signs."""
    law, told = simulation(rings=32, extrapolate=False), {}
    for psi1, w1 in ((1.0, 0.5), (1.0, -0.5), (-1.0, 0.5)):
        scene = spun(psi1, w1)
        history = law.run(scene, history="fields").check().history
        fields = history.fields
        where = int(np.argmin(np.abs(history.time - 0.45 * history.time[-1])))
        angle, radius = fields["angle"][where], fields["radius"][where]
        assert (np.cos(angle) < 0.0).all()
        along, across = fields["traction_x"][where], fields["traction_y"][where]
        friction = float(scene.friction_coefficient)
        limit = friction * fields["pressure"][where] * (1.0 + 1e-6)
        assert (np.hypot(along, across) <= limit).all()
        ring = np.gradient(radius) * radius
        force = 2.0 * np.pi * (along.mean(axis=0) * ring).sum()
        assert force == pytest.approx(history.tangential_force[where], rel=0.02)
        circling = across * np.cos(angle)[:, None] - along * np.sin(angle)[:, None]
        moment = 2.0 * np.pi * (circling.mean(axis=0) * ring * radius).sum()
        assert moment * w1 > 0.0  # opposes the spin
        assert fields["stuck"][where].any()
        told[psi1, w1] = force, moment
    assert told[1.0, -0.5] == pytest.approx((told[1.0, 0.5][0], -told[1.0, 0.5][1]), rel=1e-12)
    assert told[-1.0, 0.5] == pytest.approx((-told[1.0, 0.5][0], told[1.0, 0.5][1]), rel=1e-12)


@pytest.mark.parametrize(
    "options", [{"angles": 1}, {"coupling": "one_way"}, {"coupling": "two_way"}]
)
def test_options_that_do_not_answer_spin_say_so(options):
    """They give the answer without it, and the caution with its size."""
    still = Scene.nondimensional(psi1=1.0, chi=CHI, poisson_ratio=NU)
    law = simulation(rings=16, **options)
    assert "normal_spin" not in law.laws.capability.tangential_claims
    result = law.run(spun(1.0, 0.5)).check()
    assert (result.psi2, result.w2) == (law.run(still).psi2, 0.5)
    assert "Effect on psi2: about 0.33" in " ".join(result.cautions)
    with pytest.raises(contactlab.ImpactError, match="about the normal"):
        result.check(cautions=True)


@pytest.mark.parametrize("seed", longer(*range(1, 8)))
def test_random_impacts_gain_no_energy_and_keep_their_signs(seed):
    draw = np.random.default_rng(seed)
    count = 4
    chi = 10.0 ** draw.uniform(-0.5, 0.5, count)
    scene = spun(
        chi * draw.uniform(-5.0, 5.0, count),
        10.0 ** draw.uniform(-2.0, 1.0, count) * draw.choice((-1.0, 1.0), count),
        chi,
        10.0 ** draw.uniform(-5.0, -1.0, count),
        draw.uniform(0.0, 0.5, count),
    )
    result = simulation(rings=16).run(scene)
    assert (result.status == Status.SUCCESS).all()
    assert (result.energy.friction_work >= 0.0).all()
    assert (result.energy.end <= result.energy.start * (1.0 + 1e-12)).all()
    assert np.abs(result.energy.relative_imbalance).max() < 3e-3
    assert (result.motion.normal_spin_change * scene.normal_spin < 0.0).all()


@pytest.mark.slow
@pytest.mark.parametrize("psi1", [0.5, -2.0])
def test_fast_spin_slows_slip_less_and_less_and_never_speeds_it_up(psi1):
    """The error of rings falls by the square there: 64 rings leave psi2 to 4e-4 at w = 50."""
    law, w = simulation(), np.array([50.0, 1e3, 1e4, 1e6])
    scene = Scene.nondimensional(psi1=psi1, chi=CHI, spin=w, spin_inertia=0.01)
    result = law.run(scene).check()
    kept = result.psi2 / psi1
    assert (np.diff(kept) > 0.0).all()
    assert 0.999 < kept[-1] <= 1.0
    if psi1 == 0.5:
        assert result.psi2[0] == pytest.approx(0.4277, abs=1e-3)  # of 32 and 64 rings


def test_what_validation_compares_with_is_in_the_theory():
    assert set(checks.TORSION) < {tuple(row) for row in rows("17")}
