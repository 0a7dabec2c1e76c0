"""The ``[sweep]`` of a scene file: which entries vary, and through which values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from contactlab.checks import Real, refuse, whole
from contactlab.scene_file.entries import entry_path
from contactlab.scene_file.table import Table, number_list

RANGE_KEYS = ("start", "stop", "count")
REMEDY = "give a list of numbers, or {start = ..., stop = ..., count = ...}"


def read_sweep(content: object) -> dict[str, Real]:
    """Return the varied entries, name to array of shape (n,); empty where nothing varies.

    Raises
    ------
    ValueError
        If an entry is unknown or given twice, a value is not a list, or lengths differ.
    """
    if not isinstance(content, Mapping):
        raise refuse("sweep", content, "must be a table", "write it under [sweep]")
    varied: dict[str, Real] = {}
    paths: dict[str, str] = {}
    for name, value in _flat(content).items():
        path = entry_path(name, where="sweep.")
        if path in paths:
            raise ValueError(f"sweep: {paths[path]} and {name} are the same entry; leave out one")
        paths[path] = name
        varied[name] = _values(f"sweep.{name}", value)
    lengths = {name: np.size(values) for name, values in varied.items()}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise ValueError(f"sweep: the lists must be of equal length; they have {listed}")
    if content and not varied:
        raise ValueError(f"sweep: varies nothing; {REMEDY}")
    return varied


def _flat(content: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return ``sphere.radius = [...]`` under its dotted name, however the file nests it."""
    flat: dict[str, Any] = {}
    for key, value in content.items():
        if isinstance(value, Mapping) and not set(value) & set(RANGE_KEYS):
            flat |= _flat(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat


def _values(path: str, value: object) -> Real:
    if not isinstance(value, Mapping):
        return number_list(path, value, remedy=REMEDY)
    table = Table(value, path, known=RANGE_KEYS)
    start = table.number("start", remedy=REMEDY)
    stop = table.number("stop", remedy=REMEDY)
    count = whole(table.at("count"), table.require("count", REMEDY), least=2, most=1_000_000)
    return np.linspace(start, stop, count)
