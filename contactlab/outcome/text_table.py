"""Plain text tables with numbers aligned right and text aligned left."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence

from contactlab.outcome.tables import number

#: Width of a table in characters, and least width of a column of text that is wrapped.
WIDTH, LEAST_TEXT = 100, 30


def table(headings: Sequence[str], rows: Sequence[Sequence[object]], *, digits: int = 6) -> str:
    """Return a table as text: headings, a rule, rows.

    In a table wider than ``WIDTH`` the headings and a last column of text are wrapped.
    """
    texts = [all(isinstance(row[place], str) for row in rows) for place in range(len(headings))]
    body = [[[number(item, digits=digits)] for item in row] for row in rows]
    head = [[heading] for heading in headings]
    if sum(_widths([head, *body])) + 2 * len(head) > WIDTH:
        narrow = _widths(body) if body else [0] * len(head)
        head = [_fold(heading, width) for heading, width in zip(headings, narrow, strict=True)]
        if body and texts[-1]:
            room = max(WIDTH - sum(_widths([head, *body])[:-1]) - 2 * len(head), LEAST_TEXT)
            for row in body:
                row[-1] = textwrap.wrap(row[-1][0], room) or [""]
    widths = _widths([head, *body])
    height = max(map(len, head))
    head = [[""] * (height - len(cell)) + cell for cell in head]  # align headings at the bottom
    rule = [["-" * width] for width in widths]
    return "\n".join(line for row in (head, rule, *body) for line in _lines(row, widths, texts))


def fill(text: str) -> str:
    """Return a text in lines of ``WIDTH``, no word broken."""
    return textwrap.fill(text, WIDTH, break_on_hyphens=False, break_long_words=False)


def _lines(row: Sequence[Sequence[str]], widths: Sequence[int], texts: Sequence[bool]) -> list[str]:
    """Return the lines of a row; each cell is a list of lines."""
    lines = []
    for level in range(max(map(len, row))):
        cells = [cell[level] if level < len(cell) else "" for cell in row]
        placed = [
            cell.ljust(width) if text else cell.rjust(width)
            for cell, width, text in zip(cells, widths, texts, strict=True)
        ]
        lines.append("  ".join(placed).rstrip())
    return lines


def _widths(rows: Sequence[Sequence[Sequence[str]]]) -> list[int]:
    """Return the width of each column in characters."""
    return [
        max(len(line) for cell in column for line in cell) for column in zip(*rows, strict=True)
    ]


def _fold(heading: str, width: int) -> list[str]:
    """Return a heading in lines about as wide as its column, split at underscores and blanks."""
    words = re.findall(r"[^_ ]+_?|_", heading)
    lines: list[str] = []
    for word, blank in zip(words, [" " + word in heading for word in words], strict=True):
        joined = (lines[-1] + " " * blank + word) if lines else word
        if lines and len(joined) <= max(width, *map(len, words)):
            lines[-1] = joined
        else:
            lines.append(word)
    return lines
