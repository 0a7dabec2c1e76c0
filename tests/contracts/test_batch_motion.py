"""Motions of batches: what stands where after they are joined, merged and marked as failed."""

import numpy as np
import pytest

from contactlab import Status, TangentialMotion

LOST, LATE = Status.NON_FINITE, Status.TOO_FEW_STEPS


def single(change, *, status=Status.SUCCESS, **entries):
    return TangentialMotion(
        slip_velocity_change=change, friction_work=10.0 * np.sum(change), status=status, **entries
    )


def batch(changes, statuses, detail="", **entries):
    status = np.array(statuses, dtype=object)
    changes = np.array(changes, dtype=float)
    return TangentialMotion(
        slip_velocity_change=changes, friction_work=10.0 * changes, status=status, detail=detail,
        **entries,
    )  # fmt: skip


def test_one_sentence_for_a_batch_goes_to_those_that_failed():
    motion = batch([1.0, 2.0, 3.0], [LOST, Status.SUCCESS, LATE], "At step 3.")
    assert motion.detail.tolist() == ["At step 3.", "", "At step 3."]
    told = batch([1.0, 2.0], [LOST, LATE], np.array(["one", "two"], dtype=object))
    assert told.detail.tolist() == ["one", "two"]
    assert batch([1.0], [Status.SUCCESS]).detail.tolist() == [""]


def test_parts_are_joined_in_order_and_their_counts_added():
    parts = [
        single(1.0, counters={"steps": 3}),
        batch([2.0, 3.0], [Status.SUCCESS, LOST], "lost", counters={"steps": 4, "rejected": 1}),
        single(4.0, status=LATE, detail="late"),
    ]
    whole = TangentialMotion.join(parts, (2, 2))
    assert whole.slip_velocity_change.tolist() == [[1.0, 2.0], [3.0, 4.0]]
    assert whole.friction_work.tolist() == [[10.0, 20.0], [30.0, 40.0]]
    assert whole.status.tolist() == [[Status.SUCCESS, Status.SUCCESS], [LOST, LATE]]
    assert whole.detail.tolist() == [["", ""], ["lost", "late"]]
    assert dict(whole.counters) == {"steps": 7, "rejected": 1}
    assert TangentialMotion.join([parts[1]], (2,)) is parts[1]
    assert TangentialMotion.join([parts[0]], (1,)).slip_velocity_change.tolist() == [1.0]


@pytest.mark.parametrize("place", [slice(1, 3), np.array([False, True, True])])
def test_an_impact_in_several_parts_has_the_motion_of_the_last(place):
    first = batch([1.0, 2.0, 3.0], 3 * [Status.SUCCESS], normal_spin_change=np.ones(3))
    second = batch([5.0, 6.0], [LOST, Status.SUCCESS], "again")
    whole = TangentialMotion.merge([(np.ones(3, dtype=bool), first), (place, second)], (3,))
    assert whole.slip_velocity_change.tolist() == [1.0, 5.0, 6.0]
    assert whole.normal_spin_change.tolist() == [1.0, 0.0, 0.0]
    assert whole.detail.tolist() == ["", "again", ""]


@pytest.mark.parametrize("vectors_first", [True, False])
def test_beside_vectors_a_part_without_an_answer_is_a_vector_of_nan(vectors_first):
    moved = batch([[1.0, 2.0]], [Status.SUCCESS])
    moved = TangentialMotion(
        slip_velocity_change=np.array([[1.0, 2.0]]), friction_work=np.array([3.0]),
        status=moved.status,
    )  # fmt: skip
    none = TangentialMotion.nothing((2,), LOST, ["one", "two"])
    assert none.detail.shape == (2,)
    places = slice(0, 1), slice(1, 3)
    parts = [(places[0], moved), (places[1], none)]
    whole = TangentialMotion.merge(parts if vectors_first else parts[::-1], (3,))
    assert whole.slip_velocity_change.shape == (3, 2)
    assert whole.slip_velocity_change[0].tolist() == [1.0, 2.0]
    assert np.isnan(whole.slip_velocity_change[1:]).all()
    assert np.isnan(whole.friction_work).tolist() == [False, True, True]
    assert whole.detail.tolist() == ["", "one", "two"]


def test_what_was_not_computed_has_no_number_and_counts_nothing():
    motion = TangentialMotion.nothing((3,), LATE, "late", axes=(2,))
    assert motion.slip_velocity_change.shape == (3, 2)
    for name in TangentialMotion.numbers():
        assert np.isnan(getattr(motion, name)).all(), name
    assert motion.friction_work.shape == (3,)
    assert motion.status.tolist() == 3 * [LATE]
    assert motion.detail.tolist() == 3 * ["late"]
    assert not motion.counters
    alone = TangentialMotion.nothing((), LATE, "late")
    assert alone.status is LATE
    assert isinstance(alone.friction_work, float)
    assert np.isnan(alone.friction_work)


def test_impacts_that_had_failed_keep_status_and_sentence():
    motion = batch([1.0, 2.0, 3.0], [LOST, Status.SUCCESS, Status.SUCCESS], "lost")
    failed = motion.failing(np.array([True, True, False]), LATE, "late")
    assert failed.status.tolist() == [LOST, LATE, Status.SUCCESS]
    assert failed.detail.tolist() == ["lost", "late", ""]
    each = motion.failing(np.array([True, True, True]), LATE, np.array(["a", "b", "c"]))
    assert each.detail.tolist() == ["lost", "b", "c"]
    assert motion.failing(np.array([True, False, False]), LATE, "late") is motion
    assert single(1.0, status=LOST).failing(True, LATE, "late").status is LOST
    assert single(1.0).failing(True, LATE, "late").detail == "late"
