"""The laws of the kit against their closed forms: checks are as good as the laws they run."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import contactlab
from contactlab.contracts import Increment, NormalContact
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing import laws
from contactlab.testing.load_paths import scene

CHI = 1.4411764706
HERTZ = contactlab.create("normal.hertz")
SCENE = scene(-2.0, CHI)
BATCH = scene(np.array([-2.0, 0.0, 3.0]), CHI)
NORMAL = HERTZ.motion(SCENE)
LOADED = NormalContact(5.0, 0.1, 1e-3, 4.0)


def moved(displacement=0.1, *, load=4.0, duration=0.5, drift=math.nan):
    """One step at a velocity of 0.2 m/s."""
    return Increment(displacement, 0.2, load, duration, drift)


def test_a_pressed_spring_rebounds_as_its_equations_do_in_time():
    """Hertz's contact is dV/dT = -1.25 zeta^1.5; the class integrates along the phase."""

    def slope(_, state):
        depth, rate, velocity, displacement = state
        force = max(depth, 0.0) ** 1.5
        return [rate, -1.25 * force, -1.3 * force * displacement, velocity]

    def parted(_, state):
        return state[0]

    parted.terminal, parted.direction = True, -1
    course = solve_ivp(
        slope, (0.0, 5.0), [0.0, 1.0, 1.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-14,
        events=parted,
    )  # fmt: skip
    assert course.t[-1] == pytest.approx(2.94327, abs=1e-5)  # Hertz's duration, in C²R/v1
    rebound = laws.PressedSpring.rebound(NORMAL)
    assert rebound == pytest.approx(float(course.y[2, -1]), abs=1e-9)


def test_a_pressed_spring_pulls_in_proportion_to_load_and_displacement():
    law = laws.PressedSpring()
    greatest = (
        1.3 * SCENE.pair.tangential_mass * (SCENE.normal_speed / NORMAL.maximum_approach) ** 2
    )
    assert law.stiffness(SCENE, NORMAL) == pytest.approx(greatest, rel=1e-14)
    state = law.start(SCENE, NORMAL)
    assert type(state.displacement) is float
    response, state = law.advance(state, moved(0.1), LOADED, LOADED)
    response, state = law.advance(state, moved(0.3), LOADED, LOADED._replace(force=2.0))
    assert response.force == pytest.approx(greatest / NORMAL.maximum_force * 2.0 * 0.4, rel=1e-14)
    assert response.friction_work == 0.0
    assert law.start(BATCH, HERTZ.motion(BATCH)).displacement.tolist() == [0.0, 0.0, 0.0]


def test_a_slider_has_the_friction_load_of_the_step_and_the_work_of_the_mean_force():
    law = laws.Slider()
    state = law.start(SCENE, NORMAL)  # psi1 < 0
    friction = SCENE.friction_coefficient
    first, state = law.advance(state, moved(-0.1, load=4.0), LOADED, LOADED)
    second, state = law.advance(state, moved(-0.1, load=6.0), LOADED, LOADED)
    assert (first.force, second.force) == (-4.0 * friction, -6.0 * friction)
    assert first.friction_work == pytest.approx(0.5 * 4.0 * 0.1 * friction)
    assert second.friction_work == pytest.approx(0.5 * (4.0 + 6.0) * 0.1 * friction)
    assert type(first.force) is float
    signs = law.start(BATCH, NORMAL).friction / friction
    assert signs.tolist() == [-1.0, 0.0, 1.0]


def test_a_yielding_spring_stops_at_coulombs_limit_and_pays_for_its_slip():
    law = laws.Yielding()
    assert law.stiffness(SCENE, NORMAL) == pytest.approx(
        2.0 * SCENE.pair.effective_shear_modulus * NORMAL.maximum_radius
    )
    state = law.start(SCENE, NORMAL)._replace(stiffness=10.0, friction=0.5)
    given = [  # load, displacement, force, work: the limit is half the load, the spring 10 N/m
        (4.0, 0.1, 1.0, 0.0),
        (4.0, 0.2, 2.0, 0.5 * (1.0 + 2.0) * 0.1),  # of 0.2 m the last 0.1 slips
        (4.0, 0.3, 2.0, 2.0 * 0.3),
        (4.0, -0.1, 1.0, 0.0),
        (4.0, -0.6, -2.0, 0.5 * (2.0 - 1.0) * 0.3),  # 0.1 m to no force, 0.2 m to -2 N
        (4.0, -0.1, -2.0, 2.0 * 0.1),
        (4.0, 0.4, 2.0, 0.0),
        (1.0, -0.4, -0.5, 0.0),  # slips back under a mean force forward: cut at zero
    ]
    for load, displacement, force, work in given:
        after = LOADED._replace(friction_load=load)
        response, state = law.advance(state, moved(displacement, load=9.0), LOADED, after)
        assert response.force == pytest.approx(force)
        assert response.friction_work == pytest.approx(work, abs=1e-15)
        assert type(response.force) is type(response.friction_work) is float
    three = law.start(BATCH, HERTZ.motion(BATCH))
    assert three.force.tolist() == [0.0, 0.0, 0.0]
    response, _ = law.advance(three, moved(np.array([0.1, 0.0, -0.1])), LOADED, LOADED)
    assert np.sign(response.force).tolist() == [1.0, 0.0, -1.0]


def test_sliding_for_ever_takes_4_chi_in_two_stretches():
    inertia, velocity = 2.5 * CHI, 9.0
    middle, last = laws.SlidingForEver().path(velocity, inertia, NORMAL, 1e-9)
    assert (middle.start, middle.stop, last.start, last.stop) == (0.0, 1.0, 1.0, math.pi)
    assert last.change == pytest.approx(-4.0 * CHI, rel=1e-12)
    assert last.work == pytest.approx(4.0 * CHI * (velocity - 2.0 * CHI) / inertia, rel=1e-12)
    rate = NORMAL.scaled_at(1.0).rate
    assert middle.change == pytest.approx(-2.0 * CHI * (1.0 - rate), rel=1e-12)
    change, force = last.states(NORMAL.scaled(np.array([1.0, math.pi])))
    assert change == pytest.approx([middle.change, last.change])
    assert force == pytest.approx([NORMAL.scaled_at(1.0).force, 0.0], abs=1e-15)


def test_sliding_for_ever_fails_as_it_is_asked():
    middle, last = laws.SlidingForEver(fails=True).path(9.0, 2.5 * CHI, NORMAL, 1e-9)
    assert math.isfinite(middle.change)
    assert math.isnan(last.change)
    assert math.isnan(last.work)
    with pytest.raises(ArithmeticError, match="as it was asked to"):
        next(laws.SlidingForEver(at_once=True).path(9.0, 2.5 * CHI, NORMAL, 1e-9))


@pytest.mark.parametrize(
    ("law", "approach", "rate", "force", "load"),
    [  # over Hertz's force at that depth; rate over v1
        (laws.DampedHertz(), 1e-3, 1.0, 1.2, None),
        (laws.DampedHertz(), 1e-3, -0.5, 0.9, None),
        (laws.StronglyDampedHertz(), 1e-3, 1.0, 1.9, None),
        (laws.SoftHertz(), 1e-3, 1.0, 0.1, None),
        (laws.DampedHertz(), -1e-3, 1.0, 0.0, None),
        (laws.DampedHertz(), 0.0, 1.0, 0.0, None),
    ],
)
def test_hertz_with_a_dashpot(law, approach, rate, force, load):
    pair = SCENE.pair
    inside = max(approach, 0.0)
    hertz = 4.0 / 3.0 * pair.effective_modulus * pair.radius**0.5 * inside**1.5
    contact, _ = law.respond(law.start(SCENE), approach, rate * SCENE.normal_speed)
    expected = (force * hertz, (pair.radius * inside) ** 0.5, approach)
    assert contact[:3] == pytest.approx(expected, rel=1e-14)
    assert contact.friction_load is load


def test_strong_damping_keeps_five_eighths_of_the_velocity():
    motion = normal_motion(laws.StronglyDampedHertz(), SCENE)
    assert -motion.final_rate / SCENE.normal_speed == pytest.approx(0.62, abs=0.002)


def test_pulling_hertz_is_hertz_less_a_twentieth_of_the_maximum():
    law, pair = laws.PullingHertz(), SCENE.pair
    pull = 0.05 * NORMAL.maximum_force
    for depth in (0.1 * NORMAL.maximum_approach, NORMAL.maximum_approach):
        hertz = 4.0 / 3.0 * pair.effective_modulus * pair.radius**0.5 * depth**1.5
        contact, _ = law.respond(law.start(SCENE), depth, 0.0)
        width = (pair.radius * depth) ** 0.5
        assert contact == pytest.approx((hertz - pull, width, depth, hertz), rel=1e-9)
    for depth in (0.0, -1e-6):
        assert law.respond(law.start(SCENE), depth, 0.0)[0] == (0.0, 0.0, depth, 0.0)
