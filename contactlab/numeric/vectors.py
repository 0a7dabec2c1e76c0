"""Vectors of shape (..., 3): checks, and products of their components.

Products take three components each, arrays of a batch shape or the floats of a single vector, which
are many times as fast as arrays of three numbers. The rows of a tensor are three such vectors.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np

from contactlab.numeric.checks import Rule, first_of, key, real, refuse
from contactlab.numeric.types import Array, Kind, Numbers, Real, Rows, Vector

NOTHING = (0.0, 0.0, 0.0)
_THREE, _PLAIN = struct.Struct("3d"), (float, int, np.float64)
#: Largest number in a vector, and least length of a normal and least speed of approach. The
#: squares of these bounds are finite and positive in floating point.
LARGEST, LEAST = 1e100, 1e-100
RANGE = Rule(lambda value: np.abs(value) <= LARGEST, f"must be finite, at most {LARGEST:g}")


def vector(unit: str, *, default: object = attrs.NOTHING) -> Any:
    """Return an attrs field for checked vectors."""
    return attrs.field(
        default=default,
        kw_only=True,
        converter=attrs.Converter(_check_vectors, takes_field=True),
        eq=key,
        metadata={"unit": unit},
    )


def _check_vectors(value: Numbers | None, field: attrs.Attribute[object]) -> Array | None:
    """Return vectors, shape (..., 3), as a read-only copy; None where that is the default."""
    if value is NOTHING:
        return ZERO
    if value is None and field.default is None:
        return None
    numbers: Any = value.tolist() if type(value) is np.ndarray and value.shape == (3,) else value
    if type(numbers) in (list, tuple) and len(numbers) == 3:  # three plain numbers, the fast path
        x, y, z = numbers
        plain = type(x) in _PLAIN and type(y) in _PLAIN and type(z) in _PLAIN
        if type(x) is int and type(value) is np.ndarray:
            plain = value.dtype.kind in "iu"  # dates are whole numbers too
        within = plain and -LARGEST <= x <= LARGEST and -LARGEST <= y <= LARGEST
        if within and -LARGEST <= z <= LARGEST:
            return three(x, y, z)
    vectors = _many(value, field)
    vectors.flags.writeable = False
    return vectors


def three(x: float, y: float, z: float) -> Array:
    """Return a read-only vector; ``np.array`` takes longer."""
    return np.frombuffer(_THREE.pack(x, y, z))


ZERO = three(*NOTHING)


def _many(value: Any, field: attrs.Attribute[object]) -> Array:
    """Return ``value`` as a new array of shape (..., 3), or refuse it."""
    remedy = f"give three numbers in {field.metadata['unit']}, or an array of shape (..., 3)"
    if field.metadata["unit"] == "1":
        remedy = "give three numbers, or an array of shape (..., 3)"
    floats = type(value) is np.ndarray and value.dtype.kind == "f" and value.size
    # This test makes no temporary arrays; NaN fails both comparisons.
    if floats and float(value.min()) >= -LARGEST and float(value.max()) <= LARGEST:
        vectors: Array = value.astype(np.float64, order="C")
    else:
        if floats and value.ndim > 1:
            where = np.argwhere(~(np.abs(value.astype(np.float64)) <= LARGEST).all(axis=-1))
            first = value[tuple(where[0])].tolist()
            raise refuse(field.name, first, RANGE.sentence + first_of(where), remedy)
        vectors = np.array(real(field.name, value, rule=RANGE, remedy=remedy, empty=True))
    if vectors.shape[-1:] == (3,):
        return vectors
    if vectors.ndim < 2:
        raise refuse(field.name, value, "must be a vector of three numbers", remedy)
    if vectors.shape[0] == 3:
        remedy = "x, y and z belong on the last axis: np.moveaxis(vectors, 0, -1)"
    raise refuse(f"{field.name}.shape", vectors.shape, "must end with 3", remedy)


def components(vectors: Array) -> tuple[Real, ...]:
    """Return x, y and z, or x and y: contiguous arrays, or floats for a single vector."""
    if vectors.ndim == 1:
        return tuple(vectors.tolist())
    return tuple(vectors[..., k].copy() for k in range(vectors.shape[-1]))


def join_components(components: Vector | Rows, shape: tuple[int, ...]) -> Array:
    """Return vectors of a batch ``shape`` by their components, or tensors by their rows."""
    if not shape:
        return np.array(components)
    parts: Any = components
    if isinstance(parts[0], Sequence):
        joined = np.empty((*shape, len(parts), len(parts[0])))
        for k, row in enumerate(parts):
            for n, each in enumerate(row):
                joined[..., k, n] = each
        return joined
    joined = np.empty((*shape, len(parts)))
    for k, each in enumerate(parts):
        joined[..., k] = each
    return joined


def entry(tensors: Array, row: int, column: int) -> Real:
    """Return an entry of tensors, shape (..., n, n): an array, or a float of a single one."""
    return tensors.item(row, column) if tensors.ndim == 2 else tensors[..., row, column]


def rows(tensors: Array) -> Rows:
    """Return the rows of tensors, shape (..., 3, 3): nested arrays, or floats for a single one."""
    if tensors.ndim == 2:
        single: list[list[float]] = tensors.tolist()
        return single
    last = tensors.ndim - 2  # np.moveaxis takes longer than the copy
    first = np.ascontiguousarray(tensors.transpose(last, last + 1, *range(last)))
    return [list(row) for row in first]


def dot(one: Vector, other: Vector) -> Real:
    """Return the scalar product of vectors."""
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def factor(tensor: Rows) -> tuple[Real, ...]:
    """Return L D Lᵀ of A, symmetric (the mean with Aᵀ) and positive definite: it needs no pivot."""
    (a, p, q), (b, c, r), (d, e, f) = tensor
    b, d, e = 0.5 * (b + p), 0.5 * (d + q), 0.5 * (e + r)
    low, last = b / a, d / a
    c, e = c - low * b, e - last * b
    under = e / c
    return a, c, f - last * d - under * e, low, last, under


def solve_factored(factors: tuple[Real, ...], *vectors: Vector) -> list[Vector]:
    """Return A⁻¹ b of each b, by the factors of A."""
    a, c, f, low, last, under = factors
    solved: list[Vector] = []
    for x, y, z in vectors:
        y = y - low * x
        z = (z - last * x - under * y) / f
        y = y / c - under * z
        solved.append((x / a - low * y - last * z, y, z))
    return solved


def over(vectors: Array, shape: tuple[int, ...]) -> Array:
    """Return vectors, or what belongs to a batch, in a shape; broadcasting takes long."""
    return vectors if vectors.shape == shape else np.broadcast_to(vectors, shape)


def moving(vectors: Array) -> bool:
    """Return whether any vector is not zero."""
    return vectors is not ZERO and bool(vectors.any())


def square_root(square: Kind) -> Kind:
    """Return the square root of an array, or of a float as a float."""
    return math.sqrt(square) if isinstance(square, float) else np.sqrt(square)


def hypotenuse(one: Real, other: Real) -> Real:
    """Return the length of vectors of two components, of floats as a float."""
    floats = isinstance(one, float) and isinstance(other, float)
    return math.hypot(one, other) if floats else np.hypot(one, other)


def cross(one: Vector, other: Vector) -> tuple[Real, Real, Real]:
    """Return the vector product of vectors."""
    (a, b, c), (x, y, z) = one, other
    return b * z - c * y, c * x - a * z, a * y - b * x


def difference(minuend: Array, subtrahend: Array) -> tuple[Real, Real, Real]:
    """Return the components of ``minuend - subtrahend``."""
    x, y, z = components(minuend)
    if not moving(subtrahend):
        return x, y, z
    a, b, c = components(subtrahend)
    return x - a, y - b, z - c
