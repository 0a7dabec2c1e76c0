"""Scenes, benches and paths of the kit: their numbers, and the scales of what they return."""

import itertools

import numpy as np
import pytest

import contactlab
from contactlab.compose.normal_motion import normal_motion
from contactlab.impact.hertz import hertz_scales
from contactlab.testing import limits
from contactlab.testing.load_paths import (
    HEAVY,
    QUANTITIES,
    Bench,
    Path,
    bodies,
    continue_from,
    drive,
    scene,
    slack,
    straight,
    varied,
    wandering,
)
from contactlab.testing.units import ODD_UNITS
from tests.testing.broken_laws import Sound

CHI = 1.4411764706


def test_the_ball_is_one_of_steel():
    """R 12.7 mm, E* 112 GPa, 67 g at 0.83 m/s; kappa = 2(1 - nu)/(2 - nu) of nu = 0.3."""
    ball = scene(2.0, CHI)
    pair = ball.pair
    assert (pair.radius, pair.effective_modulus, pair.normal_mass) == (0.0127, 1.12e11, 0.067)
    assert (ball.normal_speed, ball.friction_coefficient) == (0.83, 0.3)
    assert pair.effective_shear_modulus / pair.effective_modulus == pytest.approx(
        1.4 / 1.7, abs=1e-6
    )
    assert (ball.sphere, ball.target, ball.spin) == (None, None, 0.0)


@pytest.mark.parametrize("sizes", [1.0, 0.6, 1.6, np.array([0.6, 1.0, 1.6])], ids=str)
@pytest.mark.parametrize("units", [None, ODD_UNITS])
def test_every_scene_has_its_psi1_and_chi(sizes, units):
    for psi1, chi, friction in ((2.0, CHI, 0.3), (-7.0, 0.4, 0.02)):
        given = scene(psi1, chi, friction=friction, units=units, bodies=sizes)
        assert given.psi1 == pytest.approx(psi1, rel=1e-12)
        assert given.chi == pytest.approx(chi, rel=1e-12)
        assert np.all(given.friction_coefficient == friction)


def test_other_units_are_of_length_time_and_mass():
    """ODD_UNITS are the values of a metre, a second and a kilogram."""
    metre, second, kilogram = ODD_UNITS
    si, odd = scene(2.0, CHI, bodies=0.7), scene(2.0, CHI, bodies=0.7, units=ODD_UNITS)
    pascal = kilogram / metre / second**2
    for name, unit in (
        ("radius", metre),
        ("effective_modulus", pascal),
        ("effective_shear_modulus", pascal),
        ("normal_mass", kilogram),
        ("tangential_mass", kilogram),
    ):
        assert getattr(odd.pair, name) == pytest.approx(unit * getattr(si.pair, name), rel=1e-12)
    for name in ("normal_speed", "tangential_velocity"):
        ratio = getattr(odd, name) / getattr(si, name)
        assert ratio == pytest.approx(metre / second, rel=1e-12)


def test_unlike_bodies_differ_in_everything():
    pairs = [scene(2.0, CHI, bodies=size) for size in (0.6, 1.6)]
    for name in ("radius", "effective_modulus", "effective_shear_modulus", "normal_mass"):
        first, second = (getattr(each.pair, name) for each in pairs)
        assert not 0.9 < first / second < 1.1, name
    assert pairs[0].normal_speed > 1.1 * pairs[1].normal_speed
    kappas = [each.pair.stiffness_ratio for each in pairs]
    assert kappas[0] > 1.05 * kappas[1]
    assert max(kappas) < 1.0
    assert bodies(2, 3) == pytest.approx(np.array([[0.6, 0.8, 1.0], [1.2, 1.4, 1.6]]))


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_varied_batch_differs_in_one_quantity(quantity):
    base, batch = scene(0.0, HEAVY), varied(quantity)
    for name in QUANTITIES:
        owners = (base.pair, batch.pair) if hasattr(base.pair, name) else (base, batch)
        one, other = (getattr(owner, name) for owner in owners)
        factors = [0.6, 1.1, 1.6] if name == quantity else 1.0
        assert other / one == pytest.approx(factors)
    assert batch.shape == (3,)
    assert varied(quantity, count=2).shape == (2,)


def test_a_bench_has_the_scales_of_hertz():
    bench = Bench.of()
    scales, pair = hertz_scales(bench.scene), bench.scene.pair
    assert bench.scene.chi == pytest.approx(HEAVY)
    assert bench.radius == pytest.approx(scales.radius)
    assert bench.force == pytest.approx(scales.force)
    assert bench.approach == pytest.approx(scales.approach)
    assert bench.time == pytest.approx(scales.duration)
    kappa = pair.effective_shear_modulus / pair.effective_modulus
    assert bench.slip == pytest.approx(0.3 * scales.approach / kappa)
    assert bench.friction_force == pytest.approx(0.3 * scales.force)
    # Gross slip begins at slip = zeta: mu P over 2 G* a times 2/3, Cattaneo and Mindlin's
    limit = 0.3 * scales.force / (2.0 * pair.effective_shear_modulus * scales.radius) * 1.5
    assert bench.slip == pytest.approx(limit)


def test_the_contacts_of_a_bench_differ_in_bodies_and_friction():
    bench = Bench.of((2, 3))
    friction = np.linspace(0.1, 0.7, 6).reshape(2, 3)
    assert bench.scene.friction_coefficient == pytest.approx(friction)
    assert bench.scene.pair.radius / 0.0127 == pytest.approx(bodies(2, 3))
    for place in ((0, 0), (1, 2)):
        one, scales = bench.alone(place), hertz_scales(bench.scene.take(place))
        assert one.force == pytest.approx(scales.force)
        assert one.slip == pytest.approx(bench.slip[place])
        assert one.time == pytest.approx(bench.time[place])
        assert one.scene.friction_coefficient == friction[place]


def test_the_bench_of_a_softer_law_is_as_wide_as_its_contact():
    soft = normal_motion(contactlab.testing.laws.SoftHertz(), scene(0.0, HEAVY))
    bench = Bench.along(soft)
    assert bench.radius == soft.maximum_radius > 1.5 * Bench.of().radius
    assert bench.time == soft.duration


@pytest.mark.parametrize(
    ("level", "force", "radius"), [(0.49, 0.343, 0.7), (0.0, 0.0, 0.0), (-0.3, 0.0, 0.0)]
)
def test_the_contact_at_a_level_is_hertz(level, force, radius):
    bench = Bench.of()
    contact = bench.contact(level)
    expected = (force * bench.force, radius * bench.radius, level * bench.approach)
    assert contact[:3] == pytest.approx(expected)
    assert contact.friction_load == contact.force
    many = Bench.of((3,)).contact(np.array([0.1, 0.2, 0.3]))
    assert not any(entry.flags.writeable for entry in many)


def test_an_increment_is_scaled_by_the_unit_of_slip():
    bench = Bench.of()
    after = bench.contact(0.5)
    step = bench.increment(0.2, after, 0.01)
    moved = 0.2 * bench.slip
    assert step == pytest.approx((moved, moved / 0.01, after.friction_load, 0.01, 0.01))
    many = Bench.of((2,))
    steps = many.increment(np.array([0.2, 0.3]), many.contact(np.array([0.5, 0.5])), many.time)
    assert not steps.displacement.flags.writeable
    assert not steps.velocity.flags.writeable


def test_a_straight_path_goes_from_knot_to_knot():
    path = straight((0.0, 1.0), (-2.0, 0.5), steps=2)
    assert path.slip.tolist() == [0.0, 0.0, -1.0, -2.0]
    assert path.level.tolist() == [0.5, 1.0, 0.75, 0.5]
    assert len(straight((1.0, 1.0)).slip) == 40


@pytest.mark.parametrize("fixed", [False, True])
def test_a_wandering_path_presses_first_and_then_moves(fixed):
    path = wandering(3, fixed=fixed)
    assert len(path.slip) == len(path.level) == 12 * 16
    assert np.all(path.slip[:16] == 0.0)
    assert np.all(np.diff(path.level[:16], prepend=0.0) > 0.0)
    knots = path.level[15::16]
    assert 0.05 <= knots.min() <= knots.max() <= 1.0
    assert np.all(knots == 0.7) == fixed
    assert np.all(path.level > 0.0)
    slips = np.concatenate([wandering(seed).slip[31::16] for seed in range(100)])
    assert np.std(slips) == pytest.approx(0.8, rel=0.1)
    assert np.mean(slips) == pytest.approx(0.0, abs=0.1)
    assert wandering(3, fixed=fixed).slip.tolist() == path.slip.tolist()
    assert wandering(4).slip.tolist() != path.slip.tolist()
    assert len(wandering(3, knots=2, steps=5).slip) == 10


def test_a_driven_law_answers_in_units_of_friction_and_slip():
    """A spring and a slider: at zeta = 0.49 the limit is 0.343 mu P_max."""
    bench, law = Bench.of(), Sound()
    path = straight((0.0, 0.49), (0.1, 0.49), (3.0, 0.49), steps=4)
    answers = drive(law, bench, path)
    # 0.7 of 2 G* a by one unit of slip is 0.7 times 1.5 mu P_max
    assert answers.force[:4] == pytest.approx([0.0] * 4)
    assert answers.force[4:8] == pytest.approx(1.05 * np.array([0.025, 0.05, 0.075, 0.1]))
    assert answers.force[-1] == pytest.approx(0.343)
    # Each step of the last leg is 0.725; of the first one a part stretches the spring.
    first = 0.725 - (0.343 - 0.105) / 1.05
    assert answers.work[8] == pytest.approx(first * 0.5 * (0.105 + 0.343))
    assert answers.work[9:] == pytest.approx([0.725 * 0.343] * 3)
    assert not answers.work[:8].any()
    assert limits.DOING.what == "a path of 12 steps"
    assert limits.DOING.steps == 12
    half = drive(law, bench, Path(path.slip[:6], path.level[:6]))
    rest = Path(path.slip[6:], path.level[6:])
    on = continue_from(law, bench, half.state, rest, slip=path.slip[5], level=0.49, count=12)
    assert on.force == pytest.approx(answers.force[6:])
    assert on.work == pytest.approx(answers.work[6:])
    assert on.state.force == pytest.approx(answers.state.force)
    empty = continue_from(law, bench, half.state, Path(path.slip[:0], path.level[:0]), count=1)
    assert empty.state is half.state


def test_the_steps_of_a_path_share_the_duration_of_an_impact():
    seen = []

    class Watched(Sound):
        def advance(self, state, increment, before, after):
            seen.append((increment, before, after))
            return super().advance(state, increment, before, after)

    bench, path = Bench.of(), straight((0.1, 0.5), (0.3, 0.8), steps=2)
    continue_from(Watched(), bench, bench.start(Sound()), path, count=8)
    assert [step.duration for step, _, _ in seen] == [bench.time / 8] * 4
    assert [step.drift for step, _, _ in seen] == [bench.time / 8] * 4
    moved = np.diff(path.slip, prepend=0.0) * bench.slip
    assert [step.displacement for step, _, _ in seen] == pytest.approx(moved)
    assert seen[0][1] == bench.contact(0.0)
    for (_, _, after), (_, before, _) in itertools.pairwise(seen):
        assert before == after
    assert [step.friction_load for step, _, _ in seen] == [after.force for _, _, after in seen]
    seen.clear()
    drive(Watched(), bench, path)
    assert seen[0][0].duration == bench.time / 4


def test_a_law_with_a_resolution_has_room_for_it():
    springs = contactlab.create("tangential.springs")
    assert (slack(springs), slack(springs, 1e-6)) == (0.02, 0.02)
    assert (slack(Sound()), slack(Sound(), 1e-6), slack(Sound(), 0.0)) == (1e-9, 1e-6, 0.0)
