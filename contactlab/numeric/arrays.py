"""Batches: functions that stack, index and merge trees of numbers.

A tree is a number, an array, an attrs object whose fields are trees, or trees by name. Any other
value is passed through unchanged. In a batch of ``shape`` a plain number holds for all impacts, and
an array broadcasts to ``shape``.
"""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, lru_cache
from operator import attrgetter
from typing import TYPE_CHECKING, Any, overload

import attrs
import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlab.numeric.named import Named
from contactlab.numeric.types import AnyArray, Array, Complex, Index, Kind, Mask, Real, Tree

#: Numbers in the array that ``keep_freed_memory`` releases: 8 MB, the tables of most batches.
RELEASED = 1_000_000
_new, _put = object.__new__, object.__setattr__
if TYPE_CHECKING:  # checkers infer object from ``abs``

    @overload
    def magnitude(value: Kind) -> Kind: ...
    @overload
    def magnitude(value: Complex) -> Real: ...
    def magnitude(value: object) -> object: ...  # noqa: D103
else:
    magnitude = abs


@lru_cache(maxsize=1)
def keep_freed_memory() -> None:
    """Let glibc keep up to 16 MB of freed memory for later arrays; called once a process."""
    # It keeps twice the largest block ever released, at first 128 kB: then arrays of a batch come
    # and go by pages that the system must clear, which takes up to a third of the march.
    np.empty(RELEASED)


def lock_arrays(value: Tree) -> Tree:
    """Return ``value``; an array is made read-only."""
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    return value


def common_shape(
    shapes: Mapping[str, tuple[int, ...]], *, what: str, remedy: str
) -> tuple[int, ...]:
    """Return the common broadcast shape, or raise ValueError with ``what``, names and remedy."""
    shapes = {name: shape for name, shape in shapes.items() if shape}
    if not shapes:
        return ()
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        named = ", ".join(f"{name} {shape}" for name, shape in shapes.items())
        raise ValueError(f"{what} of {named} must broadcast to one; {remedy}") from None


def stack_trees(items: Sequence[Any]) -> Any:
    """Return one tree; leaves that differ become arrays of shape (items,)."""
    first = items[0]
    if all(item is first for item in items) and not isinstance(first, np.ndarray):
        return first
    if all(item is None or isinstance(item, float | np.ndarray) for item in items):
        items = [math.nan if item is None else item for item in items]  # some impacts lack it
        first = items[0]
    if any(type(item) is not type(first) for item in items):
        return None  # bodies of different kinds: laws need the pair only
    if attrs.has(type(first)):
        if alike := getattr(type(first), "alike", None):
            items = alike(items)
        names = {field.alias: field.name for field in attrs.fields(type(first)) if field.init}
        return type(first)(
            **{
                alias: stack_trees([getattr(item, name) for item in items])
                for alias, name in names.items()
            }
        )
    if type(first) is Named:
        names = dict.fromkeys(name for item in items for name in item)
        return Named(
            {name: stack_trees([item.get(name, math.nan) for item in items]) for name in names}
        )
    if not isinstance(first, np.ndarray) and all(item == first for item in items):
        return first
    return np.array(items, dtype=np.float64)


@overload
def take(tree: Real, shape: tuple[int, ...], part: Index) -> Real: ...
@overload
def take(tree: Tree, shape: tuple[int, ...], part: Index) -> Tree: ...
def take(tree: Any, shape: tuple[int, ...], part: Index) -> object:
    """Return the tree of the impacts that ``part`` indexes; plain numbers stay plain.

    An array with more axes than ``shape`` begins with those of the batch.
    """
    if isinstance(tree, np.ndarray):
        spread = tree.shape != shape and tree.ndim <= len(shape)
        numbers = (np.broadcast_to(tree, shape) if spread else tree)[part]
        return numbers.item() if isinstance(numbers, np.generic) else lock_arrays(numbers)
    if isinstance(tree, float):
        return tree
    if attrs.has(type(tree)):
        copy = object.__new__(type(tree))  # every number was checked when the tree was made
        for field in attrs.fields(type(tree)):
            value = take(getattr(tree, field.name), shape, part)
            if "unknown" in field.metadata:
                value = none_for_nan(value)
            object.__setattr__(copy, field.name, value)
        return copy
    if type(tree) is Named and tree:
        return Named({name: take(number, shape, part) for name, number in tree.items()})
    return tree


def change_entries(tree: Tree, **entries: object) -> Tree:
    """Return a copy of a tree with other entries, none of which is checked again."""
    kind: type = type(tree)
    copy: Tree = object.__new__(kind)
    names, read = _entries(kind)
    put = object.__setattr__
    deque(map(put, itertools.repeat(copy), names, read(tree)), maxlen=0)  # a loop takes longer
    deque(map(put, itertools.repeat(copy), entries, entries.values()), maxlen=0)
    return copy


def fill(kind: type[Tree], entries: Mapping[str, object]) -> Tree:
    """Return an object of a class without slots from all its entries, none of which is checked.

    An ``__init__`` of a dozen arguments takes a microsecond, which counts beside one impact.
    """
    tree: Tree = _new(kind)
    _put(tree, "__dict__", entries)
    return tree


@cache
def _entries(kind: type) -> tuple[tuple[str, ...], Callable[[object], Any]]:
    """Return the names of a class's entries, and a function that reads all of them at once."""
    fields = attrs.fields(kind)
    names = tuple(field.name for field in fields)
    if len(names) > 1:
        return names, attrgetter(*names)
    return names, lambda tree: tuple(getattr(tree, name) for name in names)


def none_for_nan(value: Tree) -> Tree | None:
    """Return None for NaN, which stands for None in arrays; other values stay."""
    return None if isinstance(value, float) and value != value else value


def equal(one: Any, other: Any) -> bool:
    """Return whether two trees, or tuples and mappings of them, are equal; NaN equals NaN."""
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        numbers = one.dtype.kind == "f"
        return one.shape == other.shape and bool(np.array_equal(one, other, equal_nan=numbers))
    if attrs.has(type(one)):
        names = [field.name for field in attrs.fields(type(one)) if field.eq is not False]
        return all(equal(getattr(one, name), getattr(other, name)) for name in names)
    if isinstance(one, Mapping):
        return one.keys() == other.keys() and all(equal(one[key], other[key]) for key in one)
    if isinstance(one, tuple | list):
        return len(one) == len(other) and all(map(equal, one, other))
    return bool(one == other or (one != one and other != other))


@overload
def merge_parts(
    parts: Sequence[tuple[slice | Mask, ArrayLike]],
    shape: tuple[int, ...],
    kind: type[float] = float,
    ends: tuple[int, ...] = (),
) -> Array: ...
@overload
def merge_parts(
    parts: Sequence[tuple[slice | Mask, ArrayLike]],
    shape: tuple[int, ...],
    kind: type | np.dtype[np.generic],
    ends: tuple[int, ...] = (),
) -> AnyArray: ...
def merge_parts(
    parts: Sequence[tuple[slice | Mask, ArrayLike]],
    shape: tuple[int, ...],
    kind: type | np.dtype[np.generic] = float,
    ends: tuple[int, ...] = (),
) -> AnyArray:
    """Return an array of ``shape`` from pairs of a place and its values; later pairs overwrite.

    A place is a mask of ``shape``, or a slice of the batch in C order. Each value has the axes
    ``ends``, none if it is a number.
    """
    entry = np.empty((math.prod(shape), *ends), dtype=kind)
    for where, values in parts:
        place = where if isinstance(where, slice) else np.ravel(where)
        many = np.ndim(values) > 0
        entry[place] = np.asarray(values, dtype=kind).reshape(-1, *ends) if many else values
    return entry.reshape(*shape, *ends)


def consecutive(sizes: Iterable[int]) -> list[slice]:
    """Return the places of consecutive parts of a batch, as slices."""
    ends = list(itertools.accumulate(sizes, initial=0))
    return [slice(*pair) for pair in itertools.pairwise(ends)]


def spread(value: Real, shape: tuple[int, ...]) -> Real:
    """Return ``value`` as a float for one impact, or as an array of ``shape`` for a batch."""
    if not shape:
        return float(value)
    if isinstance(value, np.ndarray):  # broadcasting is slower
        return value.copy() if value.shape == shape else np.array(np.broadcast_to(value, shape))
    return np.full(shape, value)


def of_each(value: Real, shape: tuple[int, ...]) -> Real:
    """Repeat a number that all impacts share, one for each impact; an array stays as it is."""
    return value if not shape or np.ndim(value) >= len(shape) else spread(value, shape)


def zeros(shape: tuple[int, ...]) -> Real:
    """Return 0 for one impact, or read-only zeros of a batch."""
    return shared(0.0, shape)


@lru_cache(maxsize=32)
def shared(value: float, shape: tuple[int, ...]) -> Real:
    """Return a number for one impact, or a read-only array of a batch that takes no memory."""
    return np.broadcast_to(value, shape) if shape else value


def are_zeros(value: Real) -> bool:
    """Return whether a value is the number 0, or what ``zeros`` returned."""
    if isinstance(value, np.ndarray):
        return not any(value.strides) and value.size > 0 and not value.flat[0]
    return bool(value == 0.0)


def flat(value: Real, shape: tuple[int, ...]) -> Array:
    """Return ``value``, of ``shape`` or broadcast to it, as an array of one axis, maybe a view."""
    array = np.asarray(value, dtype=np.float64)
    same = array.shape == shape  # broadcasting takes longer than a small step
    return (array if same else np.broadcast_to(array, shape)).reshape(-1)


def plain(value: Real) -> Real:
    """Return a number without axes as a float, and an array as it is."""
    return value if getattr(value, "ndim", 0) else float(value)


@overload
def shape_as(values: Array, shape: tuple[int, ...]) -> Real: ...
@overload
def shape_as(values: AnyArray, shape: tuple[int, ...]) -> Any: ...
def shape_as(values: AnyArray, shape: tuple[int, ...]) -> object:
    """Return numbers of shape (items,) in the shape of the batch, or that of one impact."""
    return values.reshape(shape) if shape else values.item()


def part_of(value: Real, part: Index) -> Real:
    """Return the numbers of some impacts; a plain number holds for all of them."""
    return value[part] if isinstance(value, np.ndarray) else value


def greater(one: Kind, other: float) -> Kind:
    """Return the greater of two numbers, NaN if the first is NaN; ``max`` is faster for floats."""
    return max(one, other) if isinstance(one, float) else np.maximum(one, other)


def lesser(one: Real, other: Real) -> Real:
    """Return the lesser of two numbers, NaN if the first is NaN."""
    floats = isinstance(one, float) and isinstance(other, float)
    return min(one, other) if floats else np.minimum(one, other)


def spread_object(value: Tree, shape: tuple[int, ...]) -> Tree | NDArray[np.object_]:
    """Return ``value`` for one impact, or an object array of ``shape`` filled with it."""
    return np.full(shape, value, dtype=object) if shape else value


def some(mask: Mask) -> bool:
    """Return whether a mask is True for at least one impact."""
    return mask if isinstance(mask, bool) else bool(mask.any() if mask.ndim else mask)


def every(mask: Mask) -> bool:
    """Return whether a mask is True for all impacts."""
    return mask if isinstance(mask, bool) else bool(mask.all() if mask.ndim else mask)


@overload
def choose(condition: bool, if_true: float, if_false: float) -> float: ...
@overload
def choose(condition: NDArray[np.bool_], if_true: Real, if_false: Real) -> Array: ...
@overload
def choose(condition: Mask, if_true: Real, if_false: Real) -> Real: ...
@overload
def choose(condition: Mask, if_true: Complex, if_false: Complex) -> Complex: ...
def choose(condition: Mask, if_true: Complex, if_false: Complex) -> Complex:
    """Return ``np.where`` for arrays; a plain condition is decided by ``if``, ten times as fast."""
    if isinstance(condition, np.ndarray):
        return np.where(condition, if_true, if_false)
    return if_true if condition else if_false


def quotient(dividend: Real, divisor: Real) -> Real:
    """Return a quotient; infinite where the divisor is 0, and NaN for 0/0."""
    if isinstance(dividend, float) and isinstance(divisor, float):
        return dividend / divisor if divisor else dividend * math.inf
    with np.errstate(all="ignore"):
        return np.divide(dividend, divisor)


def finite(numbers: Real) -> bool:
    """Return whether a number, or every entry of an array, is finite."""
    if isinstance(numbers, float):
        return math.isfinite(numbers)
    return bool(np.isfinite(numbers).all())


def share(where: Mask) -> str:
    """Return "3 of 10 impacts": how many impacts ``where`` marks."""
    return f"{int(np.sum(where))} of {np.size(where)} impacts"


def for_share(where: Mask) -> str:
    """Return " for 3 of 10 impacts"; empty for a single impact."""
    return f" for {share(where)}" if np.ndim(where) else ""
