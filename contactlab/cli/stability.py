"""Run stiff and extreme cases over every law and integrator; find answers silently wrong.

Examples
--------
  contactlab stability --quick
  contactlab stability --figure stability.png --csv stability.csv
  contactlab stability --law tangential.cundall --budget 60
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from contactlab.cli import arguments as shared
from contactlab.cli.table import table
from contactlab.outcome.columns import json_value
from contactlab.outcome.files import write_table
from contactlab.study.bench_methods import methods
from contactlab.study.model_error import ModelError
from contactlab.study.stability import Stability, stability
from contactlab.study.stability_cases import Case
from contactlab.study.stability_map import Region
from contactlab.study.stability_outcome import RAISED, WRONG, Outcome, judge

#: Failures listed one by one under the table; all of them are in the CSV and the JSON.
LISTED = 40
#: Outcomes, in the order of the table.
WORDS = ("answered", "coarse", "refused", "skipped", RAISED, WRONG)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the laws, the size, and the outputs."""
    shared.add_report(parser)


def execute(arguments: argparse.Namespace) -> int:
    """Run the report; a single silently wrong answer makes it fail."""
    shared.check_budget(arguments.budget)
    if arguments.width == "one":
        raise ValueError("--width one: the map is too wide for one column; use --width two")
    kept: list[Outcome] = []

    def judged(case: Case) -> Outcome:
        kept.append(judge(case))
        return kept[-1]

    why_not = "the budget ran out"
    try:
        with shared.progress(arguments.progress, "stability") as progress:
            found = stability(
                methods(arguments.law),
                quick=arguments.quick,
                budget=arguments.budget,
                progress=progress,
                judged=judged,
            )
    except KeyboardInterrupt:
        # What is done of the map is listed with the other outcomes.
        found, why_not = Stability(outcomes=tuple(kept), regions=(), complete=False), "interrupted"
    saved = shared.save(
        (arguments.csv, lambda path: _write_csv(path, found)),
        (arguments.figure, lambda path: _draw(path, found, why_not, **shared.look(arguments))),
        progress_wanted=arguments.progress,
    )
    content = json.dumps(_content(found), indent=2) if arguments.json else report(found, why_not)
    print(content)
    if why_not == "interrupted":
        return shared.INTERRUPTED
    return shared.FAILED if found.failures() else saved


def _draw(path: Path, found: Stability, why_not: str, **look: Any) -> None:
    if not found.regions and not found.models:
        why = "there is nothing to map" if found.complete else f"{why_not} before it was done"
        print(f"no map drawn: {why}", file=sys.stderr)
        return
    from contactlab.figures.stability import draw_stability  # matplotlib only when drawing

    draw_stability(path, found, **look)


def report(found: Stability, why_not: str = "the budget ran out") -> str:
    """Return the table, the failures and the totals; ``why_not`` is said if not complete."""
    families = list(dict.fromkeys(item.family for item in found.outcomes))
    names = list(dict.fromkeys(item.method for item in found.outcomes))
    errors = [[name, *(found.worst(name, family) for family in families)] for name in names]
    counts = [[name, *(found.counts(name)[word] for word in WORDS)] for name in names]
    parts = [table(["worst error", *families], errors, digits=1), table(["runs", *WORDS], counts)]
    if found.regions:
        rows = [
            [item.method, item.word, item.tried, item.count(RAISED), item.count(WRONG)]
            for item in found.regions
        ]
        parts.append(table(["map", "against chi", "tried", *WORDS[-2:]], rows))
    if found.models:
        rows = [[item.law, *_worst(item)] for item in found.models]
        parts.append(table(["model error", "worst", "at chi"], rows, digits=1))
    failures = found.failures()
    if failures:
        rows = [[item.method, item.case, item.outcome, item.note] for item in failures[:LISTED]]
        parts.append(table(["method", "case", "", ""], rows))
    parts.append(
        f"{found.tried()} runs tried, {found.silently_wrong()} silently wrong; "
        f"{found.skipped()} more were skipped as too much work.\nErrors are numerical, from the "
        "law's own exact answer, over the range that physics leaves to psi2,\nof answers whose "
        "declared or estimated error is below a quarter of it: the others are counted as coarse.\n"
        "A law whose exact answer is not that of the elastic continuum is listed with its model "
        "error."
    )
    if not found.complete:
        parts.append(f"not complete: {why_not}")
    return "\n\n".join(parts)


def _worst(item: ModelError) -> tuple[float, float]:
    """Return the largest model error of a law, and the chi that it is found at."""
    if np.all(np.isnan(item.error)):
        return np.nan, np.nan
    place = int(np.nanargmax(item.error))
    return float(item.error[place]), item.chis[place]


def _content(found: Stability) -> dict[str, object]:
    regions = [
        {**_plain(item), "failures": [_plain(failed) for failed in item.failures]}
        for item in found.regions
    ]
    return {
        "outcomes": [_plain(item) for item in found.outcomes],
        "map": regions,
        "model_errors": [_plain(item) for item in found.models],
        "tried": found.tried(),
        "silently_wrong": found.silently_wrong(),
        "complete": found.complete,
    }


def _plain(item: Outcome | Region | ModelError) -> dict[str, object]:
    return {key: json_value(value) for key, value in attrs.asdict(item, recurse=False).items()}


def _write_csv(path: Path, found: Stability) -> None:
    """Write a row for each outcome; of the map, for what is wrong or raised."""
    listed = [*found.outcomes, *(item for region in found.regions for item in region.failures)]
    names = [field.name for field in attrs.fields(Outcome)]
    write_table(path, names, ([getattr(item, name) for name in names] for item in listed))
