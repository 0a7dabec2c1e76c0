"""Run extreme cases over every law; find silently wrong answers.

Examples
--------
  contactlab stability --quick
  contactlab stability --figure stability.png --out stability.csv
  contactlab stability --tangential springs --time-limit 60
  contactlab stability --restitution 0.6 --quick
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from contactlab.cli import arguments as shared
from contactlab.numeric.progress import in_words
from contactlab.outcome.columns import json_value
from contactlab.outcome.text_table import table
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.study.bench_methods import Method, methods
from contactlab.study.error_map import error_maps
from contactlab.study.model_error import ModelError
from contactlab.study.stability import Stability, estimate_time, stability
from contactlab.study.stability_judge import NO_REFERENCE, RAISED, SKIPPED, WRONG, Outcome

#: Most failures listed under the table; CSV and JSON hold every case.
LISTED = 40
#: Outcomes, in the order of the table.
WORDS = ("answered", "coarse", NO_REFERENCE, "refused", SKIPPED, RAISED, WRONG)


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the laws, the size, and the outputs."""
    shared.add_report(parser, progress="yes")
    shared.add_one_restitution(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Run the report; the status is 1 if any answer is silently wrong or a law raised."""
    if arguments.width == "one":
        raise ValueError("--width one: the map needs two columns; use --width two")
    laws = shared.choose_laws(arguments)
    chosen = methods(laws, restitution=arguments.restitution)
    told = arguments.progress is not False
    if told:
        cases, seconds = estimate_time(chosen, quick=arguments.quick)
        about = f"{cases} cases, about {in_words(seconds)} of processor time"
        print(f"contactlab stability: {about}", file=sys.stderr, flush=True)
    with shared.progress(told, "stability") as progress:
        result = stability(
            chosen, quick=arguments.quick, time_limit=arguments.time_limit, progress=progress
        )
    saved = shared.report(
        arguments,
        (arguments.figure, lambda path: _draw(path, arguments, chosen, result)),
        content=lambda: _content(result),
        to_csv=lambda stream: shared.items_csv(Outcome, result.outcomes, stream),
        text=lambda: report(result),
        interrupted=result.interrupted,
    )
    if result.interrupted:
        return shared.INTERRUPTED
    return shared.FAILED if result.failures() else saved


def _draw(
    path: Path, arguments: argparse.Namespace, chosen: Sequence[Method], result: Stability
) -> bool:
    """Draw the steps that the laws need, or say on stderr why not, and return False."""
    maps = error_maps(chosen, quick=arguments.quick) if result.complete else []
    if not maps:
        why = (
            "there is nothing to map"
            if result.complete
            else f"{shared.say_why_incomplete(result)} before the map was done"
        )
        print(f"no map drawn: {why}", file=sys.stderr)
        return False
    from contactlab.figures.files import save  # matplotlib only when drawing
    from contactlab.figures.stability import draw_least_steps

    save(path, lambda axes: draw_least_steps(axes, maps), **shared.look(arguments))
    return True


def report(result: Stability) -> str:
    """Return tables, failures and totals, and why the report is not complete if it is not."""
    families = list(dict.fromkeys(item.family for item in result.outcomes))
    names = list(dict.fromkeys(item.method for item in result.outcomes))
    errors = [[name, *(result.worst(name, family) for family in families)] for name in names]
    counts = [[name, *(result.counts(name)[word] for word in WORDS)] for name in names]
    parts = [table(["worst error", *families], errors, digits=1), table(["runs", *WORDS], counts)]
    if result.models:
        rows = [[item.law, *_worst(item)] for item in result.models]
        parts.append(table(["model error", "worst", "at chi"], rows, digits=1))
    failures = result.failures()
    if failures:
        rows = [[item.method, item.case, item.outcome, item.note] for item in failures[:LISTED]]
        parts.append(table(["method", "case", "", ""], rows))
    parts.append(
        f"{describe_totals(result)}\n"
        "Error: distance from the law's own exact answer, over the range of psi2.\n"
        "Coarse: answers that state or estimate an error above a quarter of the range.\n"
        "Model error: distance of a law's exact answer from the elastic continuum."
    )
    if not result.complete:
        parts.append(f"not complete: {shared.say_why_incomplete(result)}")
    return "\n\n".join(parts)


def describe_totals(result: Stability) -> str:
    """Return how many answers were compared, how many are wrong, and what became of the others."""
    totals = result.totals()
    raised = f"{totals['raised']} raised an error; " if totals["raised"] else ""
    return (
        f"{totals['compared']} compared, {totals['silently_wrong']} wrong; "
        f"{totals['no_reference']} had no reference (signs and energy were checked); "
        f"{totals['refused']} refused with a reason; {raised}"
        f"{totals['not_run']} not run (too long)."
    )


def _worst(item: ModelError) -> tuple[float, float]:
    """Return the largest model error of a law and its chi, NaN if there is none."""
    if np.all(np.isnan(item.error)):
        return np.nan, np.nan
    place = int(np.nanargmax(item.error))
    return float(item.error[place]), item.chis[place]


def _content(result: Stability) -> dict[str, object]:
    return {
        "outcomes": json_value(result.outcomes),
        "model_errors": json_value(result.models),
        "tried": result.tried(),
        **result.totals(),
        "complete": result.complete,
    }
