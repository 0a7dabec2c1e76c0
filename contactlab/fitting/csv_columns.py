"""Columns of a CSV file of measured impacts: headings with units, and numbers."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from contactlab.impact.scene import entry_unit
from contactlab.numeric.names import nearest
from contactlab.outcome.columns import QUANTITIES
from contactlab.outcome.files import content
from contactlab.scene_file.entries import ENTRIES

#: Quantities of a rebound that can be measured.
MEASURABLE = (
    "normal_restitution", "tangential_restitution", "slip_restitution", "rebound_angle_deg",
    "local_rebound_angle_deg", "rebound_angle", "local_rebound_angle", "rebound_speed",
    "rebound_normal_velocity", "rebound_tangential_velocity", "rebound_slip_velocity",
    "rebound_spin", "contact_time", "psi2",
)  # fmt: skip
#: Factors from the unit of a column to the unit of the quantity.
CONVERSIONS = {
    ("rad", "deg"): math.degrees(1.0), ("deg", "rad"): math.radians(1.0),
    ("mm/s", "m/s"): 1e-3, ("cm/s", "m/s"): 1e-2, ("mm", "m"): 1e-3, ("g", "kg"): 1e-3,
    ("rpm", "rad/s"): 2.0 * math.pi / 60.0, ("rev/s", "rad/s"): 2.0 * math.pi,
    ("1/min", "rad/s"): 2.0 * math.pi / 60.0, ("deg/s", "rad/s"): math.radians(1.0),
    ("ms", "s"): 1e-3, ("µs", "s"): 1e-6, ("us", "s"): 1e-6,
}  # fmt: skip
#: Endings of a name that state its unit, the longest first: ``_rad_s`` before ``_s``.
ENDINGS = sorted(
    ((f"_{unit.replace('/', '_')}", unit) for pair in CONVERSIONS for unit in pair),
    key=lambda ending: -len(ending[0]),
)
SAME_UNITS = {"°": "deg", "degrees": "deg", "-": "1"}
#: Words in brackets that are units, known or not.
UNITS = {unit for pair in CONVERSIONS for unit in pair} | set(SAME_UNITS) | {"%", "percent"}
#: Other names of the entry ``angle_deg``.
ANGLES = ("angle", "incidence_angle", "incidence_angle_deg")
ERROR = "_error"
HEADING = re.compile(r"^\s*([^()\[\]]+?)\s*(?:[(\[]([^()\[\]]*)[)\]])?\s*$")
#: Encodings tried in turn: UTF-8 with or without a mark, then that of older spreadsheets.
ENCODINGS = ("utf-8-sig", "cp1252")


class Heading(NamedTuple):
    """The meaning of a column.

    ``role`` is "given" (an entry of the scene), "measured", "error" (standard error of a
    measured quantity) or "unused"; ``factor`` converts to the unit of ``name``.
    """

    role: str
    name: str
    factor: float = 1.0


def read_heading(text: str, columns: Mapping[str, str]) -> Heading:
    """Return the role, the name and the factor of a column."""
    alias = columns.get(text.strip(), text)
    if alias is not text and alias.startswith("-"):
        heading = read_heading(text, {text.strip(): alias[1:]})
        return heading._replace(factor=-heading.factor)
    if alias.lstrip().startswith("#") or not alias.strip():
        return Heading("unused", text)
    error, name, unit = _name_and_unit(alias)
    if alias is not text and not unit:
        unit = _name_and_unit(text)[2]
    if name in ANGLES and not error:
        return Heading("given", "angle_deg", _factor(text, name, unit, "deg"))
    if name in ENTRIES and not error:
        return Heading("given", name, _factor(text, name, unit, entry_unit(name)))
    if unit == "deg" and not name.endswith("_deg"):
        name = f"{name}_deg"
    if name in MEASURABLE:
        role = "error" if error else "measured"
        return Heading(role, name, _factor(text, name, unit, QUANTITIES[name].unit))
    if name in QUANTITIES or name == "status":
        return Heading("unused", text)
    raise ValueError(
        f"heading {text!r}: is neither an entry of a scene nor a quantity of a rebound; "
        f"{nearest(name, [*ENTRIES, *MEASURABLE])}{_known_names()}name the column by --column "
        f"'{text.strip()}=...' (columns= in Python), or begin its heading with # to leave it unread"
    )


def _known_names() -> str:
    """Return the names that a heading may have."""
    before = [entry for entry in ENTRIES if "." not in entry]
    return f"before the impact: {', '.join(before)}; after it: {', '.join(MEASURABLE)}; "


def _name_and_unit(text: str) -> tuple[bool, str, str]:
    """Return whether a heading names an error, its name, and its unit (empty if it has none)."""
    parts = HEADING.match(text)
    if not parts:
        raise ValueError(f"heading {text!r}: write a name and its unit, as in 'speed (m/s)'")
    name, unit = re.sub(r"[\s-]+", "_", parts[1].lower()), (parts[2] or "").strip()
    words = re.sub(r"\s*/\s*", "/", unit).split()
    if len(words) > 1:  # such as "from normal", or "deg from normal"
        words = [word for word in words if word in UNITS]
    unit = SAME_UNITS.get(words[0], words[0]) if words else ""
    error = name.endswith(ERROR)
    name = name.removesuffix(ERROR)
    if name not in ENTRIES and name not in QUANTITIES and name not in ANGLES:
        for ending, ending_unit in ENDINGS:
            if name.endswith(ending) and unit in ("", ending_unit):
                name, unit = name.removesuffix(ending), ending_unit
                break
    return error or name.endswith(ERROR), name.removesuffix(ERROR), unit


def _factor(text: str, name: str, unit: str, own: str) -> float:
    """Return the factor from the unit of a heading to the unit of the named quantity."""
    if unit == own or (not unit and (own == "1" or name.endswith("_deg"))):
        return 1.0
    if (unit, own) in CONVERSIONS:
        return CONVERSIONS[unit, own]
    convertible = "".join(f", or ({unit})" for unit, to in CONVERSIONS if to == own)
    reason = "has no unit" if not unit else f"is in {unit}, which is not known here"
    raise ValueError(f"heading {text!r}: {reason}; write '{name} ({own})'{convertible}")


def read_text(path: Path) -> str:
    """Return the text of a CSV file in whichever encoding it has."""
    remedy = "give the path of a CSV of impacts"
    coded = content(path, kind="a table of impacts", remedy=remedy)
    for encoding in ENCODINGS:
        try:
            text = coded.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    raise ValueError(f"{path}: cannot be read as text; save it as CSV in UTF-8")


def read_columns(text: str, names: Mapping[str, str]) -> dict[str, list[float]]:
    """Return the numbers of a CSV table by their headings; NaN for unused or empty cells.

    Columns are separated by commas; or by semicolons or tabs, and then a number may have a
    decimal comma.
    """
    headings, rows, decimal_comma = _rows(text)
    if len(set(headings)) < len(headings):
        raise ValueError("two columns have the same heading")
    roles, refused = [], []
    for heading in headings:
        try:
            roles.append(read_heading(heading, names).role)
        except ValueError as error:
            refused.append(str(error))
    if refused:  # all at once, to be mended at once; the names that there are, once
        first = [sentence.replace(_known_names(), "") for sentence in refused[:-1]]
        raise ValueError(". And ".join([*first, refused[-1]]))
    columns: dict[str, list[float]] = {heading: [] for heading in headings}
    for line, row in rows:
        if len(row) != len(headings):
            raise ValueError(
                f"line {line}: has {len(row)} columns, the headings are {len(headings)}"
            )
        for heading, role, cell in zip(headings, roles, row, strict=True):
            try:
                columns[heading].append(_number(cell, role, decimal_comma))
            except ValueError as error:
                raise ValueError(f"line {line}, {heading!r}: {error}") from None
    return columns


def _rows(text: str) -> tuple[list[str], list[tuple[int, list[str]]], bool]:
    """Return headings, cells of each line with its number, and whether decimals have a comma.

    Lines that begin with ``#`` are comments; but headings may begin with one, if the line after
    them holds numbers.
    """
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    kept = [place for place, (_, line) in enumerate(lines) if not line.lstrip().startswith("#")]
    above = first = lines[kept[0]][1] if kept else ""
    if kept and kept[0] and _is_number(re.split("[,;\t]", first)[0]):
        above = lines[kept[0] - 1][1]  # headings, which have no decimal comma
    # Columns are separated by the mark that is most frequent.
    mark = max(",;\t", key=lambda mark: min(first.count(mark), above.count(mark)))

    def cells(place: int) -> list[str]:
        return next(csv.reader([lines[place][1].lstrip(" ")], delimiter=mark))

    if kept and kept[0] and _is_number(cells(kept[0])[0].replace(",", ".")):
        kept.insert(0, kept[0] - 1)
        _check_comment(lines[kept[0]][0], cells(kept[0])[0])
    if len(kept) < 2:
        raise ValueError("needs a line of headings and a line for each impact")
    return cells(kept[0]), [(lines[place][0], cells(place)) for place in kept[1:]], mark != ","


def _check_comment(line: int, heading: str) -> None:
    """Refuse a # before all headings, as some programs write it: a column would be lost."""
    name = heading.lstrip("# ")
    try:
        role = read_heading(name, {}).role
    except ValueError:
        return
    if role != "unused":
        raise ValueError(
            f"line {line}: begins with #, so that {name!r} would not be read; leave out "
            "the # (or, if that column is not to be read, give it another name)"
        )


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _number(cell: str, role: str, decimal_comma: bool) -> float:
    """Return the number in a cell; NaN for an unused column or an empty cell after the impact."""
    if role == "unused" or (not cell.strip() and role != "given"):
        return math.nan
    text = cell.replace(",", ".") if decimal_comma else cell
    if _is_number(text):
        return float(text)
    if "," in cell and "." in cell and _is_number(re.sub("[,.]", "", cell)):
        raise ValueError(f"{cell!r}: write numbers without marks for thousands")
    raise ValueError(f"{cell!r} is not a number" if cell.strip() else "is empty")
