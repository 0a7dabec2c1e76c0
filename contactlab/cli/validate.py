"""Check laws against closed forms, experiments and finite elements.

Examples
--------
  contactlab validate
  contactlab validate --out pictures
  contactlab validate --measured --out pictures
  contactlab validate --json
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import attrs

from contactlab.cli import arguments as shared
from contactlab.cli import measured
from contactlab.outcome.columns import json_value
from contactlab.outcome.tables import heading
from contactlab.outcome.text_table import fill, table
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.study.evidence import Evidence, gather
from contactlab.study.validation import Finding, validate

#: Laws in a picture, if installed; more curves could not be distinguished.
DRAWN = (
    "fronts",
    *(f"springs, viscoelastic restitution={e}" for e in (0.98, 0.9)),
    "mindlin_cap",
    "coulomb",
)


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the outputs."""
    parser.add_argument(
        "--out",
        type=shared.folder_of,
        metavar="DIR",
        help="draw a picture of each source in this folder",
    )
    parser.add_argument(
        "--measured",
        action="store_true",
        help="compare every law with every row of the measured sets instead; takes minutes",
    )
    shared.add_json(parser, "the tables")
    shared.add_progress(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Validate and report; the status is 1 if a bound is not met; ``--measured`` has no bounds."""
    folder: Path | None = arguments.out
    if folder is not None:
        if not folder.parent.is_dir():
            raise ValueError(f"--out {folder}: there is no folder {folder.parent}")
        shared.make_folder(folder)
    if arguments.measured:
        return measured.execute(arguments)
    findings: list[Finding] = []
    gathered: list[Evidence] = []
    interrupted = False
    try:  # extend keeps the findings before an interruption
        with shared.progress(arguments.progress, "checks") as progress:
            findings.extend(validate(progress))
        with shared.progress(arguments.progress, "sources") as progress:
            gathered.extend(gather(curves=folder is not None, progress=progress))
    except KeyboardInterrupt:
        if not findings:
            raise
        interrupted = True
    findings += [finding for evidence in gathered for finding in evidence.findings()]
    saved = shared.OK
    if folder is not None:
        drawings = [
            (folder / f"{item.source.name}.png", lambda path, item=item: _draw(path, item))
            for item in gathered
        ]
        saved = shared.save(*drawings, progress_wanted=arguments.progress, interrupted=interrupted)
    if arguments.json:
        checks = [attrs.asdict(finding) | {"ok": finding.ok} for finding in findings]
        content = {
            "checks": json_value(checks),
            "sources": [_plain(item) for item in gathered],
            "complete": not interrupted,
        }
        shared.print_json(content)
    else:
        ending = ["not complete: interrupted"] if interrupted else []
        print("\n\n".join([_checks(findings), *map(_agreement, gathered), *ending]))
    if interrupted:
        return shared.INTERRUPTED
    return saved if all(finding.ok for finding in findings) else shared.FAILED


def _checks(findings: list[Finding]) -> str:
    """Return the findings as a table."""
    rows = [
        [item.what, item.against, item.difference, item.bound, "ok" if item.ok else "FAILS"]
        for item in findings
    ]
    return table(["what", "against", "worst difference", "bound", ""], rows, digits=2)


def _agreement(evidence: Evidence) -> str:
    """Return a source with its citation and notes, and the distance of every law from it."""
    agreements = evidence.comparison.agreements
    headings = ["law"]
    rows: list[list[Any]] = [[law] for law in evidence.laws]
    for agreement in agreements:
        name = heading(agreement.measured.quantity, agreement.unit)
        headings += [f"{name} rms", "largest", "at"]
        for row in rows:
            law = str(row[0])
            row += [agreement.rms(law), agreement.largest(law), agreement.where_largest(law)]
    scatters = [evidence.scatter(agreement) for agreement in agreements]
    if any(scatter == scatter for scatter in scatters):
        reading: list[Any] = ["(scatter of readings)"]
        for scatter in scatters:
            reading += [scatter, None, None]
        rows.append(reading)
    paragraphs = [
        f"{evidence.file.title} ({evidence.source.kind})",
        *(fill(text.strip()) for text in (evidence.file.citation, evidence.file.notes)),
        table(headings, rows, digits=3),
    ]
    return "\n".join(paragraphs)


def _plain(evidence: Evidence) -> dict[str, Any]:
    """Return a source and the distances of the laws from it for JSON."""
    return {
        "name": evidence.source.name,
        "kind": evidence.source.kind,
        "title": evidence.file.title,
        "citation": evidence.file.citation.strip(),
        "notes": evidence.file.notes.strip(),
        "left_out": dict(evidence.left_out),
        "series": [
            {
                "quantity": agreement.measured.quantity,
                "numbers": len(agreement.measured.values),
                "scatter": json_value(evidence.scatter(agreement)),
                "laws": {
                    law: {
                        "rms": json_value(agreement.rms(law)),
                        "largest": json_value(agreement.largest(law)),
                    }
                    for law in evidence.laws
                },
            }
            for agreement in evidence.comparison.agreements
        ],
    }


def _draw(path: Path, evidence: Evidence) -> None:
    """Draw the main laws over the values of one source."""
    from contactlab.cli.drawing import draw_comparison  # matplotlib only when drawing

    shown = evidence.comparison.only(DRAWN)
    quantities = [agreement.measured.quantity for agreement in shown.agreements]
    draw_comparison(path, shown, list(dict.fromkeys(quantities)))
