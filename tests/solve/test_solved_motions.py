"""Solved normal motions at their limits: turns, steps, faults, and the tables they are kept in."""

from typing import ClassVar

import attrs
import numpy as np
import pytest
from scipy.optimize import brentq

from contactlab import HalfSpace, Material, Scene, Simulation, Sphere, Status, create
from contactlab.contracts import ClosedFormNormalLaw, NormalContact, NormalLaw
from contactlab.contracts.faults import LawFaultError
from contactlab.solve.normal_motion import normal_motion
from tests.laws.normal_laws import ForceFree, LinearSpring
from tests.laws.outside_laws import LinearDashpot

STEEL = Material(shear_modulus=80e9, poisson_ratio=0.3, density=7850.0)
MASS = 2.0


def scene(speed=1.0, slip=0.3, *, material=STEEL):
    return Scene(Sphere(0.01, STEEL, mass=MASS), HalfSpace(material), 0.2, speed, slip)


@attrs.frozen(kw_only=True)
class Swinging(NormalLaw):
    """A spring that holds the bodies until they have turned so many times."""

    api_version: ClassVar[int] = 2
    turns: int = 20

    def start(self, scene):
        return 0, 1.0

    def respond(self, state, approach, rate):
        turned, before = state
        turned += rate * before < 0.0
        overlap = -1.0 if turned >= self.turns else 1.0
        return NormalContact(1e6 * approach, 0.0, overlap), (turned, rate)


def test_bodies_may_turn_so_often_before_they_part():
    """They may rest at each turn, drawn back, and pass through without force in between."""
    for turns, ended in ((17, True), (18, False)):
        motion = normal_motion(Swinging(turns=turns), scene())
        assert (motion.status is Status.SUCCESS) is ended, turns
        if ended:  # each turn is half a period after the last, the first a quarter from the start
            quarter = 0.5 * np.pi * np.sqrt(MASS / 1e6)
            assert motion.duration == pytest.approx((2 * turns - 1) * quarter, rel=1e-6)
            assert abs(motion.maximum_approach) == pytest.approx(np.sqrt(MASS / 1e6), rel=1e-9)
    words = f"{motion.status.value} {motion.detail}"
    assert words.startswith("The bodies did not part within the steps allowed. At step ")
    assert words.endswith(f": the bodies do not separate, from Swinging in {__name__}.")


def test_a_force_that_no_step_can_follow_is_not_resolved():
    """A force that changes by a million times from one float to the next."""

    class Noisy(LinearSpring):
        def respond(self, state, approach, rate):
            contact, state = super().respond(state, approach, rate)
            if approach > 1e-6:
                contact = contact._replace(force=1e18 * np.sin(1e30 * approach))
            return contact, state

    result = Simulation(normal=Noisy(stiffness=1e7), tangential="coulomb").run(scene())
    assert result.status is Status.UNRESOLVED
    assert "steps became too short, from Noisy" in result.motion.detail


def test_a_force_that_is_no_number_is_named_with_step_and_time():
    class Blind(LinearSpring):
        def respond(self, state, approach, rate):
            contact, state = super().respond(state, approach, rate)
            return contact._replace(force=np.nan if approach > 1e-6 else contact.force), state

    result = Simulation(normal=Blind(stiffness=1e7), tangential="coulomb").run(scene())
    assert result.status is Status.NON_FINITE
    step, _, words = result.motion.detail.partition(", time ")
    assert step.startswith("At step ")
    assert float(words.partition(" s: ")[0]) == pytest.approx(1e-6, rel=1e-3)
    assert "a force that is not finite, from Blind" in words


def test_the_greatest_force_of_a_dashpot_lies_before_the_greatest_approach():
    """P = k z + c z' of the damped oscillation, whose greatest value is found by its slope."""
    stiffness, damping = 1e7, 0.2
    frequency = np.sqrt(stiffness / MASS)
    decay, turn = damping * frequency, frequency * np.sqrt(1.0 - damping**2)

    def place(time):
        return np.exp(-decay * time) * np.sin(turn * time) / turn

    def rate(time):
        return np.exp(-decay * time) * np.cos(turn * time) - decay * place(time)

    def force(time):
        return stiffness * place(time) + 2.0 * MASS * decay * rate(time)

    def slope(time):
        return stiffness * rate(time) - 2.0 * decay * force(time)

    top, deepest = brentq(slope, 0.0, 1.5 / turn), brentq(rate, 0.0, 3.0 / turn)
    law = LinearDashpot(stiffness=stiffness, damping=damping)
    speeds = np.array([0.5, 1.0])
    for one in (normal_motion(law, scene()), normal_motion(law, scene(speeds))):
        size = 1.0 if not one.scene.shape else speeds
        assert one.maximum_force == pytest.approx(size * force(top), rel=1e-9)
        assert one.maximum_approach == pytest.approx(size * place(deepest), rel=1e-9)
        end = brentq(force, 1.5 / turn, 4.0 / turn)
        assert one.duration == pytest.approx(np.full(one.scene.shape, end), rel=1e-9)
        assert one.final_rate == pytest.approx(size * rate(end), rel=1e-8)
        phases = np.linspace(0.0, np.pi, 6).reshape(6, *(1 for _ in one.scene.shape))
        sample = one.at(phases)
        times = phases / np.pi * end
        assert sample.approach == pytest.approx(size * place(times), rel=1e-8, abs=1e-14)
        assert sample.rate == pytest.approx(size * rate(times), rel=1e-8)
        assert sample.contact.force == pytest.approx(size * force(times), rel=1e-7, abs=1e-6)
        gone = MASS * size * (1.0 - rate(times))
        assert sample.load_impulse == pytest.approx(gone, rel=1e-6, abs=1e-9)
        assert sample.time == pytest.approx(times * np.ones_like(gone), rel=1e-9)


def test_a_closed_form_that_is_none_is_named():
    @attrs.frozen(kw_only=True)
    class Empty(ClosedFormNormalLaw):
        api_version: ClassVar[int] = 2

        def start(self, scene):
            return None

        def respond(self, state, approach, rate):
            return NormalContact(0.0, 0.0, -1.0), state

        def motion(self, scene):
            return 3.0

    with pytest.raises(
        LawFaultError, match=r"TypeError: motion returned 3\.0, which is no NormalM"
    ):
        normal_motion(Empty(), scene())


def test_a_motion_that_failed_is_nan_and_can_be_taken_apart():
    failed = Simulation(normal=Raising(), tangential="coulomb").normal_motion(
        scene([1.0, 2.0, 3.0])
    )
    assert [status.name for status in failed.status] == ["LAW_RAISED"] * 3
    assert np.isnan(failed.duration).tolist() == [True] * 3
    part, one = failed.take(slice(1, 3)), failed.take(1)
    assert part.scene.normal_speed.tolist() == [2.0, 3.0]
    assert [status.name for status in part.status] == ["LAW_RAISED"] * 2
    assert (one.status, one.detail) == (Status.LAW_RAISED, failed.detail[1])
    assert one.detail.startswith("At step 1: ArithmeticError: no start (start, line ")
    assert one.phase(0.5) == 0.5 * np.pi
    sample = failed.at(np.array([[0.0], [1.0]]))
    assert np.isnan([sample.time, sample.rate, *sample.contact]).all()
    assert sample.approach.shape == (2, 3)
    none = Simulation(normal=ForceFree(), tangential="coulomb").normal_motion(scene())
    assert none.status is Status.NOT_SEPARATED


@attrs.frozen(kw_only=True)
class Raising(LinearSpring):
    """A law that cannot begin."""

    def start(self, scene):
        raise ArithmeticError("no start")


def test_impacts_of_a_few_restitutions_move_as_each_alone():
    """Their motions have other numbers of steps, and other units of time."""
    e = np.array([0.9, 0.3, 0.9, 0.98])
    chi, psi1 = np.array([0.2, 3.5, 4.0, 5.0]), np.array([0.5, 1.5, 2.0, 0.3])
    together = Scene.nondimensional(psi1=psi1, chi=chi)
    motion = normal_motion(create("normal.viscoelastic", restitution=e), together)
    phase = np.linspace(0.0, np.pi, 30)
    samples = motion.at(phase[:, None])
    for k, each in enumerate(e.tolist()):
        law = create("normal.viscoelastic", restitution=each)
        alone = normal_motion(law, Scene.nondimensional(psi1=float(psi1[k]), chi=float(chi[k])))
        for name in ("duration", "final_rate", "maximum_force", "total_load_impulse"):
            assert getattr(motion, name)[k] == pytest.approx(getattr(alone, name), rel=1e-14)
        own = alone.at(phase)
        assert samples.approach[:, k] == pytest.approx(own.approach, abs=1e-14)
        assert samples.contact.force[:, k] == pytest.approx(own.contact.force, abs=1e-13)
        taken = motion.take(np.arange(4) == k)
        assert taken.final_rate[0] == motion.final_rate[k]
        assert -motion.final_rate[k] == pytest.approx(each, abs=1e-6)
