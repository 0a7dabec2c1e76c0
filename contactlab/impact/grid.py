"""Grids: all combinations of the values of some entries, the last varying fastest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.checks import real, refuse

#: Largest number of impacts of a grid; a typing error must not fill the memory.
MOST_IMPACTS = 10_000_000
Array = NDArray[np.float64]


def axes_of(entries: Mapping[str, Any]) -> dict[str, Array]:
    """Return the entries that are lists, as arrays of one dimension; at least one must be."""
    axes: dict[str, Any] = {}
    for name, values in entries.items():
        if np.ndim(values):
            axes[name] = real(name, values)
            if np.ndim(axes[name]) != 1:
                raise refuse(name, values, "must be a number or a plain list of numbers")
    if not axes:
        raise refuse("entries", tuple(entries), "none of them varies", "give a list of one or more")
    return axes


def product(axes: Mapping[str, Any]) -> dict[str, Array]:
    """Return the values of each axis in all combinations, flat, the last varying fastest."""
    size = math.prod(np.size(values) for values in axes.values())
    if size > MOST_IMPACTS:
        raise refuse("product", size, f"must be at most {MOST_IMPACTS} impacts", "vary less")
    spread = np.meshgrid(*axes.values(), indexing="ij")
    return {name: values.ravel() for name, values in zip(axes, spread, strict=True)}
