"""Tangential motions joined, merged, failing, and of impacts that were not computed."""

import math

import numpy as np
import pytest

import contactlab
from contactlab import Scene, Status
from contactlab.contracts import NormalContact, SampledMotion, TangentialMotion
from contactlab.contracts.sampled_motion import gathered

GOOD, BAD = Status.SUCCESS, Status.NON_FINITE
NAMES = ("slip_velocity_change", "friction_work", "status", "detail")


def one(number, **entries):
    return TangentialMotion(slip_velocity_change=number, friction_work=10.0 * number, **entries)


def many(numbers, statuses, details="", **entries):
    numbers = np.array(numbers)
    status = np.array(statuses, dtype=object)
    return one(numbers, status=status, detail=details, **entries)


def normal(duration):
    """A normal motion of two samples."""
    scene = Scene.nondimensional(psi1=1.0, chi=1.0)
    nothing = NormalContact(np.zeros(1), np.zeros(1), np.zeros(1))
    return SampledMotion(
        contactlab.create("normal.hertz"), scene, time=np.array([duration]),
        approach=np.zeros(1), rate=np.zeros(1), contact=nothing,
    )  # fmt: skip


def columns(motion):
    return [np.asarray(getattr(motion, name)).tolist() for name in NAMES]


def test_one_sentence_for_a_batch_goes_to_the_impacts_that_failed():
    motion = many([1.0, 2.0, 3.0], [GOOD, BAD, GOOD], "it broke")
    assert motion.detail.tolist() == ["", "it broke", ""]
    assert many([1.0, 2.0], [GOOD, GOOD]).detail.tolist() == ["", ""]
    told = np.array(["a", ""], dtype=object)
    assert many([1.0, 2.0], [BAD, GOOD], told).detail is told
    assert one(1.0, status=BAD, detail="it broke").detail == "it broke"
    alone = one(1.0, status=np.array(BAD, dtype=object), detail="it broke")
    assert alone.detail == "it broke"


def test_parts_are_joined_in_their_order():
    parts = [
        one(1.0, counters={"steps": 2}),
        many([[2.0, 3.0]], [[BAD, GOOD]], "it broke", counters={"steps": 3, "rejected": 1}),
        one(4.0, status=BAD, detail="too"),
    ]
    joined = TangentialMotion.joined(parts, (2, 2))
    assert columns(joined) == [
        [[1.0, 2.0], [3.0, 4.0]],
        [[10.0, 20.0], [30.0, 40.0]],
        [[GOOD, BAD], [GOOD, BAD]],
        [["", "it broke"], ["", "too"]],
    ]
    assert joined.counters == {"steps": 5, "rejected": 1}
    assert joined.normal is None
    assert joined.slip_velocity_change.dtype == float


def test_one_part_of_the_whole_shape_is_the_whole():
    whole = many([1.0, 2.0], [GOOD, GOOD])
    assert TangentialMotion.joined([whole], (2,)) is whole
    assert TangentialMotion.joined([one(1.0)], ()).slip_velocity_change == 1.0
    wider = TangentialMotion.joined([one(1.0)], (1, 1))
    assert columns(wider)[0] == [[1.0]]
    two = TangentialMotion.joined([whole, whole], (4,))
    assert columns(two)[0] == [1.0, 2.0, 1.0, 2.0]


def test_normal_motions_of_parts_are_joined():
    first, last = normal(2.0), normal(3.0)
    parts = [one(1.0, normal=first), many([2.0, 3.0], [GOOD] * 2), one(4.0, normal=last)]
    joined = TangentialMotion.joined(parts, (2, 2))
    times = gathered(joined.normal, lambda motion: motion.duration, (2, 2))
    assert times == pytest.approx(np.array([[2.0, math.nan], [math.nan, 3.0]]), nan_ok=True)


def test_parts_with_masks_are_merged_and_the_last_one_counts():
    left, right = np.array([True, True, False]), np.array([False, True, True])
    merged = TangentialMotion.merged(
        [
            (left, many([1.0, 2.0], [BAD, BAD], "it broke", counters={"steps": 2})),
            (right, one(5.0, counters={"steps": 4, "rejected": 1}, normal=normal(2.0))),
        ],
        (3,),
    )
    assert columns(merged) == [
        [1.0, 5.0, 5.0],
        [10.0, 50.0, 50.0],
        [BAD, GOOD, GOOD],
        ["it broke", "", ""],
    ]
    assert merged.counters == {"steps": 6, "rejected": 1}
    [(where, none), (also, motion)] = merged.normal.parts
    assert (where is left, none, also is right) == (True, None, True)
    assert (motion.duration, merged.normal.shape) == (2.0, (3,))
    plain = TangentialMotion.merged([(np.array([True, True]), one(1.0))], (2,))
    assert plain.normal is None


def test_impacts_that_were_not_computed_are_nan():
    alone = TangentialMotion.nothing((), BAD, "it broke")
    assert math.isnan(alone.slip_velocity_change)
    assert math.isnan(alone.friction_work)
    assert (alone.status, alone.detail) == (BAD, "it broke")
    assert TangentialMotion.nothing((), BAD).detail == ""
    both = TangentialMotion.nothing((2,), BAD, ["a", "b"])
    assert np.isnan(both.slip_velocity_change).tolist() == [True, True]
    assert (both.status.tolist(), both.detail.tolist()) == ([BAD, BAD], ["a", "b"])
    assert TangentialMotion.nothing((2,), BAD, "a").detail.tolist() == ["a", "a"]


def test_impacts_that_fail_keep_the_first_reason():
    motion = many([1.0, 2.0, 3.0], [GOOD, BAD, GOOD], "it broke")
    where = np.array([True, True, False])
    failed = motion.failing(where, Status.UNBALANCED, "energy")
    assert failed.status.tolist() == [Status.UNBALANCED, BAD, GOOD]
    assert failed.detail.tolist() == ["energy", "it broke", ""]
    assert failed.slip_velocity_change is motion.slip_velocity_change
    assert motion.status.tolist() == [GOOD, BAD, GOOD]
    each = motion.failing(where, Status.UNBALANCED, np.array(["a", "b", "c"], dtype=object))
    assert each.detail.tolist() == ["a", "it broke", ""]
    assert motion.failing(np.array([False, True, False]), BAD, "other") is motion
    assert motion.failing(True, BAD, "x").status.tolist() == [BAD] * 3
