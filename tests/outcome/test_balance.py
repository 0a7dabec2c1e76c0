"""Books that balance and books that do not, at both sides of every bound, alone and in a batch."""

import math

import numpy as np
import pytest

from contactlab import Status
from contactlab.outcome.energy import balanced
from contactlab.outcome.motion import sound
from tests.outcome.made import motion, scene

NAN = math.nan
JUST = 1e-9
#: An end that is right, and one that is energy from nothing: e = 1.02, slip of 1.1 times 5 m/s,
#: books that miss 0.01 of 4.5 J, and the sentence.
ENDS = [
    ({"normal_velocity": -2.04 * (1 - JUST)}, {"normal_velocity": -2.04 * (1 + JUST)},
     "The bodies part 1.02 times as fast as they met."),
    ({"slip_velocity_change": 0.5 - JUST, "friction_work": -0.2 * 0.5 * 5.25},
     {"slip_velocity_change": 0.5 + JUST, "friction_work": -0.2 * 0.5 * 5.25},
     "The contact slips 1.1 times as fast as it met."),
    ({"slip_velocity_change": -10.5 + JUST, "friction_work": -0.2 * 10.5 * 0.25},
     {"slip_velocity_change": -10.5 - JUST, "friction_work": -0.2 * 10.5 * 0.25},
     "The contact slips 1.1 times as fast as it met."),
    ({"friction_work": 1.6 + 0.045 - JUST}, {"friction_work": 1.6 + 0.045 + JUST},
     "Off by 0.01 of the energy at the start; declared: 0.01."),
    ({"friction_work": 1.6 - 0.045 + JUST}, {"friction_work": 1.6 - 0.045 - JUST},
     "Off by 0.01 of the energy at the start; declared: 0.01."),
]  # fmt: skip


@pytest.mark.parametrize(("right", "wrong", "words"), ENDS, ids=[words for *_, words in ENDS])
def test_books_that_do_not_balance_are_a_status_with_a_sentence(right, wrong, words):
    usual = {"friction_work": 1.6}
    good, bad = motion(**(usual | right)), motion(**(usual | wrong))
    assert balanced(good, scene(), 0.01) is good
    found = balanced(bad, scene(), 0.01)
    assert (found.status, found.detail) == (Status.UNBALANCED, words)
    both = {name: [(usual | right)[name], (usual | wrong)[name]] for name in usual | right}
    batch = balanced(motion((2,), **both), scene(spin=[4.0, 4.0]), np.array([0.01, 0.01]))
    assert batch.status.tolist() == [Status.SUCCESS, Status.UNBALANCED]
    assert batch.detail.tolist() == ["", words]


@pytest.mark.parametrize("shape", [(), (2,)])
def test_what_friction_moves_between_the_motions_is_judged_in_sum(shape):
    """e = 1.1 takes 0.42 J from slip, which loses 1.6 J: no energy is made. e = 2 makes 4.4 J."""
    given = scene(spin=[4.0, 4.0]) if shape else scene()

    def found(rate, exchange):
        return balanced(
            motion(shape, normal_velocity=rate, friction_work=1.6 + exchange, exchange=exchange),
            given, 0.01,
        )  # fmt: skip

    def statuses(moved):
        return {each.name for each in np.ravel(np.array(moved.status, dtype=object))}

    assert statuses(found(-2.2, -0.42)) == {"SUCCESS"}
    # 4.5 J and 1.02² times it at the end: 4.5 - 1.6 + (e² - 1) 2 = 4.6818 at e² = 1.8909
    for rate, name in (
        (-2.0 * math.sqrt(1.89), "SUCCESS"),
        (-2.0 * math.sqrt(1.892), "UNBALANCED"),
    ):
        moved = found(rate, 0.5 * (4.0 - rate * rate))
        assert statuses(moved) == {name}
    assert np.ravel(np.array(moved.detail, dtype=object))[0] == (
        "The bodies gain 0.041 of their energy."
    )


def test_a_motion_is_sound_if_its_numbers_are_finite():
    """A sum that overflows is of finite numbers too; the exchange may be undeclared."""
    for shape in ((), (2,)):
        for numbers in ({}, {"duration": 1e308, "maximum_force": 1e308}, {"exchange": NAN}):
            made = motion(shape, **numbers)
            assert sound(made) is made
    one = sound(motion(maximum_radius=NAN, friction_work=math.inf))
    words = "Not finite at the end of contact: friction work, maximum radius."
    assert (one.status, one.detail) == (Status.NON_FINITE, words)
    some = sound(motion((3,), duration=[1.0, NAN, 2.0]))
    assert [each.name for each in some.status] == ["SUCCESS", "NON_FINITE", "SUCCESS"]
    assert some.detail.tolist() == ["", "Not finite at the end of contact: duration.", ""]
    failed = motion(status=Status.UNRESOLVED, duration=NAN)
    assert sound(failed) is failed
