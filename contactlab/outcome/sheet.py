"""Columns of a result with their axes and units, for frames, data sets and figures."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from contactlab.contracts.status import Status, Statuses, succeeded
from contactlab.numeric.types import AnyArray, Array

#: Bodies, or encounters, whose motion is told in words.
MOST_TOLD = 6
#: Axes of vectors in space.
AXES = ("x", "y", "z")


class Sheet(NamedTuple):
    """The columns of a result.

    Attributes
    ----------
    columns : mapping of str to array
        Numbers and words by name, each of ``shape`` or broadcast to it.
    units : mapping of str to str
        Unit of each column and axis; empty for words.
    axes : mapping of str to array or None
        Name and values of each axis in order; None for an axis that is counted.
    shape : tuple of int
    about : mapping of str to str
        Words on the whole, such as the names of the laws.
    row : str
        What a row is, where no axis has values.
    """

    columns: Mapping[str, AnyArray]
    units: Mapping[str, str]
    axes: Mapping[str, AnyArray | None]
    shape: tuple[int, ...]
    about: Mapping[str, str] = MappingProxyType({})
    row: str = "impact"


def batch_axes(shape: tuple[int, ...], row: str = "impact") -> dict[str, AnyArray | None]:
    """Return the axes of a batch, which are counted: ``impact``, or ``impact_0``, ``impact_1``."""
    numbered = (f"{row}_{number}" for number in range(len(shape)))
    return dict.fromkeys((row,) * len(shape) if len(shape) < 2 else numbered)


def along_axes(name: str, vectors: Array) -> dict[str, Array]:
    """Return the components of vectors in space by name: ``"velocity_x"``."""
    return {f"{name}_{axis}": vectors[..., place] for place, axis in enumerate(AXES)}


def names_of(statuses: Statuses, shape: tuple[int, ...]) -> AnyArray:
    """Return the names of statuses as an array of ``shape``."""
    if succeeded(statuses):  # looking up a million names takes long
        return np.full(shape, Status.SUCCESS.name)
    each = np.ravel(np.array(statuses, dtype=object))
    return np.broadcast_to(np.array([status.name for status in each]).reshape(shape), shape)


def moving(name: str, velocity: Array, spin: Array) -> str:
    """Return how a body moves, in a line: velocity in m/s and spin in rad/s."""
    return f"  {name}: velocity {tell_vector(velocity)} m/s, spin {tell_vector(spin)} rad/s"


def tell_vector(numbers: Array) -> str:
    """Return a vector in words."""
    return f"({', '.join(f'{number + 0.0:.6g}' for number in numbers.tolist())})"  # no -0
