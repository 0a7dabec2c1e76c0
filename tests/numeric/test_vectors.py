"""Vectors: which are accepted, and every refusal in its words."""

import attrs
import numpy as np
import pytest

from contactlab.numeric import vectors

LARGEST = 1e100
BEYOND = float(np.nextafter(LARGEST, np.inf))
GIVE = "give three numbers in m/s, or an array of shape (..., 3)"


@attrs.frozen
class Moves:
    """A velocity, and a direction without a unit."""

    velocity: object = vectors.vector("m/s", default=vectors.NOTHING)
    normal: object = vectors.vector("1", default=(0.0, 0.0, 1.0))


def refusal(**given):
    with pytest.raises(ValueError, match=" ") as caught:
        Moves(**given)
    return str(caught.value)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize(
    "form", [list, tuple, np.array, lambda v: np.array([v, v]), lambda v: [v, v]]
)
def test_numbers_are_accepted_up_to_the_largest(form, axis, sign):
    row = [1.0, 2.0, 3.0]
    row[axis] = sign * LARGEST
    found = Moves(velocity=form(row)).velocity
    assert np.atleast_2d(found)[0].tolist() == row
    assert not found.flags.writeable
    for bad in (sign * BEYOND, float("nan"), sign * float("inf")):
        row[axis] = bad
        assert ": must be finite, at most 1e+100" in refusal(velocity=form(row))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (1.0, f"velocity = 1.0: must be a vector of three numbers; {GIVE}"),
        ([1.0, 2.0], f"velocity = [1.0, 2.0]: must be a vector of three numbers; {GIVE}"),
        ("abc", f"velocity = 'abc': must be a real number; {GIVE}"),
        (
            np.ones((3, 2)),
            "velocity.shape = (3, 2): must end with 3; x, y and z belong on the last axis: "
            "np.moveaxis(vectors, 0, -1)",
        ),
        (np.ones((2, 2)), f"velocity.shape = (2, 2): must end with 3; {GIVE}"),
        (
            np.array([[0.0, 1.0, 2.0], [0.0, np.nan, 2.0], [np.inf, 0.0, 0.0]]),
            "velocity = [0.0, nan, 2.0]: must be finite, at most 1e+100 "
            f"(the first of 2 has index [1]); {GIVE}",
        ),
        (
            [[0, 0, 0], [0, 0, BEYOND]],
            "velocity = [[0, 0, 0], [0, 0, 1.0000000000000002e+100]]: must be finite, at most "
            f"1e+100 (the first of 1 has index [1, 2]); {GIVE}",
        ),
    ],
)
def test_refusals(given, words):
    assert refusal(velocity=given) == words


def test_a_vector_without_unit_has_another_remedy():
    assert refusal(normal=1.0) == (
        "normal = 1.0: must be a vector of three numbers; give three numbers, or an array of "
        "shape (..., 3)"
    )


def test_what_is_kept_is_a_copy_in_rows():
    for form in (np.array([1.0, 2.0, 3.0]), np.asfortranarray(np.arange(6.0).reshape(2, 3))):
        kept, before = Moves(velocity=form).velocity, form.copy()
        form += 1.0
        assert np.array_equal(kept, before)
        assert kept.flags.c_contiguous
    assert Moves(velocity=np.empty((0, 3))).velocity.shape == (0, 3)
    assert Moves(velocity=[1, 2, 3]).velocity.dtype == np.float64


def test_components_differences_and_lengths():
    one, many = Moves(velocity=[1, 2, 3]).velocity, Moves(velocity=[[1, 2, 3], [4, 5, 6]]).velocity
    still = Moves().velocity
    assert vectors.components(one) == (1.0, 2.0, 3.0)
    assert [each.tolist() for each in vectors.components(many)] == [[1, 4], [2, 5], [3, 6]]
    assert vectors.difference(one, still) == (1.0, 2.0, 3.0)
    assert vectors.difference(one, Moves(velocity=[3, 1, -1]).velocity) == (-2.0, 1.0, 4.0)
    columns = [each.tolist() for each in vectors.difference(many, one)]
    assert columns == [[0, 3], [0, 3], [0, 3]]
    moving = [vectors.moving(each) for each in (still, np.zeros(3), one, many)]
    assert moving == [False, False, True, True]
    assert vectors.square_root(9.0) == 3.0
    assert vectors.square_root(np.array([4.0, 9.0])).tolist() == [2.0, 3.0]
    assert Moves().velocity is still  # one zero for all that are left out
