"""Numbers of a scene file that are written with their unit: ``radius = "1.45 in"``."""

from __future__ import annotations

import re
from collections.abc import Mapping

from contactlab.numeric.checks import refuse
from contactlab.numeric.units import CONVERSIONS, SAME_UNITS, convertible, factor
from contactlab.scene_file.entries import BODY_SECTIONS, UNITS

#: A number and what follows it.
QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S.*?)?\s*")
#: A range as on the command line.
RANGE = re.compile(r"\s*([-+.\de]+)\s*:\s*([-+.\de]+)\s*(?::\s*(\d+)\s*)?")
#: Sections of a file with numbers that have units.
SECTIONS = (*BODY_SECTIONS, "nondimensional", "sweep")
#: Ends of a range, in the unit of its entry.
ENDS = ("start", "stop")


def read_units(document: Mapping[str, object]) -> dict[str, object]:
    """Return the tables of a file with plain numbers, in SI and degrees, for those with a unit.

    Raises
    ------
    ValueError
        If a unit is missing, is not known, or is that of another quantity.
    """
    return {
        name: _read(content, name, "", content) if name in SECTIONS else content
        for name, content in document.items()
    }


def _read(value: object, path: str, own: str, table: object) -> object:
    """Return a value, or a list or table, with numbers for texts; ``own`` is the unit of SI."""
    if isinstance(value, Mapping):
        return {
            key: _read(inner, f"{path}.{key}", own if key in ENDS else _unit(key, value), value)
            for key, inner in value.items()
        }
    if isinstance(value, list):
        return [_read(each, f"{path}[{place}]", own, table) for place, each in enumerate(value)]
    if isinstance(value, str) and (ends := RANGE.fullmatch(value)) is not None:
        start, stop, count = ends.groups()
        remedy = f"under [sweep] write {{start = {start}, stop = {stop}, count = {count or 7}}}"
        raise refuse(path, value, "is a range as on the command line", remedy)
    written = QUANTITY.fullmatch(value) if own and isinstance(value, str) else None
    if written is None:
        return value
    number, unit = float(written[1]), SAME_UNITS.get(written[2], written[2])
    if unit is None:
        remedy = f"write {written[1]} without quotes" + (f" in {own}" if own != "1" else "")
        raise refuse(path, value, "must be a number, or a number and its unit", remedy)
    if (times := factor(unit, own)) is None:
        known = any(unit in pair for pair in CONVERSIONS) or unit in UNITS.values()
        rule = f"{unit} is " + ("the unit of another quantity" if known else "not known here")
        plain = "write a plain number" if own == "1" else f"give it in {convertible(own)}"
        raise refuse(path, value, rule, plain)
    return number * times


def _unit(key: str, table: Mapping[str, object]) -> str:
    """Return the unit of a key, which may be dotted; empty if it has none."""
    if "shape" in table and key not in UNITS:
        from contactlab.impact.shapes import shapes_by_name  # needed for their own keys only

        shape = shapes_by_name().get(str(table["shape"]))
        if shape is not None and key in (*shape.needed, *shape.further):
            return "m"  # numbers of a shape are lengths
    return UNITS.get(key.rpartition(".")[2], "")
