"""Tables and files of a gathering: one row for each body, and one for each contact."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from contactlab.collisions.gathered import GatheringResult
from contactlab.outcome.columns import csv_heading, json_value
from contactlab.outcome.files import replace_file, write_table

#: Headings and rows.
Rows = tuple[list[str], list[list[Any]]]


def bodies_table(hit: GatheringResult) -> Rows:
    """Return headings and one row for each body of each gathering."""
    return _rows(hit, "bodies")


def contacts_table(hit: GatheringResult) -> Rows:
    """Return headings and one row for each contact of each gathering."""
    return _rows(hit, "contacts")


def _rows(hit: GatheringResult, rows: str) -> Rows:
    """Return headings with units, and rows; in a batch each row begins with its place."""
    sheet = hit._sheet(rows)
    places = np.indices(sheet.shape)
    axes = zip(sheet.axes.items(), places, strict=True)
    columns = {name: place if each is None else each[place] for (name, each), place in axes}
    columns |= {name: np.broadcast_to(each, sheet.shape) for name, each in sheet.columns.items()}
    headings = [csv_heading(name, sheet.units.get(name, ""), hit._scene) for name in columns]
    each = (column.ravel().tolist() for column in columns.values())
    return headings, [list(row) for row in zip(*each, strict=True)]


def to_dict(hit: GatheringResult) -> dict[str, Any]:
    """Return a result with rows of bodies and contacts as plain numbers, lists and text."""
    tables = (("bodies", bodies_table(hit)), ("contacts", contacts_table(hit)))
    told: dict[str, Any] = {
        name: [dict(zip(keys, map(json_value, row), strict=True)) for row in rows]
        for name, (headings, rows) in tables
        for keys in ([each.split(" ")[0] for each in headings],)
    }
    return told | {
        "detail": json_value(hit._statuses()[1]),
        "energy": hit.energy.to_dict(),
        "plan": hit.plan.to_dict(),
        "laws": dict(hit.laws),
        "run_time_s": hit.run_time,
    }


def write_json(hit: GatheringResult, path: str | Path) -> None:
    """Write ``to_dict``."""
    text = json.dumps(to_dict(hit), indent=2, allow_nan=False) + "\n"
    with replace_file(path) as stream:
        stream.write(text)


def write_csv(hit: GatheringResult, path: str | Path) -> None:
    """Write one row for each body, then one for each contact; cells without a value are empty."""
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
    history = hit.history
    columns = history.columns()
    headings = ["contact", *(csv_heading(name, history.unit(name), hit._scene) for name in columns)]
    count = len(hit.gathering.touches)
    rows = [
        [f"touches[{k}]", *(float(column[instant, k]) for column in columns.values())]
        for instant in range(len(history.time))
        for k in range(count)
    ]
    write_table(path, headings, rows)


#: Writers by the end of a file's name.
WRITERS = {".csv": write_csv, ".json": write_json}
