"""Measure error against run time of every law and integrator.

Examples
--------
  contactlab bench --quick
  contactlab bench --figure bench.png --out bench.csv
  contactlab bench --tangential springs,annulus --normal tsuji
  contactlab bench --markdown --figure bench.png > bench.md
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Unpack

from contactlab.cli import arguments as shared
from contactlab.outcome.columns import json_value
from contactlab.outcome.tables import time
from contactlab.outcome.text_table import table
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.study.bench_methods import methods
from contactlab.study.benchmark import Benchmark, Row
from contactlab.study.work_precision import bench


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the laws, the size, and the outputs."""
    shared.add_report(parser)
    parser.add_argument(
        "--markdown", action="store_true", help="print a row or two for each law, as Markdown"
    )
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Run the benchmark and report."""
    for name in ("json", "csv"):
        if getattr(arguments, name) and arguments.markdown:
            raise ValueError(f"--{name}, --markdown: cannot be combined; leave out one")
    laws = shared.chosen_laws(arguments)
    chosen = methods(laws)
    with shared.progress(arguments.progress, "bench") as progress:
        benchmark = bench(
            chosen,
            quick=arguments.quick,
            with_rebound=not laws,
            time_limit=arguments.time_limit,
            progress=progress,
        )
    saved = shared.save(
        (
            arguments.out,
            lambda path: shared.write_report(path, Row, benchmark.rows, _content(benchmark)),
        ),
        (arguments.figure, lambda path: _draw(path, benchmark, **shared.look(arguments))),
        progress_wanted=arguments.progress,
        interrupted=benchmark.interrupted,
    )
    if arguments.json:
        shared.print_json(_content(benchmark))
    elif arguments.csv:
        shared.items_csv(Row, benchmark.rows, sys.stdout)
    else:
        print(markdown(benchmark) if arguments.markdown else _report(benchmark))
    return shared.INTERRUPTED if benchmark.interrupted else saved


def _draw(path: Path, benchmark: Benchmark, **look: Unpack[shared.Drawing]) -> bool:
    """Draw error against run time, or return False; ``look`` as in ``arguments.look``."""
    if not benchmark.rows:
        print("no figure drawn: nothing was measured", file=sys.stderr)
        return False
    from contactlab.figures.files import save  # matplotlib only when drawing
    from contactlab.figures.work_precision import work_precision

    save(path, lambda axes: work_precision(axes, benchmark), columns=2, **look)
    return True


def _content(benchmark: Benchmark) -> dict[str, object]:
    rows, orders = json_value(benchmark.rows), json_value(benchmark.orders)
    return {"rows": rows, "orders": orders, "complete": benchmark.complete}


def markdown(benchmark: Benchmark) -> str:
    """Return the short table, a row or two for each law, as Markdown."""
    lines = [["law, integrator", "resolution", "psi2 rms", "worst", "beyond spheres",
              "energy books", "one impact", "each of many"], ["---"] * 8]  # fmt: skip
    for row in benchmark.short():
        law, _, integrator = row.method.partition(" / ")
        name = f"`{law}`" + f", `{integrator}`" * bool(integrator)
        errors = (row.error_rms, row.error_worst, row.elsewhere_rms, row.books_worst)
        numbers = [f"{value:.1e}" if value == value else "-" for value in errors]
        lines.append([name, row.options, *numbers, *_times(row)])
    text = "\n".join(f"| {' | '.join(line)} |" for line in lines)
    return (
        text
        if benchmark.complete
        else f"{text}\n\nnot complete: {shared.say_why_incomplete(benchmark)}"
    )


def _times(row: Row) -> list[str]:
    """Return the run time of one impact alone and in a sweep, a dash for NaN."""
    return [time(value) if value == value else "-" for value in (row.time_s, row.sweep_time_s)]


def _report(benchmark: Benchmark) -> str:
    """Return the full table and the orders of convergence."""
    front = benchmark.front()
    lines = []
    for row in benchmark.rows:
        times = _times(row)
        errors = [
            row.error_rms, row.error_worst, row.elsewhere_rms, row.force_error_rms, row.books_worst
        ]  # fmt: skip
        note = "front" if row in front else "" if row.ok else f"{row.failed} x {row.status}"
        lines.append([row.method, row.options, *errors, *times, note])
    headings = [
        "method", "resolution", "psi2 rms", "worst", "elsewhere", "force", "books", "one",
        "of many", "note",
    ]  # fmt: skip
    text = table(headings, lines, digits=2)
    orders = [[name, order] for name, order in benchmark.orders.items() if order == order]
    if orders:
        text += "\n\n" + table(["method", "order observed"], orders, digits=3)
    return (
        text
        if benchmark.complete
        else f"{text}\n\nnot complete: {shared.say_why_incomplete(benchmark)}"
    )
