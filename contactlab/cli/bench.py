"""Measure error against processor time of every law, on ten kinds of impact.

Examples
--------
  contactlab bench --quick
  contactlab bench --question "plane with e"
  contactlab bench --quick --restitution 0.6
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
from contactlab.study.benchmark import TIMES, Benchmark, Row
from contactlab.study.questions import questions
from contactlab.study.work_precision import bench


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the laws, the question, the size, and the outputs."""
    shared.add_report(parser)
    shared.add_one_restitution(parser)
    parser.add_argument(
        "--question", metavar="NAME", help="one question, by the name that the report prints"
    )
    parser.add_argument(
        "--markdown", action="store_true", help="print a row or two for each law, as Markdown"
    )
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Run the benchmark and report."""
    for name in ("json", "csv"):
        if getattr(arguments, name) and arguments.markdown:
            raise ValueError(f"--{name}, --markdown: cannot be combined; leave out one")
    asked = questions(
        shared.choose_laws(arguments), arguments.question, restitution=arguments.restitution
    )
    with shared.progress(arguments.progress, "bench") as progress:
        benchmark = bench(
            asked,
            quick=arguments.quick,
            time_limit=arguments.time_limit,
            progress=progress,
        )
    saved = shared.report(
        arguments,
        (arguments.figure, lambda path: _draw(path, benchmark, **shared.look(arguments))),
        content=lambda: _content(benchmark),
        to_csv=lambda stream: shared.items_csv(Row, benchmark.rows, stream),
        text=lambda: markdown(benchmark) if arguments.markdown else _report(benchmark),
        interrupted=benchmark.interrupted,
    )
    return shared.INTERRUPTED if benchmark.interrupted else saved


def _draw(path: Path, benchmark: Benchmark, **look: Unpack[shared.Drawing]) -> bool:
    """Draw error against run time, or return False; ``look`` as in ``arguments.look``."""
    if not benchmark.rows:
        print("no figure drawn: nothing was measured", file=sys.stderr)
        return False
    from contactlab.figures.files import save  # matplotlib only when drawing
    from contactlab.figures.work_precision import COLUMNS, HEIGHT, work_precision

    count = len(benchmark.by_question())
    columns = min(count, COLUMNS)
    rows = -(-count // columns)
    save(
        path,
        lambda axes: work_precision(axes, benchmark),
        rows=rows,
        columns=columns,
        heights=(1.0,) * rows,
        low=HEIGHT,
        **look,
    )
    return True


def _content(benchmark: Benchmark) -> dict[str, object]:
    rows, orders = json_value(benchmark.rows), json_value(benchmark.orders)
    return {
        "rows": rows,
        "orders": orders,
        "complete": benchmark.complete,
        "left_out": list(benchmark.left_out),
    }


def markdown(benchmark: Benchmark) -> str:
    """Return the short table, a row or two for each law of each question, as Markdown."""
    lines = [["question", "law, integrator", "resolution", "rms", "worst", "energy books",
              "one impact", "each of many"], ["---"] * 8]  # fmt: skip
    for row in benchmark.short():
        law, _, integrator = row.method.partition(" / ")
        name = f"`{law}`" + f", `{integrator}`" * bool(integrator)
        errors = (row.error_rms, row.error_worst, row.books_worst)
        numbers = [f"{value:.1e}" if value == value else "-" for value in errors]
        lines.append([row.question, name, row.options, *numbers, *_times(row)])
    return _end("\n".join(f"| {' | '.join(line)} |" for line in lines), benchmark)


def _times(row: Row) -> list[str]:
    """Return the time of one impact alone and of each of many, a dash for NaN."""
    return [time(value) if value == value else "-" for value in (row.time_s, row.sweep_time_s)]


def _report(benchmark: Benchmark) -> str:
    """Return a table for each question, and the orders of convergence."""
    headings = ["method", "resolution", "rms", "worst", "books", "one", "of many", "note"]
    parts = []
    for question, rows in benchmark.by_question().items():
        fronts = {word: benchmark.front(question, word) for word in TIMES}
        lines = []
        for row in rows:
            if row.peer:
                continue
            on = [word for word, front in fronts.items() if row in front]
            note = f"front {', '.join(on)}" if on else ""
            if not row.ok:
                note = f"{row.failed} x {row.status}"
            errors = [row.error_rms, row.error_worst, row.books_worst]
            lines.append([row.method, row.options, *errors, *_times(row), note])
        parts.append(f"{question}\n{table(headings, lines, digits=2)}")
    parts += _peers(benchmark)
    orders = [[name, order] for name, order in benchmark.orders.items()]
    if orders:
        parts.append(table(["method", "order observed"], orders, digits=3))
    return _end("\n\n".join(parts), benchmark)


def _peers(benchmark: Benchmark) -> list[str]:
    """Return a table of other engines, whose difference from the exact answer is their model's."""
    lines = [
        [row.question, row.method, row.options, row.error_rms, row.error_worst, _times(row)[0],
         "" if row.ok else f"{row.failed} x {row.status}"]
        for row in benchmark.rows if row.peer
    ]  # fmt: skip
    parts = []
    if lines:
        headings = ["question", "engine", "model", "rms", "worst", "one", "note"]
        parts.append(
            "other engines: difference of their models from the exact answer, no numerical error\n"
            + table(headings, lines, digits=2)
        )
    if benchmark.left_out:
        parts.append(f"other engines left out, not there: {', '.join(benchmark.left_out)}")
    return parts


def _end(text: str, benchmark: Benchmark) -> str:
    """Return a report, and why it is not complete if it is not."""
    if benchmark.complete:
        return text
    return f"{text}\n\nnot complete: {shared.say_why_incomplete(benchmark)}".lstrip()
