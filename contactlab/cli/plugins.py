"""List the installed laws, show a law, or check a law against its contract.

Examples
--------
  contactlab plugins list
  contactlab plugins show tangential.annulus --json
  contactlab plugins check tangential.coulomb
"""

from __future__ import annotations

import argparse
import inspect
import sys
import textwrap
from collections import Counter
from typing import Any

from contactlab.cli.arguments import FAILED, OK, add_progress, finite, print_json, progress
from contactlab.compose.hooks import Execute, hookimpl
from contactlab.compose.options import Option, options
from contactlab.compose.registry import REGISTRY, PluginInfo
from contactlab.contracts import Integrator, PathTangentialLaw, Scene, TangentialLaw
from contactlab.numeric.checks import POSITIVE, real
from contactlab.outcome.text_table import WIDTH, table


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add ``list``, ``show NAME`` and ``check NAME``."""
    actions = parser.add_subparsers(dest="action", metavar="list|show|check", required=True)
    listing = actions.add_parser("list", help="name, kind, distribution and version of every law")
    show = actions.add_parser("show", help="description and options of a law")
    check = actions.add_parser("check", help="check a law against its contract; exit 1 if it fails")
    for action in (show, check):
        action.add_argument(
            "name", metavar="NAME", help="such as tangential.annulus, or my_law.py:Stribeck"
        )
    check.add_argument(
        "--seconds",
        type=finite,
        metavar="S",
        help="time limit of each check, and of the import (default 60); after three checks out of "
        "time the others are not tried",
    )
    add_progress(check)
    for action in (listing, show, check):
        action.add_argument("--json", action="store_true", help="print JSON")
    return execute


def execute(arguments: argparse.Namespace) -> int:
    """Print the list of laws, one law, or the outcomes of its checks."""
    if arguments.action == "check":
        return _check(arguments)
    if arguments.action == "show":
        return _show(arguments)
    entries = [_entry(info) for info in REGISTRY.installed()]
    for sentence in REGISTRY.clashes():
        print(f"contactlab: warning: {sentence}", file=sys.stderr)
    if arguments.json:
        print_json(entries)
        return OK
    keys = ("name", "kind", "distribution", "version")
    rows = [[str(entry[key]) for key in keys] for entry in entries]
    for row, entry in zip(rows, entries, strict=True):
        row[0] = str(entry["known_as"])
        for word in ("blocked", "malformed"):
            row[0] += f" ({word})" if entry[word] else ""
    print(table(keys, rows))
    return OK


def _show(arguments: argparse.Namespace) -> int:
    """Print origin, contract and options of a law; only this action imports the law."""
    from contactlab.compose.citations import references
    from contactlab.compose.composition import WAYS

    entry: dict[str, Any] = _entry(REGISTRY.info(arguments.name))
    law = REGISTRY.law_class(arguments.name)
    entry["summary"] = (inspect.getdoc(law) or "").partition("\n")[0]
    if issubclass(law, Integrator):
        entry["runs"] = ", ".join(sorted(each.__name__ for each in law.needs))
    if issubclass(law, TangentialLaw):
        entry["is a"] = [way.__name__ for way in WAYS if issubclass(law, way)]
    made = REGISTRY.create(arguments.name)  # claims may depend on parameters
    if isinstance(made, PathTangentialLaw):
        scene = Scene.nondimensional(psi1=1.0, chi=1.0)
        if solver := made.cost(scene, None).solver:
            entry["solver"] = solver
    needed = {each for each in made.needs if isinstance(each, str)}
    entry["needs"], entry["offers"] = sorted(needed), sorted(made.offers)
    accepted, sources = options(law), references(law)
    if arguments.json:
        details = {"options": [option.to_dict() for option in accepted], "references": sources}
        print_json(entry | details)
        return OK
    width = max(map(len, entry))
    for key, value in entry.items():
        text = (", ".join(value) or "none") if isinstance(value, list) else value
        print(f"{key.ljust(width)}  {text}")
    print("\noptions" if accepted else "\noptions: none")
    for option in accepted:
        print(f"  {_with_unit(option)}")
        for words in (option.meaning, option.rule):
            print(_indented(words, "      "), end="")
    if sources:
        print("\nsource")
    for source in sources:
        print(_indented(source, "  "), end="")
    return OK


def _with_unit(option: Option) -> str:
    """Return an option with its default and unit as text."""
    return f"{option} ({option.unit})" if option.unit not in ("", "1") else str(option)


def _indented(words: str, margin: str) -> str:
    """Return words wrapped to the terminal's width, each line with its end."""
    lines = textwrap.wrap(
        words.replace("``", ""), WIDTH, initial_indent=margin, subsequent_indent=margin,
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip
    return "".join(f"{line}\n" for line in lines)


def _check(arguments: argparse.Namespace) -> int:
    """Check a law against its contract; only this action imports the conformance kit."""
    from contactlab.testing import examine
    from contactlab.testing.limits import SECONDS
    from contactlab.testing.outcomes import REMEDY

    limit = SECONDS if arguments.seconds is None else arguments.seconds
    seconds = float(real("--seconds", limit, rule=POSITIVE, remedy="in s"))
    with progress(arguments.progress, f"checking {arguments.name}") as counted:
        outcomes = examine(arguments.name, progress=counted, seconds=seconds)
    failures = [outcome for outcome in outcomes if not outcome.verdict.good]
    if arguments.json:
        entries = [
            {"check": outcome.check, "outcome": outcome.verdict.value, "sentence": outcome.sentence}
            for outcome in outcomes
        ]
        print_json({"name": arguments.name, "good": not failures, "checks": entries})
    else:
        rows = [(outcome.check, outcome.verdict.value, outcome.sentence) for outcome in outcomes]
        print(table(("check", "outcome", "sentence"), rows))
        counts = Counter(outcome.verdict.value for outcome in outcomes)
        print(", ".join(f"{count} {verdict}" for verdict, count in counts.items()))
        if failures:
            print(REMEDY)
    return FAILED if failures else OK


def _entry(info: PluginInfo) -> dict[str, str | bool]:
    """Return the entry of a law in the JSON."""
    names = (
        "name", "known_as", "kind", "distribution", "version", "module", "blocked", "malformed",
    )  # fmt: skip
    return {name: getattr(info, name) for name in names}
