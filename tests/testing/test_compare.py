"""Equality of the values that a law may keep, and the form of its answers."""

import math
from collections import UserDict
from types import SimpleNamespace

import attrs
import numpy as np
import pytest

from contactlab.testing.compare import DEEPEST, same, well_formed


class Slotted:
    __slots__ = ("__weakref__", "left", "right")

    def __init__(self, left, right=None):
        self.left = left
        if right is not None:
            self.right = right


class Single:
    __slots__ = "only"

    def __init__(self, only):
        self.only = only


class Derived(Slotted):
    """Slots of a base, and a dictionary of its own."""

    def __init__(self, left, right, extra):
        super().__init__(left, right)
        self.extra = extra


@attrs.frozen
class Frozen:
    number: float


def array(*values):
    return np.array(values)


def objects(*values):
    return np.array([*values, None], dtype=object)


def nested(depth, value):
    for _ in range(depth):
        value = [value]
    return value


EQUAL = [
    (1.5, 1.5),
    (math.nan, math.nan),
    (np.float64(math.nan), np.float64(math.nan)),
    (0.0, -0.0),
    (array(1.0, math.nan), array(1.0, math.nan)),
    (array(1j, math.nan), array(1j, math.nan)),
    (array(1, 2), array(1, 2)),
    (array("a"), array("a")),
    (objects(1.0, [math.nan]), objects(1.0, [math.nan])),
    ({"a": math.nan}, {"a": math.nan}),
    (UserDict(a=1.0), UserDict(a=1.0)),
    ([1.0, (2.0, math.nan)], [1.0, (2.0, math.nan)]),
    (Slotted(1.0, 2.0), Slotted(1.0, 2.0)),
    (Slotted(1.0), Slotted(1.0)),
    (Single(1.0), Single(1.0)),
    (Derived(1.0, 2.0, 3.0), Derived(1.0, 2.0, 3.0)),
    (SimpleNamespace(a=math.nan), SimpleNamespace(a=math.nan)),
    (Frozen(math.nan), Frozen(math.nan)),
    ("word", "wo" + "rd"),
    (None, None),
    ([], []),
]
UNEQUAL = [
    (1.5, np.nextafter(1.5, 2.0).item()),
    (1.5, math.nan),
    (math.nan, 1.5),
    (1, 1.0),
    (True, 1),
    (array(1.0, 2.0), array(1.0, math.nan)),
    (array(1.0, 2.0), array(1.0, 3.0)),
    (array(1.0), array(1)),
    (array(1.0), array([1.0])),
    (array(1, 2), array(1, 3)),
    (objects(1.0, [2.0]), objects(1.0, [3.0])),
    (objects(1.0), objects(1.0, 1.0)),
    ({"a": 1.0}, {"a": 2.0}),
    ({"a": 1.0}, {"b": 1.0}),
    ({"a": 1.0}, {"a": 1.0, "b": 1.0}),
    ([1.0], [1.0, 2.0]),
    ([1.0, 2.0], [1.0, 3.0]),
    ([1.0], (1.0,)),
    (Slotted(1.0, 2.0), Slotted(1.0, 3.0)),
    (Slotted(1.0, 2.0), Slotted(1.0)),
    (Slotted(1.0), Slotted(1.0, 2.0)),
    (Single(1.0), Single(2.0)),
    (Derived(1.0, 2.0, 3.0), Derived(1.0, 2.0, 4.0)),
    (Derived(1.0, 2.0, 3.0), Derived(1.0, 5.0, 3.0)),
    (SimpleNamespace(a=1.0), SimpleNamespace(b=1.0)),
    (Frozen(1.0), Frozen(2.0)),
    ("word", "world"),
]


@pytest.mark.parametrize(("left", "right"), EQUAL)
def test_equal_values(left, right):
    assert same(left, right) is True
    assert same([left], [right]) is True
    assert same({"a": left}, {"a": right}) is True


@pytest.mark.parametrize(("left", "right"), UNEQUAL)
def test_unequal_values(left, right):
    assert same(left, right) is False
    assert same([0.0, left], [0.0, right]) is False
    assert same({"a": left, "b": 0.0}, {"a": right, "b": 0.0}) is False
    assert same(SimpleNamespace(a=left), SimpleNamespace(a=right)) is False
    assert same(objects(left), objects(right)) is False


def test_values_nested_too_deep_count_as_equal():
    """So that a state that holds itself can be compared."""
    assert not same(nested(DEEPEST, 1.0), nested(DEEPEST, 2.0))
    assert same(nested(DEEPEST + 1, 1.0), nested(DEEPEST + 1, 2.0))
    assert not same(nested(DEEPEST, array(1.0)), nested(DEEPEST, array(2.0)))
    ring, other = [1.0], [1.0]
    ring.append(ring)
    other.append(other)
    assert same(ring, other)


@pytest.mark.parametrize("wrap", [lambda v: {"a": v}, lambda v: SimpleNamespace(a=v), objects])
def test_each_container_goes_one_deeper(wrap):
    def within(value):
        for _ in range(DEEPEST + 1):
            value = wrap(value)
        return value

    assert same(within(1.0), within(2.0))


@pytest.mark.parametrize(
    ("value", "shape", "good"),
    [
        (1.0, (), True),
        (1, (), True),
        (np.uint8(1), (), True),
        (np.float64(1.0), (), True),
        (math.nan, (), True),
        (array(1.0, 2.0), (2,), True),
        (array(1.0, 2.0), (1, 2), False),
        (array(1.0, 2.0), (), False),
        (1.0, (2,), False),
        (array(1.0), (), False),
        (1j, (), False),
        (True, (), False),
        ("1", (), False),
        (None, (), False),
        ([1.0, 2.0], (2,), True),
    ],
)
def test_well_formed_answers(value, shape, good):
    assert well_formed(value, shape) is good
