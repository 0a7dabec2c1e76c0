"""Batches: trees of numbers stacked, taken apart and put together again, in one place.

A tree is a number, an array, an attrs object or a NamedTuple of trees, or anything else, which is
left as it is. In a batch of ``shape`` every number is either plain, and holds for all impacts, or
an array that broadcasts to ``shape``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import numpy as np


def locked(value: Any) -> Any:
    """Return ``value``, made read-only if it is an array, as whatever leaves the core is."""
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    return value


def common_shape(shapes: Mapping[str, tuple[int, ...]], *, what: str, remedy: str) -> Any:
    """Return the shape that named shapes broadcast to; () are those of plain numbers.

    Raises
    ------
    ValueError
        With ``what``, the names of those that are no plain numbers, and the remedy.
    """
    shapes = {name: shape for name, shape in shapes.items() if shape}
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        named = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise ValueError(f"{what} of {named} must broadcast to one; {remedy}") from None


def stacked(items: Sequence[Any]) -> Any:
    """Return one tree from trees of equal type: leaves that differ become arrays, (items,)."""
    first = items[0]
    if all(item is first for item in items):
        return first
    if any(type(item) is not type(first) for item in items):
        return None  # bodies of different kinds: the reduced pair still serves
    if attrs.has(type(first)):
        names = [field.name for field in attrs.fields(type(first)) if field.init]
        return type(first)(
            **{name: stacked([getattr(item, name) for item in items]) for name in names}
        )
    if all(item == first for item in items):
        return first
    return np.array(items, dtype=np.float64)


def taken(tree: Any, shape: tuple[int, ...], part: Any) -> Any:
    """Return the tree of some impacts of a batch of ``shape``.

    Parameters
    ----------
    tree : tree
        Plain numbers stand for the whole batch, and stay plain: laws are faster then.
    shape : tuple of int
        Batch shape.
    part : int, tuple of int, slice, mask or array of indices
        Which impacts. Of a single one the numbers come out plain.
    """
    if isinstance(tree, np.ndarray):
        found = (tree if tree.shape == shape else np.broadcast_to(tree, shape))[part]
        return found.item() if isinstance(found, np.generic) else locked(found)
    if isinstance(tree, float):
        return tree
    if attrs.has(type(tree)):
        found = object.__new__(type(tree))  # every number was checked when the tree was made
        for field in attrs.fields(type(tree)):
            value = taken(getattr(tree, field.name), shape, part)
            object.__setattr__(found, field.name, value)
        return found
    return tree


def merged(parts: Sequence[tuple[Any, Any]], shape: tuple[int, ...], kind: Any = float) -> Any:
    """Return an array of ``shape`` from (mask, values) pairs; later pairs overwrite earlier."""
    entry = np.empty(shape, dtype=kind)
    for where, values in parts:
        entry[where] = np.ravel(np.asarray(values, dtype=kind)) if np.ndim(values) else values
    return entry


def spread(value: Any, shape: tuple[int, ...]) -> Any:
    """Return ``value`` as a float for one impact, or as an array of the batch ``shape``."""
    return np.array(np.broadcast_to(value, shape)) if shape else float(value)


def filled(value: Any, shape: tuple[int, ...]) -> Any:
    """Return ``value``, of whatever kind, for one impact, or an array of it for each of a batch."""
    return np.full(shape, value, dtype=object) if shape else value


def halves(shape: tuple[int, ...]) -> tuple[Any, Any]:
    """Return masks of the first and the second half of a batch."""
    size = math.prod(shape)
    first = np.arange(size).reshape(shape) < size // 2
    return first, ~first


def some(mask: Any) -> bool:
    """Return whether a mask holds for any impact."""
    return mask if isinstance(mask, bool) else bool(mask.any() if mask.ndim else mask)


def every(mask: Any) -> bool:
    """Return whether a mask holds for all impacts."""
    return mask if isinstance(mask, bool) else bool(mask.all() if mask.ndim else mask)


def chosen(condition: Any, one: Any, other: Any) -> Any:
    """Return ``np.where`` of an array; of one impact the number itself, ten times as fast."""
    if isinstance(condition, np.ndarray):
        return np.where(condition, one, other)
    return one if condition else other


def share(where: Any) -> str:
    """Return how many impacts of a batch a mask holds, in words."""
    return f"{int(np.sum(where))} of {np.size(where)} impacts"


def for_share(where: Any) -> str:
    """Return for how many impacts of a batch something holds, in words; nothing of one impact."""
    return f" for {share(where)}" if np.ndim(where) else ""
