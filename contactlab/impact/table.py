"""Tables of numbers beside the code: their rows, and linear interpolation between nodes."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from contactlab.numeric.types import Array, Places, Real


def read_rows(file: Path) -> tuple[list[str], Array]:
    """Return the headings of a CSV file and its numbers, shape (rows, columns).

    Parameters
    ----------
    file : Path
        Lines that begin with "#" are left out.
    """
    text = file.read_text(encoding="utf-8")
    lines = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
    return lines[0], np.array([[float(word) for word in line] for line in lines[1:]])


def between_nodes(entries: Sequence[Real], axes: Sequence[Array], values: Array) -> Real:
    """Return ``values``, shape (nodes of each axis), at ``entries``, linear between nodes.

    Parameters
    ----------
    entries : sequence of float or array
        One for each axis, of shapes that broadcast; clipped to the range of the axis.
    axes : sequence of array
        Nodes of each axis, rising.
    values : array
        Numbers at the nodes.
    """
    places = [_place(*pair) for pair in zip(entries, axes, strict=True)]
    found: Real = 0.0
    for corner in itertools.product((0, 1), repeat=len(places)):
        weight: Real = 1.0
        for (_, share), up in zip(places, corner, strict=True):
            weight = weight * (share if up else 1.0 - share)
        nodes = tuple(low + up for (low, _), up in zip(places, corner, strict=True))
        found = found + weight * values[nodes]
    return found


def _place(entry: Real, axis: Array) -> tuple[Places, Real]:
    """Return the node below each entry, clipped, and the share of the way on."""
    entry = np.clip(entry, axis[0], axis[-1])
    low = np.clip(np.searchsorted(axis, entry, side="right") - 1, 0, len(axis) - 2)
    return low, (entry - axis[low]) / (axis[low + 1] - axis[low])
