"""The ``[sweep]`` of a scene file: the entries that vary and their values.

Lists of equal length vary together; ``product = true`` combines every value with every value of
the other entries, the last entry varying fastest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from contactlab.impact.grid import product
from contactlab.numeric.checks import of_kind, whole
from contactlab.numeric.types import Array
from contactlab.scene_file.entries import entry_path
from contactlab.scene_file.table import Table, flatten, number_list

RANGE_KEYS = ("start", "stop", "count")
#: Key that requests every combination.
PRODUCT = "product"
REMEDY = "give a list of numbers, or {start = ..., stop = ..., count = ...}"


class Sweep(NamedTuple):
    """The entries that vary.

    Attributes
    ----------
    varied : dict of str to array
        Values of each entry, one for each impact, shape (n,); empty if nothing varies.
    axes : dict of str to array
        Values of each entry of a product, shape (n_i,); empty for lists of equal length.
    """

    varied: Mapping[str, Array]
    axes: Mapping[str, Array]


def read_sweep(content: object, path_of: Callable[..., str] = entry_path) -> Sweep:
    """Return the entries that vary and their values; ``path_of`` knows their names."""
    remedy = "write it under [sweep]"
    table = of_kind("sweep", content, Mapping, rule="must be a table", remedy=remedy)
    combined = table.get(PRODUCT, False)
    of_kind(f"sweep.{PRODUCT}", combined, bool, rule="must be true or false")
    varied: dict[str, Array] = {}
    paths: dict[str, str] = {}
    entries = {key: table[key] for key in table if key != PRODUCT}
    flat = flatten(entries, leaf=lambda inner: not inner.keys().isdisjoint(RANGE_KEYS))
    for name, value in flat.items():
        path = path_of(name, where="sweep.")
        if path in paths:
            raise ValueError(f"sweep: {paths[path]} and {name} are the same entry; leave out one")
        paths[path] = name
        varied[name] = _values(f"sweep.{name}", value)
    if table and not varied:
        raise ValueError(f"sweep: varies nothing; {REMEDY}")
    if combined:
        return Sweep(dict(product(varied)), varied)
    lengths = {name: np.size(values) for name, values in varied.items()}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise ValueError(
            f"sweep: the lists must be of equal length; they have {listed}; "
            f"for every combination of them write {PRODUCT} = true"
        )
    return Sweep(varied, {})


def _values(path: str, value: object) -> Array:
    """Return a list or a range as an array, shape (n,)."""
    if not isinstance(value, Mapping):
        return number_list(path, value, remedy=REMEDY)
    table = Table(value, path, known=RANGE_KEYS)
    start = table.number("start", remedy=REMEDY)
    stop = table.number("stop", remedy=REMEDY)
    count = whole(table.at("count"), table.require("count", REMEDY), least=2, most=1_000_000)
    return np.linspace(start, stop, count)
