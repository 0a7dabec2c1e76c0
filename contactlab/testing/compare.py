"""Equality of values of any type, because the state of a law may be any object."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator, Mapping

import numpy as np

from contactlab.impact.scene import Scene
from contactlab.numeric.types import AnyArray
from contactlab.testing.check import hold

#: Values nested deeper than this count as equal.
DEEPEST = 12


def same(left: object, right: object, *, depth: int = 0) -> bool:
    """Return whether two values are equal to the last bit; NaN equals NaN."""
    if left is right or depth > DEEPEST:
        return True
    if type(left) is not type(right):
        return False
    if isinstance(left, np.ndarray) and isinstance(right, np.ndarray):
        return _same_arrays(left, right, depth)
    if isinstance(left, float | np.floating):
        return bool(left == right or (left != left and right != right))
    if isinstance(left, Mapping) and isinstance(right, Mapping):
        return left.keys() == right.keys() and all(
            same(left[key], right[key], depth=depth + 1) for key in left
        )
    if isinstance(left, list | tuple) and isinstance(right, list | tuple):
        return len(left) == len(right) and all(
            same(left_item, right_item, depth=depth + 1)
            for left_item, right_item in zip(left, right, strict=True)
        )
    names = set(_attributes(left)) | set(_attributes(right))
    if names:
        missing = object()
        return all(
            same(getattr(left, name, missing), getattr(right, name, missing), depth=depth + 1)
            for name in names
        )
    return bool(left == right)


def _same_arrays(left: AnyArray, right: AnyArray, depth: int) -> bool:
    if left.shape != right.shape or left.dtype != right.dtype:
        return False
    if left.dtype == object:
        pairs = zip(left.ravel(), right.ravel(), strict=True)
        return all(same(left_item, right_item, depth=depth + 1) for left_item, right_item in pairs)
    return bool(np.array_equal(left, right, equal_nan=left.dtype.kind in "fc"))


def _attributes(value: object) -> Iterator[str]:
    """Iterate over the names of an object's attributes, in its dictionary and its slots."""
    yield from getattr(value, "__dict__", {})
    for owner in type(value).__mro__:
        slots = owner.__dict__.get("__slots__", ())
        for name in (slots,) if isinstance(slots, str) else slots:
            if name not in ("__weakref__", "__dict__") and hasattr(value, name):
                yield name


def has_numbers(value: object, shape: tuple[int, ...]) -> bool:
    """Return whether ``value`` holds real numbers of ``shape`` (floats, or an array of them)."""
    array = np.asarray(value)
    return array.dtype.kind in "fiu" and array.shape == shape


def hold_read_only(run: Callable[[], object], scene: Scene) -> None:
    """Hold that a run with read-only arguments writes into none of them, and not into the scene."""
    kept = copy.deepcopy(scene)
    try:
        run()
    except ValueError as error:
        hold("read-only" not in str(error), f"The law writes into what it was given: {error}.")
        raise
    hold(same(scene, kept), "The law changed the scene.")
