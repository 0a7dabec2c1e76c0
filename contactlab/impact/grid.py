"""Grids: all combinations of the values of some entries, the last varying fastest."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import attrs
import numpy as np

from contactlab.numeric.checks import real, refuse
from contactlab.numeric.types import Array, Numbers, Real

#: Largest number of impacts of a grid; a typing error must not fill the memory.
MOST_IMPACTS = 10_000_000


def axes_of(entries: Mapping[str, Numbers]) -> dict[str, Array]:
    """Return the entries that are lists, at least one, as arrays of one dimension."""
    axes: dict[str, Any] = {}
    for name, values in entries.items():
        try:
            varies = bool(np.ndim(np.asarray(values)))
        except Exception:  # rows of unequal length, data sets, sparse arrays: refused below
            varies = True
        if varies:
            axes[name] = real(name, values)
            if np.ndim(axes[name]) != 1:
                raise refuse(name, values, "must be a number or a plain list of numbers")
    if not axes:
        raise refuse("entries", tuple(entries), "none of them varies", "give a list of one or more")
    return axes


@attrs.frozen(eq=False, repr=False)
class GridParts:
    """Scenes that together are a grid, made one after another: ``Scene.grid_in_parts``.

    Attributes
    ----------
    axes : mapping of str to array, shape (n_i,)
        Values of each entry that varies, the last varying fastest.
    at_a_time : int
        Impacts of a scene.
    """

    axes: Mapping[str, Array]
    at_a_time: int
    _make: Callable[[Mapping[str, Array]], Any]

    @property
    def dimensions(self) -> tuple[int, ...]:
        """The length of each axis."""
        return tuple(values.size for values in self.axes.values())

    @property
    def impacts(self) -> int:
        """The number of impacts of the grid."""
        return math.prod(self.dimensions)

    def __repr__(self) -> str:
        """Return the length of each axis, and the number of impacts."""
        lengths = ", ".join(f"{name}: {values.size}" for name, values in self.axes.items())
        return f"GridParts({lengths}; {self.impacts} impacts, {self.at_a_time} at a time)"

    def __len__(self) -> int:
        """Return the number of scenes."""
        return -(-self.impacts // self.at_a_time)

    def __iter__(self) -> Iterator[Any]:
        """Yield the scenes, each a batch of at most ``at_a_time`` impacts."""
        for first in range(0, self.impacts, self.at_a_time):
            flat = np.arange(first, min(first + self.at_a_time, self.impacts))
            places = np.unravel_index(flat, self.dimensions)
            each = zip(self.axes.items(), places, strict=True)
            yield self._make({name: values[place] for (name, values), place in each})


def product(axes: Mapping[str, Real]) -> dict[str, Array]:
    """Return the values of each axis in all combinations, flat, the last varying fastest."""
    size = math.prod(np.size(values) for values in axes.values())
    if size > MOST_IMPACTS:
        remedy = "vary less, or sweep Scene.grid_in_parts into a folder"
        raise refuse("product", size, f"must be at most {MOST_IMPACTS} impacts", remedy)
    spread = np.meshgrid(*axes.values(), indexing="ij")
    return {name: values.ravel() for name, values in zip(axes, spread, strict=True)}
