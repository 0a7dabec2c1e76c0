"""Columns of a CSV file of measured impacts: headings with units, and numbers."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from contactlab.impact.scene import entry_unit
from contactlab.numeric.names import nearest
from contactlab.numeric.units import CONVERSIONS, SAME_UNITS, factor
from contactlab.outcome.columns import QUANTITIES, foreign
from contactlab.outcome.files import content
from contactlab.registry.read_options import options_read
from contactlab.registry.registry import REGISTRY
from contactlab.scene_file.entries import ENTRIES, PROPERTY, is_option

#: Quantities of a rebound that can be measured.
MEASURABLE = (
    "normal_restitution", "tangential_restitution", "beta0", "rebound_angle_deg",
    "local_rebound_angle_deg", "rebound_angle", "local_rebound_angle", "rebound_speed",
    "rebound_normal_velocity", "rebound_tangential_velocity", "rebound_slip_velocity",
    "rebound_spin", "contact_time", "psi2",
)  # fmt: skip
#: Endings of a name that state its unit, the longest first: ``_rad_s`` before ``_s``. A name such
#: as ``v_in`` is of the way in, not in inches.
ENDINGS = sorted(
    (
        (f"_{unit.replace('/', '_')}", SAME_UNITS.get(unit, unit))
        for unit in {*(unit for pair in CONVERSIONS for unit in pair), *SAME_UNITS} - {"in", "-"}
    ),
    key=lambda ending: (-len(ending[0]), ending[0]),
)
#: Words in brackets that are units, known or not.
UNITS = {unit for pair in CONVERSIONS for unit in pair} | set(SAME_UNITS) | {"%", "percent"}
#: Other names of the entry ``angle_deg``.
ANGLES = ("angle", "incidence_angle", "incidence_angle_deg")
ERROR = "_error"
#: Words for an error as endings of a heading.
DEVIATION = re.compile(r"_(e?rror|err|std|sd|se|sem|sigma|uncertainty)$")
#: Names of angles from the surface, with the name of the angle from the normal.
FROM_SURFACE = {"angle_from_surface": "angle", "rebound_angle_from_surface": "rebound_angle"}
#: Remedy for a table without headings.
IN_ORDER = (
    "name all columns in their order by --columns angle_deg,psi2 (columns=[...] in Python), "
    "each with its unit, as in 'speed (m/s)'"
)
HEADING = re.compile(r"^\s*([^()\[\]]+?)\s*(?:[(\[]([^()\[\]]*)[)\]])?\s*$")
#: A heading in a line whose columns are separated by blanks; its unit is in brackets.
BLANK = re.compile(r"[^\s(\[]+(?:\s*[(\[][^()\[\]]*[)\]])?")
#: Cells without a number.
MISSING = ("", "nan", "na", "n/a")
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
#: First line by which a spreadsheet is told the mark between columns.
SEPARATOR = re.compile(r'\s*"?sep=([,;\t])"?[,;\s]*', re.IGNORECASE)
#: Encodings tried in turn: UTF-8 with or without a mark, then that of older spreadsheets.
ENCODINGS = ("utf-8-sig", "cp1252")


class UnknownHeadingError(ValueError):
    """A heading that names nothing of a scene or of a rebound."""


class Heading(NamedTuple):
    """The meaning of a column.

    ``role`` is "given" (an entry of the scene), "measured", "error" (standard error of a
    measured quantity) or "unused"; ``factor`` converts to the unit of ``name``, ``offset`` is added
    then.
    """

    role: str
    name: str
    factor: float = 1.0
    offset: float = 0.0


def measurable() -> tuple[str, ...]:
    """Return the quantities of a rebound that can be measured, columns of plug-ins among them."""
    return (*MEASURABLE, *foreign())


def read_heading(text: str, columns: Mapping[str, str]) -> Heading:
    """Return the role, the name and the factor of a column."""
    alias = columns.get(text.strip(), text)
    if alias is not text and alias.startswith("-"):
        heading = read_heading(text, {text.strip(): alias[1:]})
        return heading._replace(factor=-heading.factor)
    if alias.lstrip().startswith("#") or not alias.strip():
        return Heading("unused", text)
    error, name, unit = name_and_unit(alias)
    if alias is not text and not unit:
        unit = name_and_unit(text)[2]
    if (normal := FROM_SURFACE.get(name.removesuffix("_deg"))) is not None:
        own = "deg" if name.endswith("_deg") else ""
        size = _factor(text, name, unit or own, "deg")
        role = "given" if normal in ANGLES else "measured"
        if not error:
            return Heading(role, f"{normal}_deg", -size, 90.0)
        return Heading("error" if role == "measured" else "unused", f"{normal}_deg", size)
    if name in ANGLES and not error:
        return Heading("given", "angle_deg", _factor(text, name, unit, "deg"))
    if not error and (is_option(name) or PROPERTY.fullmatch(name)):
        return Heading("given", name, _factor(text, name, unit, unit_of(name, text)))
    if name in ENTRIES and not error:
        return Heading("given", name, _factor(text, name, unit, entry_unit(name)))
    if unit == "deg" and not name.endswith("_deg"):
        name = f"{name}_deg"
    if name.strip("|") in measurable():
        role = "error" if error else "measured"
        own = QUANTITIES[name].unit
        return Heading(role, name, _factor(text, name, unit, own, ERROR * error))
    if name in QUANTITIES or name == "status":
        return Heading("unused", text)
    said = f"heading {text!r}: " + ("" if alias is text else f"{alias} ")
    raise UnknownHeadingError(
        f"{said}is no known name; {_nearest(name, error)}{list_names()}"
        f"name the column: --column '{text.strip()}=...' (columns= in Python), or "
        "put # before the heading to skip the column"
    )


def _nearest(name: str, error: bool) -> str:
    """Return which name is nearest to an unknown one; of an error, which has no sign, its name."""
    plain = DEVIATION.sub("", name)
    hint = nearest(plain, [*ENTRIES, *measurable()])
    found = re.findall(r"'(\w+)'", hint)
    if (not error and plain == name) or not set(found).issubset(measurable()):
        return hint
    return re.sub(r"'(\w+)'(, which[^?]*)?", rf"'\1{ERROR}'", hint)


def unit_of(name: str, text: str) -> str:
    """Return the unit in which the installed laws read an option, or a property, of each impact."""
    kind = name.partition(".")[0] if is_option(name) else ""
    option = name.rpartition(".")[2]
    units = {
        read.unit
        for info in REGISTRY.installed()
        if kind in ("", info.kind) and REGISTRY.at_hand(info)
        for read in options_read(REGISTRY.law_class(info.known_as))
        if read.name == option and (read.per_impact if kind else read.material is not None)
    }
    if len(units) != 1:
        rule = (
            f"is read in {' and in '.join(sorted(units))} by several" if units else "is read by no"
        )
        raise ValueError(f"heading {text!r}: {option} of each impact {rule} laws at hand")
    return units.pop()


def list_names() -> str:
    """Return the names that a heading may have."""
    before = [entry for entry in ENTRIES if "." not in entry]
    return f"before the impact: {', '.join(before)}; after it: {', '.join(measurable())}; "


def name_and_unit(text: str) -> tuple[bool, str, str]:
    """Return whether a heading names an error, its name, and its unit (empty if it has none)."""
    parts = HEADING.match(text)
    if not parts:
        raise ValueError(f"heading {text!r}: write a name and its unit, as in 'speed (m/s)'")
    name, unit = re.sub(r"[\s-]+", "_", parts[1].lower()), (parts[2] or "").strip()
    words = re.sub(r"\s*/\s*", "/", unit).split()
    if len(words) > 1:  # such as "from normal", or "deg from normal"
        words = [word for word in words if word in UNITS and word != "in"]
    unit = SAME_UNITS.get(words[0], words[0]) if words else ""
    error = name.endswith(ERROR)
    name = name.removesuffix(ERROR)
    if name not in ENTRIES and name not in (*QUANTITIES, *ANGLES):
        for ending, ending_unit in ENDINGS:
            if name.endswith(ending) and unit in ("", ending_unit):
                name, unit = name.removesuffix(ending), ending_unit
                break
    return error or name.endswith(ERROR), name.removesuffix(ERROR), unit


def _factor(text: str, name: str, unit: str, own: str, ending: str = "") -> float:
    """Return the factor from the unit of a heading to the unit of the named quantity."""
    if not unit and (own == "1" or name.endswith("_deg")):
        return 1.0
    if (times := factor(unit, own)) is not None:
        return times
    convertible = "".join(f", or ({unit})" for unit, to in CONVERSIONS if to == own)
    share = "divide the numbers by 100 and " if unit in ("%", "percent") else ""
    reason = "has no unit" if not unit else f"is in {unit}, which is not known here"
    raise ValueError(
        f"heading {text!r}: {reason}; {share}write '{name}{ending} ({own})'{convertible}"
    )


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


class Cells(NamedTuple):
    """The cells of a CSV: its headings, or None, its lines with their numbers, and the mark.

    ``decimal_comma`` tells that a number may have a decimal comma.
    """

    headings: list[str] | None
    lines: list[tuple[int, list[str]]]
    decimal_comma: bool


def read_columns(
    text: str, names: Mapping[str, str] | Sequence[str]
) -> tuple[dict[str, list[float]], Mapping[str, str], list[str]]:
    """Return numbers by headings, names of headings, and a sentence on each line left out.

    Columns are separated by commas or blanks; or by semicolons or tabs, and then a number may have
    a decimal comma. Unused, unknown and empty cells are NaN, but those of an unknown column that
    hold a number. A line without a number before the impact is left out.

    Parameters
    ----------
    text : str
        The table.
    names : mapping of str to str, or sequence of str
        Names for some headings; or names of all columns in their order.
    """
    headings, lines, decimal_comma = _cells(text)
    if headings is None:
        if isinstance(names, Mapping):
            rule = f"line {lines[0][0]}: holds numbers where headings should be"
            raise ValueError(f"{rule}; {IN_ORDER}")
        headings = [f"column {place}" for place in range(1, len(lines[0][1]) + 1)]
    if isinstance(names, Mapping):
        renamed = names
    elif len(names) == len(headings):
        renamed = {heading.strip(): name for heading, name in zip(headings, names, strict=True)}
    else:
        rule = f"--columns has {len(names)} names for {len(headings)} columns"
        raise ValueError(f"{rule}; name every column, # for one that is not to be read")
    if len(set(headings)) < len(headings):
        raise ValueError("two columns have the same heading")
    roles = [_role(heading, renamed) for heading in headings]
    columns: dict[str, list[float]] = {heading: [] for heading in headings}
    left_out = []
    for line, row in lines:
        if len(row) != len(headings):
            raise ValueError(
                f"line {line}: has {len(row)} columns, the headings are {len(headings)}"
            )
        numbers = []
        for heading, role, cell in zip(headings, roles, row, strict=True):
            try:
                numbers.append(_number(cell, role, decimal_comma))
            except ValueError as error:
                raise ValueError(f"line {line}, {heading!r}: {error}") from None
        read = zip(headings, roles, numbers, strict=True)
        gaps = [text for text, role, number in read if role == "given" and math.isnan(number)]
        if gaps:
            left_out.append(f"line {line} is left out: it has no number of {', '.join(gaps)}")
            continue
        for column, number in zip(columns.values(), numbers, strict=True):
            column.append(number)
    if left_out and not any(columns.values()):
        raise ValueError(f"no impact is left; {left_out[0]}")
    return columns, renamed, left_out


def read_numbers(text: str, source: str) -> dict[str, list[float]]:
    """Return the columns of a CSV by their headings; NaN for a cell that is no number."""
    try:
        headings, lines, decimal_comma = _cells(text)
        if headings is None:
            raise ValueError("needs a line of headings")
        for line, row in lines:
            if len(row) != len(headings):
                raise ValueError(
                    f"line {line}: has {len(row)} columns, the headings are {len(headings)}"
                )
    except ValueError as error:
        raise ValueError(f"{source}: {error}") from None
    return {
        heading: [_number(row[place], "unknown", decimal_comma) for _, row in lines]
        for place, heading in enumerate(headings)
    }


def _role(heading: str, names: Mapping[str, str]) -> str:
    """Return the role of a column; "unknown" for a heading that is refused later."""
    try:
        return read_heading(heading, names).role
    except ValueError:
        return "unknown"


def _cells(text: str) -> Cells:
    """Return headings, cells of each line with its number, and whether decimals have a comma.

    A first line ``sep=;`` tells the mark. Lines that begin with ``#`` are comments; but headings
    may begin with one, if the line after them holds numbers.
    """
    lines = [(number, line) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    if told := SEPARATOR.fullmatch(lines[0][1]) if lines else None:
        lines = lines[1:]
    kept = [place for place, (_, line) in enumerate(lines) if not line.lstrip().startswith("#")]
    above = first = lines[kept[0]][1] if kept else ""
    if kept and kept[0] and _is_number(re.split(r"[,;\s]", first.strip())[0]):
        above = lines[kept[0] - 1][1]  # headings, which have no decimal comma
    # Columns are separated by the mark that is most frequent, or by blanks.
    mark = max(",;\t", key=lambda mark: min(first.count(mark), above.count(mark)))
    if told:
        mark = told[1]
    if blanks := not told and any(_by_blanks(lines[place][1]) for place in kept[:2]):
        mark = " "

    def cells(place: int) -> list[str]:
        line = lines[place][1]
        if blanks:
            return line.split() if _by_blanks(line) else BLANK.findall(line)
        return next(csv.reader([line.lstrip(" ")], delimiter=mark))

    def holds_numbers(row: list[str]) -> bool:
        some = [cell for cell in row if cell.strip().lower() not in MISSING]
        return bool(some) and all(_is_number(cell.strip().replace(",", ".")) for cell in some)

    if kept and kept[0] and _is_number(cells(kept[0])[0].strip().replace(",", ".")):
        above_cells = cells(kept[0] - 1)
        if len(above_cells) == len(cells(kept[0])):  # otherwise a remark
            kept.insert(0, kept[0] - 1)
            _check_comment(lines[kept[0]][0], above_cells[0])
    headless = bool(kept) and holds_numbers(cells(kept[0]))
    if len(kept) < 2 - headless:
        raise ValueError("needs a line of headings and a line for each impact")
    return Cells(
        headings=None if headless else cells(kept[0]),
        lines=[(lines[place][0], cells(place)) for place in (kept if headless else kept[1:])],
        decimal_comma=mark != ",",
    )


def _by_blanks(line: str) -> bool:
    """Return whether a line is one of several numbers with blanks between them."""
    words = line.split()
    return (
        "\t" not in line.strip()
        and len(words) > 1
        and all(
            (_is_number(word.replace(",", ".")) and not word.endswith(","))
            or word.lower() in MISSING
            for word in words
        )
    )


def _check_comment(line: int, heading: str) -> None:
    """Refuse a # before all headings, as some programs write it: a column would be lost."""
    name = heading.lstrip("# ")
    try:
        role = read_heading(name, {}).role
    except ValueError:
        return
    if role != "unused":
        raise ValueError(
            f"line {line}: begins with #, which would skip the column {name!r}; leave out the #, "
            "or rename the column to skip it"
        )


def _is_number(text: str) -> bool:
    """Return whether a text is a number as tables have it: ``1_0`` and words are none."""
    return NUMBER.fullmatch(text) is not None


def _number(cell: str, role: str, decimal_comma: bool) -> float:
    """Return the number in a cell; NaN if it is empty, or for a column that is not read."""
    text = cell.strip()
    text = text.replace(",", ".") if decimal_comma else text
    if role == "unused" or text.lower() in MISSING or (role == "unknown" and not _is_number(text)):
        return math.nan
    if _is_number(text):
        return float(text)
    if "," in cell and "." in cell and _is_number(re.sub("[,.]", "", cell)):
        raise ValueError(f"{cell!r}: write numbers without marks for thousands")
    raise ValueError(f"{cell!r} is not a number")
