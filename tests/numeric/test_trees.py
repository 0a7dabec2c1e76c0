"""Batches as trees: stacked, indexed, merged; by hand."""

import attrs
import numpy as np
import pytest

from contactlab.numeric import arrays


@attrs.frozen
class Leaf:
    """Two numbers and a word."""

    one: object
    other: object
    word: str = "same"


def test_leaves_that_are_equal_stay_plain_and_others_become_arrays():
    stacked = arrays.stacked([Leaf(1.0, 2.0), Leaf(1.0, 3.0)])
    assert (stacked.one, stacked.other.tolist(), stacked.word) == (1.0, [2.0, 3.0], "same")
    assert stacked.other.dtype == np.float64
    first = Leaf(1.0, 2.0)
    assert arrays.stacked([first, first]) is first
    assert arrays.stacked([Leaf(1.0, 2.0), 3.0]) is None
    assert arrays.stacked([1, 2]).dtype == np.float64


def test_parts_of_a_tree():
    tree = Leaf(np.array([[1.0], [2.0]]), 3.0)
    taken = arrays.taken(tree, (2, 2), (1, 0))
    assert (taken.one, taken.other, taken.word) == (2.0, 3.0, "same")
    assert type(taken.one) is float
    column = arrays.taken(tree, (2, 2), np.array([[True, False], [True, True]])).one
    assert column.tolist() == [1.0, 2.0, 2.0]
    assert not column.flags.writeable
    assert arrays.taken("word", (2,), 0) == "word"


def test_common_shapes():
    assert arrays.common_shape({"a": (2, 1), "b": (), "c": (3,)}, what="", remedy="") == (2, 3)
    assert arrays.common_shape({"a": (), "b": ()}, what="", remedy="") == ()
    with pytest.raises(ValueError, match=" ") as caught:
        arrays.common_shape({"a": (2,), "b": (), "c": (3,)}, what="The shapes", remedy="mend them")
    assert str(caught.value) == "The shapes of a (2,), c (3,) must broadcast to one; mend them"


def test_merged_pairs_overwrite_earlier_ones():
    some = np.array([True, False, True])
    pairs = [(np.ones(3, dtype=bool), 0.5), (some, [1.0, 2.0])]
    assert arrays.merged(pairs, (3,)).tolist() == [1.0, 0.5, 2.0]
    words = arrays.merged([(some, "a"), (~some, ["b"])], (3,), object)
    assert words.tolist() == ["a", "b", "a"]


def test_numbers_spread_flat_and_filled():
    assert type(arrays.spread(np.array(2), ())) is float
    mine = np.array([1.0, 2.0])
    same = arrays.spread(mine, (2,))
    assert same is not mine
    assert same.tolist() == [1.0, 2.0]
    wide = arrays.spread(3.0, (2, 2))
    wide[0, 0] = 1.0
    assert wide.tolist() == [[1.0, 3.0], [3.0, 3.0]]
    assert arrays.flat(2, (2, 2)).tolist() == [2.0] * 4
    assert arrays.flat(np.array([[1.0, 2.0]]), (1, 2)).tolist() == [1.0, 2.0]
    assert arrays.filled("x", ()) == "x"
    assert arrays.filled("x", (2,)).tolist() == ["x", "x"]
    assert arrays.filled("x", (2,)).dtype == object


@pytest.mark.parametrize(("shape", "first"), [((2,), [0]), ((5,), [0, 1]), ((2, 3), [0, 1, 2])])
def test_halves_of_a_batch(shape, first):
    one, other = arrays.halves(shape)
    assert one.shape == shape
    assert np.flatnonzero(one).tolist() == first
    assert np.array_equal(one, ~other)


@pytest.mark.parametrize(
    ("mask", "any_of", "all_of"),
    [
        (True, True, True),
        (False, False, False),
        (np.bool_(True), True, True),
        (np.array(False), False, False),
        (np.array([True, False]), True, False),
        (np.array([False, False]), False, False),
        (np.array([True, True]), True, True),
    ],
)
def test_masks(mask, any_of, all_of):
    assert arrays.some(mask) is any_of
    assert arrays.every(mask) is all_of


def test_choices_and_shares_in_words():
    assert arrays.chosen(True, 1, 2) == 1
    assert arrays.chosen(False, 1, 2) == 2
    assert arrays.chosen(np.array([True, False]), 1, 2).tolist() == [1, 2]
    mask = np.array([True, False, True])
    assert arrays.share(mask) == "2 of 3 impacts"
    assert arrays.for_share(mask) == " for 2 of 3 impacts"
    assert arrays.for_share(np.array(True)) == ""


def test_only_arrays_are_locked():
    mine = np.zeros(2)
    assert arrays.locked(mine) is mine
    assert not mine.flags.writeable
    assert arrays.locked([1]) == [1]
