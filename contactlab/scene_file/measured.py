"""Measured values in a scene file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import attrs
import numpy as np

from contactlab.numeric.checks import of_kind, refuse
from contactlab.numeric.types import Array, Real
from contactlab.outcome.columns import find_quantity
from contactlab.scene_file.entries import entry_path
from contactlab.scene_file.table import Table

KEYS = ("quantity", "against", "label", "source", "x", "values", "error", "readings")
READING_KEYS = ("by", "point", "x", "values")


@attrs.frozen(kw_only=True, eq=False)
class Measured:
    """A series of measured values of one quantity.

    Attributes
    ----------
    quantity : str
        Quantity of a result, such as ``"tangential_restitution"``.
    against : str
        Entry of the scene that was varied, such as ``"angle_deg"``.
    x, values : array, shape (n,)
        Values of the entry and of the quantity, in the units of both.
    x_error, error : array, shape (n,)
        Half-widths; zero if the file has none. If the file has several readings of the same
        points, values are their means and errors half their range; NaN for a single reading.
    label, source : str
    beside : mapping of str to array, shape (n,)
        Other entries of each impact, that vary with it; empty if the scene has them.
    """

    quantity: str
    against: str
    x: Array
    values: Array
    x_error: Array
    error: Array
    label: str
    source: str
    beside: Mapping[str, Array] = attrs.field(factory=dict)

    @property
    def entries(self) -> dict[str, Array]:
        """Entries of each impact by name, the abscissa first."""
        return {self.against: self.x, **self.beside}

    @property
    def varied(self) -> dict[str, Array]:
        """Entries that differ from impact to impact, the abscissa first."""
        beside = {name: values for name, values in self.beside.items() if np.ptp(values)}
        return {self.against: self.x, **beside}


def read_series(content: object) -> tuple[Measured, ...]:
    """Return the series of a file's ``[[measured]]`` tables, in order."""
    rule = "must be a list of tables"
    tables = of_kind("measured", content, list, rule=rule, remedy="write [[measured]]")
    return tuple(_series(item, f"measured[{number}]") for number, item in enumerate(tables))


def _series(content: object, path: str) -> Measured:
    """Return one series; messages name ``path``."""
    table = Table(content, path, known=KEYS)
    quantity = table.text("quantity", remedy="name a quantity of the result")
    find_quantity(quantity, where=table.at("quantity"))
    against = table.text("against", remedy="name the entry that was varied, such as angle_deg")
    entry_path(against, where=f"{table.at('against')} = ")
    if table.has("readings") == table.has("x", "values"):
        raise ValueError(f"{path}: give either x and values, or readings, each with x and values")
    columns = _means(table) if table.has("readings") else _plain(table)
    return Measured(
        quantity=quantity,
        against=against,
        **columns,
        label=table.text("label", default="measured"),
        source=table.text("source", remedy="say where the numbers come from"),
    )


def _plain(table: Table) -> dict[str, Any]:
    """Return x, values and half-widths of a series with one list of each."""
    x = table.numbers("x", remedy="list where it was measured")
    values = table.numbers("values", remedy="list the measured values")
    error = table.numbers("error", default=np.zeros(np.size(values)), remedy="list half-widths")
    _equal_lengths(table, x=x, values=values, error=error)
    if np.any(np.asarray(error) < 0.0):
        raise refuse(table.at("error"), error, "must be zero or positive", "give half-widths")
    return {"x": x, "values": values, "x_error": np.zeros(np.size(x)), "error": error}


def _means(table: Table) -> dict[str, Any]:
    """Return means and half ranges of several readings of the same points."""
    rows: dict[float, list[tuple[float, float]]] = {}
    readings = table.content["readings"]
    if not isinstance(readings, list) or not readings:
        raise refuse(table.at("readings"), readings, "must be a list of tables")
    for number, item in enumerate(readings):
        reading = Table(item, table.at(f"readings[{number}]"), known=READING_KEYS)
        reading.text("by", remedy="say who read the figure")
        remedy = "list point numbers, x and values, of equal length"
        columns = {key: reading.numbers(key, remedy=remedy) for key in READING_KEYS[1:]}
        _equal_lengths(reading, **columns)
        for point, x, value in zip(
            *(np.asarray(c).tolist() for c in columns.values()), strict=True
        ):
            rows.setdefault(point, []).append((x, value))
    groups = [np.array(rows[point]) for point in sorted(rows)]
    middle = np.array([group.mean(axis=0) for group in groups])
    # of a single reading nothing is known
    half = np.array([0.5 * np.ptp(g, axis=0) if len(g) > 1 else [np.nan] * 2 for g in groups])
    return {"x": middle[:, 0], "values": middle[:, 1], "x_error": half[:, 0], "error": half[:, 1]}


def _equal_lengths(table: Table, **columns: Real) -> None:
    """Refuse columns of different lengths."""
    lengths = {key: np.size(column) for key, column in columns.items()}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{key} {length}" for key, length in lengths.items())
        raise ValueError(f"{table.path}: the lists must be of equal length; they have {listed}")
