"""Normal motions through samples: linear between them, and merged from parts of a batch."""

import math

import numpy as np
import pytest

import contactlab
from contactlab import Scene
from contactlab.contracts import NormalContact, SampledMotion, claims
from contactlab.contracts.motion import MOST_SHARED
from contactlab.contracts.sampled_motion import Ends

LAW = contactlab.create("normal.hertz")
ONE = Scene.nondimensional(psi1=1.2, chi=1.44)
TWO = Scene.nondimensional(psi1=np.array([1.2, 2.0]), chi=1.44)
#: Samples after first touch: the load pulls at 3 s, and is given as it is or left out.
TIME = np.array([1.0, 3.0, 4.0])
APPROACH, RATE = np.array([0.6, 0.8, -0.2]), np.array([0.5, -0.2, -0.9])
FORCE, RADIUS = np.array([4.0, -2.0, 0.0]), np.array([0.7, 0.9, 0.0])
OVERLAP, LOAD = np.array([0.6, 0.1, -0.1]), np.array([5.0, 1.0, 0.0])


def sampled(kind=SampledMotion, *, load=LOAD):
    contact = NormalContact(FORCE, RADIUS, OVERLAP, load)
    return kind(LAW, ONE, time=TIME, approach=APPROACH, rate=RATE, contact=contact)


def both():
    """Two impacts; the second one takes twice the time and half of the load."""

    def column(values, factor=1.0):
        return np.stack((values, factor * values), axis=1)

    contact = NormalContact(column(FORCE), column(RADIUS), column(OVERLAP), column(LOAD, 0.5))
    return SampledMotion(
        LAW, TWO, time=column(TIME, 2.0), approach=APPROACH[:, None], rate=column(RATE, 0.8),
        contact=contact,
    )  # fmt: skip


def test_totals_are_those_of_the_samples():
    motion = sampled()
    assert (motion.law, motion.scene) == (LAW, ONE)
    assert (motion.duration, motion.final_rate) == (4.0, -0.9)
    assert (motion.maximum_approach, motion.maximum_radius, motion.maximum_force) == (0.8, 0.9, 4.0)
    # trapezia of 1, 2 and 1 s
    assert motion.total_load_impulse == 0.5 * 5.0 + 2.0 * 3.0 + 0.5 * 1.0
    assert type(motion.duration) is type(motion.total_load_impulse) is float
    assert motion.claims == claims(LAW)


@pytest.mark.parametrize(
    ("time", "approach", "rate", "force", "radius", "overlap", "load", "impulse"),
    [
        (0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0),  # v1 = 1 at first touch
        (0.5, 0.3, 0.75, 2.0, 0.35, 0.3, 2.5, 1.25),
        (1.0, 0.6, 0.5, 4.0, 0.7, 0.6, 5.0, 2.5),
        (2.0, 0.7, 0.15, 1.0, 0.8, 0.35, 3.0, 5.5),
        (3.5, 0.3, -0.55, -1.0, 0.45, 0.0, 0.5, 8.75),
        (4.0, -0.2, -0.9, 0.0, 0.0, -0.1, 0.0, 9.0),
    ],
)
def test_a_motion_is_linear_between_its_samples(
    time, approach, rate, force, radius, overlap, load, impulse
):
    sample = sampled().at(math.pi * time / 4.0)
    assert sample[:3] == pytest.approx((time, approach, rate), abs=1e-15)
    assert sample.contact == pytest.approx((force, radius, overlap, load), abs=1e-15)
    assert sample.load_impulse == pytest.approx(impulse, abs=1e-15)
    assert {type(entry) for entry in (*sample[:3], *sample.contact, sample[4])} == {float}


def test_many_phases_give_arrays():
    sample = sampled().at(np.array([[0.0, 0.25], [0.5, 1.0]]) * math.pi)
    assert sample.time.tolist() == [[0.0, 1.0], [2.0, 4.0]]
    assert sample.contact.force == pytest.approx(np.array([[0.0, 4.0], [1.0, 0.0]]))
    assert sample.load_impulse == pytest.approx(np.array([[0.0, 2.5], [5.5, 9.0]]))


def test_the_load_of_a_contact_without_one_is_its_pressure():
    motion = sampled(load=None)
    assert motion.at(math.pi * 3.0 / 4.0).contact.friction_load == 0.0
    assert motion.total_load_impulse == 0.5 * 4.0 + 2.0 * 2.0


def test_the_phase_is_proportional_to_time():
    motion = sampled()
    assert motion.phase(0.25) == pytest.approx(0.25 * math.pi)
    assert motion.phase(np.array([0.0, 1.0])).tolist() == [0.0, math.pi]
    assert motion.at(motion.phase(0.5)).time == pytest.approx(2.0)


def test_a_batch_is_its_impacts():
    motion = both()
    assert motion.duration.tolist() == [4.0, 8.0]
    assert motion.final_rate == pytest.approx([-0.9, -0.72])
    assert motion.maximum_approach.tolist() == [0.8, 0.8]
    assert motion.total_load_impulse.tolist() == [9.0, 9.0]
    sample = motion.at(np.array([0.25, 0.5])[:, None] * math.pi)
    assert sample.time.tolist() == [[1.0, 2.0], [2.0, 4.0]]
    assert sample.rate == pytest.approx(np.array([[0.5, 0.4], [0.15, 0.12]]))
    assert sample.contact.friction_load == pytest.approx(np.array([[5.0, 2.5], [3.0, 1.5]]))
    assert motion.at(0.25 * math.pi).load_impulse == pytest.approx([2.5, 2.5])


@pytest.mark.parametrize("part", [1, (1,), slice(1, 2), np.array([False, True]), [1]])
def test_some_impacts_may_be_taken(part):
    taken = both().take(part)
    assert np.ravel(taken.duration).tolist() == [8.0]
    assert np.ravel(taken.final_rate) == pytest.approx([-0.72])
    assert np.ravel(taken.total_load_impulse).tolist() == [9.0]
    sample, one = taken.at(0.5 * math.pi), sampled().at(0.5 * math.pi)
    assert np.ravel(sample.approach) == pytest.approx([one.approach])
    assert np.ravel(sample.contact.overlap) == pytest.approx([one.contact.overlap])
    assert np.shape(sample.time) == taken.scene.shape


def test_ends_are_merged_from_the_motions_of_parts():
    first = np.array([True, False, False])
    middle, last = np.array([False, True, False]), np.array([False, False, True])
    inner = Ends.merge(
        [(np.array([True, False]), None), (np.array([False, True]), sampled())], (2,)
    )
    ends = Ends.merge([(first, sampled()), (middle | last, inner)], (3,))
    assert ends.duration == pytest.approx([4.0, math.nan, 4.0], nan_ok=True)
    some = Ends.merge([(first, None), (middle | last, both())], (3,))
    assert some.duration == pytest.approx([math.nan, 4.0, 8.0], nan_ok=True)
    assert np.isnan(Ends.of(None).final_rate)


def test_what_equal_motions_share_is_made_once_and_stays_bounded():
    made, kept = [], {}

    class Sharing(SampledMotion):
        shared = kept

    def make():
        made.append(1)
        return len(made)

    motion = sampled()
    assert (motion.once("a", make), motion.once("a", make)) == (1, 2)  # nothing is shared
    motion = sampled(Sharing)
    assert (motion.once("a", make), motion.once("a", make)) == (3, 3)
    for number in range(1, MOST_SHARED):
        assert motion.once(number, make) == 3 + number
    assert len(kept) == MOST_SHARED == 8
    assert motion.once("a", make) == 3
    assert motion.once("b", make) == 11
    assert kept == {"b": 11}
