"""List the installed laws, or show one, without importing any.

Examples
--------
  contactlab plugins list
  contactlab plugins show tangential.annulus --json
"""

from __future__ import annotations

import argparse
import json

from contactlab.cli.table import table
from contactlab.registry import REGISTRY, PluginInfo


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add ``list`` and ``show NAME``."""
    actions = parser.add_subparsers(dest="action", metavar="list|show", required=True)
    listing = actions.add_parser("list", help="name, kind, distribution and version of every law")
    show = actions.add_parser("show", help="the same of one law, and the module it comes from")
    show.add_argument("name", metavar="NAME", help="such as tangential.annulus")
    for action in (listing, show):
        action.add_argument("--json", action="store_true", help="print JSON")


def execute(arguments: argparse.Namespace) -> int:
    """Print what the entry points say."""
    if arguments.action == "show":
        entry = _entry(REGISTRY.info(arguments.name))
        width = max(map(len, entry))
        text = "\n".join(f"{key.ljust(width)}  {value}" for key, value in entry.items())
        print(json.dumps(entry, indent=2) if arguments.json else text)
        return 0
    entries = [_entry(info) for info in REGISTRY.installed()]
    if arguments.json:
        print(json.dumps(entries, indent=2))
        return 0
    keys = ("name", "kind", "distribution", "version")
    rows = [[entry[key] for key in keys] for entry in entries]
    for row, entry in zip(rows, entries, strict=True):
        row[0] = f"{row[0]} (blocked)" if entry["blocked"] else row[0]
    print(table(keys, rows))
    return 0


def _entry(info: PluginInfo) -> dict[str, str | bool]:
    return {
        "name": info.name,
        "kind": info.kind,
        "distribution": info.distribution,
        "version": info.version,
        "module": info.module,
        "blocked": info.blocked,
    }
