"""Vectors of shape (3,) or (..., 3): checks and components."""

from __future__ import annotations

import math
import struct
from typing import Any

import attrs
import numpy as np

from contactlab.numeric.checks import Rule, first_of, key, real, refuse
from contactlab.numeric.types import Array, Kind, Numbers

NOTHING = (0.0, 0.0, 0.0)
_ROLLED = [1, 2, 0]
_THREE, _PLAIN = struct.Struct("3d"), (float, int, np.float64)
#: Largest number in a vector, and least length of a normal and least speed of approach. The
#: squares of these bounds are finite and positive in floating point.
LARGEST, LEAST = 1e100, 1e-100
RANGE = Rule(lambda value: np.abs(value) <= LARGEST, f"must be finite, at most {LARGEST:g}")


def solved(matrices: Array, columns: Array) -> Array:
    """Return A⁻¹ B of matrices that broadcast: NumPy 1 takes a B of one axis less for vectors."""
    shape = np.broadcast_shapes(matrices.shape[:-2], columns.shape[:-2])
    whole = np.broadcast_to(columns, (*shape, *columns.shape[-2:]))
    return np.asarray(np.linalg.solve(matrices, whole))


def vector(unit: str, *, default: object = attrs.NOTHING) -> Any:
    """Return an attrs field for checked vectors."""
    return attrs.field(
        default=default,
        kw_only=True,
        converter=attrs.Converter(_checked, takes_field=True),
        eq=key,
        metadata={"unit": unit},
    )


def _checked(value: Numbers, field: attrs.Attribute[object]) -> Array:
    """Return vectors, shape (..., 3), as a read-only copy."""
    if value is NOTHING:
        return ZERO
    numbers: Any = value.tolist() if type(value) is np.ndarray and value.shape == (3,) else value
    if type(numbers) in (list, tuple) and len(numbers) == 3:  # three plain numbers, the fast path
        x, y, z = numbers
        plain = type(x) in _PLAIN and type(y) in _PLAIN and type(z) in _PLAIN
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


def components(vectors: Array) -> tuple[Any, Any, Any]:
    """Return x, y and z: contiguous arrays, or floats for a single vector."""
    if vectors.ndim == 1:  # floats are faster for single collisions
        x, y, z = vectors.tolist()
        return x, y, z
    x, y, z = np.ascontiguousarray(np.moveaxis(vectors, -1, 0))
    return x, y, z


def moving(vectors: Array) -> bool:
    """Return whether any vector is not zero."""
    return vectors is not ZERO and bool(vectors.any())


def square_root(square: Kind) -> Kind:
    """Return the square root of an array, or of a float as a float."""
    return math.sqrt(square) if isinstance(square, float) else np.sqrt(square)


def cross(one: Array, other: Array) -> Array:
    """Return the products of vectors, shape (..., 3); ``np.cross`` takes several times as long."""
    rolled = one * other[..., _ROLLED] - one[..., _ROLLED] * other
    return np.asarray(rolled[..., _ROLLED])


def difference(minuend: Array, subtrahend: Array) -> tuple[Any, Any, Any]:
    """Return the components of ``minuend - subtrahend``."""
    x, y, z = components(minuend)
    if not moving(subtrahend):
        return x, y, z
    a, b, c = components(subtrahend)
    return x - a, y - b, z - c
