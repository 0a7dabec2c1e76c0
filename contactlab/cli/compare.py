"""Run several laws on one scene or sweep: differences, cost, and measured values.

Examples
--------
  contactlab compare examples/kharaz2001.toml --figure kharaz.png
  contactlab compare examples/steel_ball.toml --tangential annulus,coulomb
  contactlab compare examples/sweep.toml --integrator paper,symplectic --csv > sweep.csv
"""

from __future__ import annotations

import argparse
import inspect
import itertools
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from contactlab.analysis.compare import Comparison, compare
from contactlab.analysis.compare_export import to_dict, write_csv
from contactlab.cli import arguments as shared
from contactlab.cli import side_by_side
from contactlab.quantities import quantity_named
from contactlab.registry import KINDS, REGISTRY
from contactlab.scene_file import LawChoice, SceneFile, read_scene
from contactlab.simulation import Simulation

#: Compared where nothing else is asked for: the paper's elastic law and the rigid one.
DEFAULT_LAWS = ["annulus", "coulomb"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the scene, the laws, the quantities and the outputs."""
    parser.add_argument("scene", metavar="SCENE.toml", help="a scene or a sweep")
    shared.add_laws(parser, many=True)
    parser.add_argument(
        "--quantity",
        type=shared.names,
        metavar="A,B,...",
        help="what to compare (default: what was measured, or psi2)",
    )
    parser.add_argument(
        "--figure",
        type=shared.file_of(*shared.PICTURES),
        metavar="FILE",
        help="also draw the comparison",
    )
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print JSON instead of tables")
    form.add_argument("--csv", action="store_true", help="print CSV instead of tables")
    shared.add_progress(parser)


def execute(arguments: argparse.Namespace) -> int:
    """Compare and report; 1 if a law did not follow every impact."""
    for quantity in arguments.quantity or ():
        quantity_named(quantity, where="--quantity")
    file = read_scene(arguments.scene)
    simulations = _simulations(arguments, file)
    comparison = compare(
        file,
        simulations,
        history=bool(arguments.figure),
        progress=shared.progress(arguments.progress, "runs"),
    )
    quantities = arguments.quantity or side_by_side.default_quantities(comparison)
    saved = shared.save((arguments.figure, lambda path: _draw(path, comparison, quantities)))
    if arguments.json:
        content = to_dict(comparison, quantities) | {"title": file.title}
        print(json.dumps(content, indent=2, allow_nan=False))
    elif arguments.csv:
        write_csv(comparison, quantities, sys.stdout)
    else:
        print(side_by_side.describe(comparison, quantities, file))
    failures = comparison.failures()
    for sentence in failures:
        print(f"contactlab compare: failed: {sentence}", file=sys.stderr)
    return shared.FAILED if failures else saved


def _draw(path: Path, comparison: Comparison, quantities: Sequence[str]) -> None:
    from contactlab.cli.drawing import draw_comparison  # matplotlib only when drawing

    draw_comparison(path, comparison, quantities)


def _simulations(arguments: argparse.Namespace, file: SceneFile) -> dict[str, Simulation]:
    """Return every combination of the laws asked for, named by what differs between them."""
    asked = {kind: getattr(arguments, kind) or [getattr(file.laws, kind)] for kind in KINDS}
    if arguments.tangential is None:
        own = file.laws.resolved().tangential
        asked["tangential"] = list(dict.fromkeys([own, *DEFAULT_LAWS]))
    asked = {
        kind: [name and name.removeprefix(f"{kind}.") for name in names]
        for kind, names in asked.items()
    }
    several = [kind for kind in KINDS if len(asked[kind]) > 1] or ["tangential"]
    simulations = {}
    used: set[str] = set()
    for combination in itertools.product(*asked.values()):
        chosen = dict(zip(KINDS, combination, strict=True))
        choice = file.laws.choose(**chosen).resolved()
        settings = {path: value for path, value in arguments.settings if _knows(choice, path, used)}
        name = " + ".join(getattr(choice, kind) for kind in several)
        simulations[name] = choice.set(settings).simulation()
    for path, _ in arguments.settings:
        if path not in used:
            raise ValueError(f"--set {path}: none of the laws compared has this option")
    return simulations


def _knows(choice: LawChoice, path: str, used: set[str]) -> bool:
    """Return True if the option is one of the chosen laws', and note that it was used."""
    owner, _, option = path.rpartition(".")
    kind, _, name = owner.partition(".")
    if kind not in KINDS:
        used.add(path)
        return True  # let the choice refuse it, with the remedy
    chosen: Any = getattr(choice, kind)
    if name not in ("", chosen):
        return False
    known = option in inspect.signature(REGISTRY.law_class(f"{kind}.{chosen}")).parameters
    used.update([path] if known else [])
    return known
