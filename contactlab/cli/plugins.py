"""List plug-ins, show one, or check one against its contract.

Examples
--------
  contactlab plugins list
  contactlab plugins show tangential.annulus --json
  contactlab plugins list --kind materials
  contactlab plugins check tangential.coulomb
"""

from __future__ import annotations

import argparse
import inspect
import sys
import textwrap
from collections import Counter
from collections.abc import Mapping
from typing import Any

from contactlab.cli.arguments import FAILED, OK, add_progress, add_time_limit, print_json, progress
from contactlab.contracts import Integrator, Law, PathTangentialLaw, Scene, TangentialLaw
from contactlab.numeric.checks import refuse
from contactlab.numeric.names import nearest
from contactlab.outcome.text_table import WIDTH, table
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.registration.installed import clashes
from contactlab.registration.manager import MANAGER, RANK
from contactlab.registration.names import (
    BLOCK_VARIABLE,
    COLLECTIONS,
    COMMAND,
    clash,
    kind_of,
    resolve_name,
    same_distribution,
    split_name,
)
from contactlab.registry.options import Option, options
from contactlab.registry.registry import REGISTRY, PluginInfo


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add ``list``, ``show NAME`` and ``check NAME``."""
    actions = parser.add_subparsers(dest="action", metavar="list|show|check", required=True)
    listing = actions.add_parser("list", help="list name, kind, distribution and version of all")
    show = actions.add_parser("show", help="describe a law and its options, or another plug-in")
    check = actions.add_parser(
        "check", help="check a plug-in against its contract; exit 1 if it fails"
    )
    listing.add_argument(
        "--kind", choices=tuple(RANK), metavar="KIND", help=f"one of {', '.join(RANK)}"
    )
    for action in (show, check):
        action.add_argument(
            "name", metavar="NAME", help="such as tangential.annulus, or my_law.py:Stribeck"
        )
    add_time_limit(
        check,
        "of each check (default 60); after three checks that exceed the limit, checking stops",
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
    laws = REGISTRY.installed()  # with laws registered at run time
    infos = [*laws, *(info for info in MANAGER.installed() if info not in laws)]
    infos = sorted(infos, key=lambda info: (RANK.get(info.kind, len(RANK)), info.name))
    entries = [_entry(info) for info in infos if arguments.kind in (None, info.kind)]
    for sentence in (*clashes(laws), *clashes(MANAGER.installed(COMMAND))):
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


def _no_law(name: str) -> PluginInfo | None:
    """Return the plug-in of a name that is no law, or None."""
    kind = kind_of(name)
    if kind not in (COMMAND, *COLLECTIONS):
        return None
    distribution, plain = split_name(name)
    found = [info for info in MANAGER.installed(kind) if info.name == plain]
    if distribution:
        found = [info for info in found if same_distribution(info.distribution, distribution)]
    if not found:
        known = [info.name for info in MANAGER.installed(kind)]
        hint = nearest(plain, known)
        raise refuse(
            "name", name, "no such plug-in is installed", f"{hint}installed: {', '.join(known)}"
        )
    if all(info.blocked for info in found):
        raise refuse("name", name, f"is blocked by {BLOCK_VARIABLE}", "unset it to use the plug-in")
    free = [info for info in found if not info.blocked]
    if (one := resolve_name(free)) is None:
        raise ValueError(clash(free))
    return one


def _show_other(info: PluginInfo, *, as_json: bool) -> int:
    """Print the origin and the content of a plug-in that is no law."""
    from contactlab.cli.brought import items, title

    entry = _entry(info)
    names = [] if info.kind == COMMAND else [title(told.item) for told in items(info)]
    if as_json:
        print_json(entry | {"brings": names})
        return OK
    _print_entry(entry)
    if names:
        print("\nbrings")
        print(_indent(", ".join(names), "  "), end="")
    return OK


def _check_other(info: PluginInfo, *, as_json: bool) -> int:
    """Check the content of a plug-in that is no law."""
    from contactlab.cli.brought import check

    rows = [
        (each.name, "failed" if each.complaint else "passed", each.complaint)
        for each in check(info)
    ]
    good = not any(complaint for *_, complaint in rows)
    _print_checks(info.name, rows, good, heading=info.kind, as_json=as_json)
    return OK if good else FAILED


def _print_checks(
    name: str, rows: list[tuple[str, str, str]], good: bool, *, heading: str, as_json: bool
) -> None:
    """Print the outcomes of checks: what was checked, its outcome, a sentence."""
    if as_json:
        keys = ("check", "outcome", "sentence")
        checks = [dict(zip(keys, row, strict=True)) for row in rows]
        print_json({"name": name, "good": good, "checks": checks})
    else:
        print(table((heading, "outcome", "sentence"), rows))


def _show(arguments: argparse.Namespace) -> int:
    """Print origin, contract and options of a law; only this action imports the law."""
    if (other := _no_law(arguments.name)) is not None:
        return _show_other(other, as_json=arguments.json)
    from contactlab.registry.citations import references
    from contactlab.registry.composition import WAYS

    entry = _entry(REGISTRY.info(arguments.name))
    law = REGISTRY.law_class(arguments.name)
    entry["summary"] = (inspect.getdoc(law) or "").partition("\n")[0]
    if issubclass(law, Integrator):
        runs = [need.__name__ for need in law.needs if isinstance(need, type)]
        entry["runs"] = ", ".join(sorted(runs))
    if issubclass(law, TangentialLaw):
        entry["is a"] = [way.__name__ for way in WAYS if issubclass(law, way)]
    if issubclass(law, PathTangentialLaw):
        scene = Scene.nondimensional(psi1=1.0, chi=1.0)
        if solver := REGISTRY.create(arguments.name).cost(scene, None).solver:
            entry["solver"] = solver
    entry["needs"] = sorted(need for need in law.needs if isinstance(need, str))
    entry["offers"] = sorted(law.offers)
    if law.waives is not Law.waives:
        entry["waives"] = "some of these words, by options"
    accepted, sources = options(law), references(law)
    if arguments.json:
        details = {"options": [option.to_dict() for option in accepted], "references": sources}
        print_json(entry | details)
        return OK
    _print_entry(entry)
    print("\noptions" if accepted else "\noptions: none")
    for option in accepted:
        print(f"  {_with_unit(option)}")
        for words in (option.meaning, option.rule):
            print(_indent(words, "      "), end="")
    if sources:
        print("\nsource")
    for source in sources:
        print(_indent(source, "  "), end="")
    return OK


def _print_entry(entry: Mapping[str, object]) -> None:
    """Print a line for each key of an entry."""
    width = max(map(len, entry))
    for key, value in entry.items():
        text = (", ".join(value) or "none") if isinstance(value, list) else value
        print(f"{key.ljust(width)}  {text}")


def _with_unit(option: Option) -> str:
    """Return an option with its default and unit as text."""
    return f"{option} ({option.unit})" if option.unit not in ("", "1") else str(option)


def _indent(words: str, margin: str) -> str:
    """Return words wrapped to the terminal's width, each line with its end."""
    lines = textwrap.wrap(
        words.replace("``", ""), WIDTH, initial_indent=margin, subsequent_indent=margin,
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip
    return "".join(f"{line}\n" for line in lines)


def _check(arguments: argparse.Namespace) -> int:
    """Check a law against its contract; only this action imports the conformance kit."""
    if (other := _no_law(arguments.name)) is not None:
        return _check_other(other, as_json=arguments.json)
    from contactlab.testing import examine
    from contactlab.testing.limits import SECONDS
    from contactlab.testing.outcomes import REMEDY

    seconds = SECONDS if arguments.time_limit is None else arguments.time_limit
    with progress(arguments.progress, f"checking {arguments.name}") as counted:
        outcomes = examine(arguments.name, progress=counted, seconds=seconds)
    good = all(outcome.verdict.good for outcome in outcomes)
    rows = [(outcome.check, outcome.verdict.value, outcome.sentence) for outcome in outcomes]
    _print_checks(arguments.name, rows, good, heading="check", as_json=arguments.json)
    if not arguments.json:
        counts = Counter(outcome.verdict.value for outcome in outcomes)
        print(", ".join(f"{count} {verdict}" for verdict, count in counts.items()))
        if not good:
            print(REMEDY)
    return OK if good else FAILED


def _entry(info: PluginInfo) -> dict[str, Any]:
    """Return the entry of a law in the JSON."""
    names = (
        "name", "known_as", "kind", "distribution", "version", "module", "blocked", "malformed",
    )  # fmt: skip
    return {name: getattr(info, name) for name in names}
