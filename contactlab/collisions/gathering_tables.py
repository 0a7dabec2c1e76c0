"""Tables and files of a gathering: one row for each body, and one for each contact."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from contactlab.collisions.gathered import (
    OF_CONTACTS,
    VECTORS_OF_BODIES,
    VECTORS_OF_CONTACTS,
    GatheringResult,
)
from contactlab.numeric.types import Array
from contactlab.outcome.columns import json_value
from contactlab.outcome.files import write_table, written

#: Axes of vectors, and the entries of a batch that stand in its first columns.
AXES = ("x", "y", "z")
#: Headings and rows.
Rows = tuple[list[str], list[list[Any]]]


def bodies_table(hit: GatheringResult) -> Rows:
    """Return headings and one row for each body of each gathering."""
    names = [*hit.gathering.names] or [str(k) for k in range(len(hit.gathering.bodies))]
    return _rows(hit, "body", names, _components(hit, VECTORS_OF_BODIES))


def contacts_table(hit: GatheringResult) -> Rows:
    """Return headings and one row for each contact of each gathering."""
    columns = _components(hit, VECTORS_OF_CONTACTS)
    for name, unit in OF_CONTACTS:
        columns[_heading(name, unit)] = getattr(hit, name)
    touches = [f"touches[{k}]" for k in range(len(hit.gathering.touches))]
    return _rows(hit, "contact", touches, columns)


def _components(hit: GatheringResult, vectors: Iterable[tuple[str, str]]) -> dict[str, Array]:
    """Return the components of vectors, of names and units, by heading."""
    return {
        _heading(f"{name}_{axis}", unit): getattr(hit, name)[..., k]
        for name, unit in vectors
        for k, axis in enumerate(AXES)
    }


def _heading(name: str, unit: str) -> str:
    """Return the heading of a column, as results of one contact have it."""
    return f"{name} ({unit})"


def _rows(hit: GatheringResult, what: str, names: list[str], columns: dict[str, Array]) -> Rows:
    """Return headings and rows; of a batch each begins with the place of its gathering."""
    shape = hit.gathering.shape
    status: Any = np.broadcast_to(np.asarray(hit.status, dtype=object), shape)
    first = ["gathering"] if shape else []
    rows: list[list[Any]] = []
    for number, index in enumerate(np.ndindex(shape)):
        for k, name in enumerate(names):
            numbers = [float(column[(*index, k)]) for column in columns.values()]
            place = [number] if shape else []
            rows.append([*place, name, *numbers, status[index].name])
    return [*first, what, *columns, "status"], rows


def to_dict(hit: GatheringResult) -> dict[str, Any]:
    """Return a result with rows of bodies and contacts as plain numbers, lists and text."""
    tables = (("bodies", bodies_table(hit)), ("contacts", contacts_table(hit)))
    told: dict[str, Any] = {
        name: [dict(zip(keys, map(json_value, row), strict=True)) for row in rows]
        for name, (headings, rows) in tables
        for keys in ([each.split(" ")[0] for each in headings],)
    }
    return told | {
        "energy": hit.energy.to_dict(),
        "plan": hit.plan.to_dict(),
        "laws": dict(hit.laws),
        "run_time_s": hit.run_time,
    }


def write_json(hit: GatheringResult, path: str | Path) -> None:
    """Write ``to_dict``."""
    text = json.dumps(to_dict(hit), indent=2, allow_nan=False) + "\n"
    with written(path) as stream:
        stream.write(text)


def write_csv(hit: GatheringResult, path: str | Path) -> None:
    """Write one row for each body, then one for each contact; what a row has not is empty."""
    (body, bodies), (contact, contacts) = bodies_table(hit), contacts_table(hit)
    shared = [name for name in body if name in contact]
    headings = [*(name for name in body if name != "status"), *contact[len(shared) - 1 : -1]]
    headings = [*dict.fromkeys(headings), "status"]
    rows = []
    for names, found in ((body, bodies), (contact, contacts)):
        for row in found:
            told = dict(zip(names, row, strict=True))
            rows.append([told.get(name, "") for name in headings])
    write_table(path, headings, rows)


def write_history_csv(hit: GatheringResult, path: str | Path) -> None:
    """Write one row for each instant and contact."""
    history: Any = hit.history
    columns = history.columns()
    headings = ["contact", *(_heading(name, history.unit(name)) for name in columns)]
    count = len(hit.gathering.touches)
    rows = [
        [f"touches[{k}]", *(float(column[instant, k]) for column in columns.values())]
        for instant in range(len(history.time))
        for k in range(count)
    ]
    write_table(path, headings, rows)


#: Writers by the end of a file's name.
WRITERS = {".csv": write_csv, ".json": write_json}
