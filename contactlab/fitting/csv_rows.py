"""The rows of a CSV file of measured impacts, as spreadsheets and programs write them."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import NamedTuple

from contactlab.fitting.headings import read_heading
from contactlab.outcome.files import content

#: Encodings that are tried: that of today with or without a mark, and that of older spreadsheets.
ENCODINGS = ("utf-8-sig", "cp1252")


class Rows(NamedTuple):
    """The headings, and the cells of each line with its number in the file, the first being 1."""

    headings: list[str]
    cells: list[tuple[int, list[str]]]


def read_rows(path: Path) -> Rows:
    """Return the cells of a file; decimals have a point.

    Columns are separated by commas; or by semicolons or tabs, and then a number may have a
    decimal comma. A line that begins with ``#`` is a comment, but for one that stands where the
    headings should: their first column is then one that is not read.

    Raises
    ------
    ValueError
        If there is no such file, or it holds no table.
    """
    text = _text(path)
    lines = [(n, line) for n, line in enumerate(text.splitlines(), start=1) if line.strip()]
    places = [at for at, (_, line) in enumerate(lines) if not line.lstrip().startswith("#")]
    if not places:
        raise ValueError(f"{path}: needs a line of headings and a line for each impact")
    mark = _separator(lines[places[0]][1])
    rows = {at: next(csv.reader([lines[at][1]], delimiter=mark)) for at in places}
    if places[0] and _is_number(rows[places[0]][0].replace(",", ".")):
        places = [places[0] - 1, *places]
        number, line = lines[places[0]]
        rows[places[0]] = next(csv.reader([line.lstrip()], delimiter=mark))
        _check_first(path, number, rows[places[0]][0])
    if len(places) < 2:
        raise ValueError(f"{path}: needs a line of headings and a line for each impact")
    body = [(lines[at][0], rows[at]) for at in places[1:]]
    if mark != ",":
        body = [(line, _with_points(path, line, row)) for line, row in body]
    return Rows(rows[places[0]], body)


def _text(path: Path) -> str:
    remedy = "give the path of a CSV of impacts"
    found = content(path, kind="a table of impacts", remedy=remedy)
    for encoding in ENCODINGS:
        try:
            text = found.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    raise ValueError(f"{path}: cannot be read as text; save it as CSV in UTF-8")


def _separator(line: str) -> str:
    """Return what separates the columns: what is there most of commas, semicolons and tabs."""
    return max(",;\t", key=line.count)


def _check_first(path: Path, line: int, heading: str) -> None:
    """Refuse a mark before all the headings, as some programs write it: a column would be lost."""
    name = heading.lstrip("# ")
    try:
        known = read_heading(name).role != "unused"
    except ValueError:
        return
    if known:
        raise ValueError(
            f"{path}: line {line}: begins with #, so that {name!r} would not be read; leave out "
            "the # (or, if that column is not to be read, give it another name)"
        )


def _with_points(path: Path, line: int, row: list[str]) -> list[str]:
    """Return cells with points for decimal commas; a number with both is refused."""
    found = []
    for cell in row:
        changed = cell.replace(",", ".")
        if "." in cell and "," in cell and _is_number(cell.replace(",", "").replace(".", "")):
            raise ValueError(
                f"{path}: line {line}: {cell!r}: write numbers without marks for thousands"
            )
        found.append(changed if _is_number(changed) else cell)
    return found


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
