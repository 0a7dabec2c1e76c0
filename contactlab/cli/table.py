"""Plain text tables: numbers to the right, text to the left."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np


def number(value: Any, *, digits: int = 6) -> str:
    """Return a number for reading: ``digits`` significant, a dash where undefined."""
    if value is None or (isinstance(value, float | np.floating) and np.isnan(value)):
        return "-"
    if isinstance(value, float | np.floating):
        text = f"{float(value):.{digits}g}"
        return "0" if text == "-0" else text
    return str(value)


def time(seconds: float) -> str:
    """Return a time with a unit that suits it."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def table(headings: Sequence[str], rows: Sequence[Sequence[Any]], *, digits: int = 6) -> str:
    """Return rows under their headings, columns of text to the left, numbers to the right."""
    texts = [all(isinstance(row[place], str) for row in rows) for place in range(len(headings))]
    cells = [[number(item, digits=digits) for item in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(headings, *cells, strict=True)]
    lines = []
    for row in ([*headings], ["-" * width for width in widths], *cells):
        parts = [
            item.ljust(width) if text else item.rjust(width)
            for item, width, text in zip(row, widths, texts, strict=True)
        ]
        lines.append("  ".join(parts).rstrip())
    return "\n".join(lines)
