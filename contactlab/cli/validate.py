"""Check this installation against closed forms, reference values and an experiment.

Examples
--------
  contactlab validate
  contactlab validate --json
"""

from __future__ import annotations

import argparse
import json

import attrs

from contactlab.analysis.validation import validate
from contactlab.cli import arguments as shared
from contactlab.cli.table import table
from contactlab.plain import plain


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the outputs."""
    parser.add_argument("--json", action="store_true", help="print JSON instead of the table")
    shared.add_progress(parser)


def execute(arguments: argparse.Namespace) -> int:
    """Validate and report; 1 if a bound is not met."""
    findings = validate(shared.progress(arguments.progress, "checks"))
    if arguments.json:
        rows = [attrs.asdict(found) | {"ok": found.ok} for found in findings]
        print(json.dumps([{key: plain(value) for key, value in row.items()} for row in rows]))
    else:
        rows_shown = [
            [
                found.what,
                found.against,
                found.difference,
                found.bound,
                "ok" if found.ok else "FAILS",
            ]
            for found in findings
        ]
        headings = ["what", "against", "worst difference", "bound", ""]
        print(table(headings, rows_shown, digits=2))
    return shared.OK if all(found.ok for found in findings) else shared.FAILED
