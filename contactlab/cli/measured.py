"""Output of ``contactlab validate --measured``: every law against every measured row."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from contactlab.cli import arguments as shared
from contactlab.outcome.columns import json_value
from contactlab.outcome.text_table import fill, table
from contactlab.study.by_row import ByRow, by_row

#: The picture of all slopes, in the folder of ``--out``.
PICTURE = "measured.png"


def execute(arguments: argparse.Namespace) -> int:
    """Print tables or JSON, and draw the picture if a folder is given."""
    folder: Path | None = arguments.out
    gathered: list[ByRow] = []
    interrupted = False
    try:
        with shared.progress(arguments.progress, "sets") as progress:
            gathered.extend(by_row(progress))
    except KeyboardInterrupt:
        if not gathered:
            raise
        interrupted = True
    path = None if folder is None else folder / PICTURE
    saved = shared.save(
        (path, lambda path: _draw(path, gathered)),
        progress_wanted=arguments.progress,
        interrupted=interrupted,
    )
    if arguments.json:
        shared.print_json({"sets": [_plain(one) for one in gathered], "complete": not interrupted})
    else:
        ending = ["not complete: interrupted"] if interrupted else []
        print("\n\n".join([*map(_text, gathered), *ending]))
    return shared.INTERRUPTED if interrupted else saved


def _text(one: ByRow) -> str:
    """Return a set with its words, and a row for each law."""
    headings = ["law", f"{one.quantity} rms", "within ±", "chi² a row", "worst row"]
    rows = [
        [law, one.rms(law), _count_within(one, law), one.chi2(law), one.worst(law)]
        for law in one.ordered
    ]
    words = [fill(text) for text in one.words if text]
    return "\n".join([f"{one.title} ({one.kind})", *words, table(headings, rows, digits=3)])


def _count_within(one: ByRow, law: str) -> str:
    """Return how many rows cover the law, of those with an error."""
    told = int((one.errors > 0.0).sum())
    fails = one.rms(law) != one.rms(law)
    return "fails" if fails else f"{one.within(law)} of {told}" if told else "-"


def _plain(one: ByRow) -> dict[str, Any]:
    """Return a set and its laws for JSON."""
    return {
        "name": one.name,
        "kind": one.kind,
        "title": one.title,
        "words": list(one.words),
        "quantity": one.quantity,
        "rows": list(one.rows),
        "values": json_value(one.values),
        "errors": json_value(one.errors),
        "laws": {
            law: {
                "values": json_value(one.laws[law]),
                "rms": json_value(one.rms(law)),
                "within": one.within(law),
                "chi2_a_row": json_value(one.chi2(law)),
                "worst": one.worst(law),
            }
            for law in one.ordered
        },
    }


def _draw(path: Path, gathered: list[ByRow]) -> None:
    from contactlab.figures.by_row import draw_slopes  # matplotlib only when drawing

    draw_slopes(path, [one for one in gathered if one.quantity == "beta0"])
