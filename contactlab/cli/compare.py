"""Run several laws on one scene or sweep: differences, cost, and measured values.

With --all every installed friction law that fits is run, each under the integrator that suits it,
and gets one row: its distance from the exact law, energy made from nothing, force from normal load
alone, cost. Without a scene that is a solid sphere hit at 65 angles.

Examples
--------
  contactlab compare --all --figure laws.png
  contactlab compare examples/kharaz2001.toml --figure kharaz.png
  contactlab compare examples/steel_ball.toml --tangential annulus,coulomb
  contactlab compare --psi1 0:6:13 --chi 1.18 --tangential fronts,stronge,coulomb
  contactlab compare examples/sweep.toml --integrator paper,symplectic --csv > sweep.csv
"""

from __future__ import annotations

import argparse
import inspect
import itertools
import json
import sys
from pathlib import Path

import numpy as np

from contactlab.cli import arguments as shared
from contactlab.cli import side_by_side
from contactlab.cli.scene import add_ranges, check_alone
from contactlab.compose.names import KINDS, full_name, kind_of, short_name
from contactlab.compose.registry import REGISTRY
from contactlab.compose.simulation import Simulation
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import nearest
from contactlab.outcome.columns import quantity_named
from contactlab.scene_file import LawChoice, SceneFile, read_scene
from contactlab.scene_file.laws import same_law
from contactlab.study.compare import Comparison, compare
from contactlab.study.compare_export import plain_score, to_dict, write_csv
from contactlab.study.scores import DEFAULT_SCENE, candidates, scores

#: Compared where nothing else is asked for: the paper's elastic law and the rigid one.
DEFAULT_LAWS = ["annulus", "coulomb"]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the scene, the laws, the quantities and the outputs."""
    parser.add_argument(
        "scene",
        metavar="SCENE.toml",
        nargs="?",
        help="a scene or a sweep (default: psi2 over psi1 of a solid sphere, chi = 49/34)",
    )
    add_ranges(parser)
    parser.add_argument(
        "--all",
        action="store_true",
        help="every installed tangential law that fits, one row a law",
    )
    shared.add_laws(parser, many=True)
    parser.add_argument(
        "--quantity",
        type=shared.names,
        metavar="A,B,...",
        help="what to compare (default: what was measured, or psi2)",
    )
    shared.add_figure(parser, "also draw the comparison")
    parser.add_argument(
        "--estimate-error",
        action="store_true",
        help="estimate the numerical error of each law for the figure's bands (--all always does)",
    )
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print JSON instead of tables")
    form.add_argument("--csv", action="store_true", help="print CSV instead of tables")
    shared.add_progress(parser)


def execute(arguments: argparse.Namespace) -> int:
    """Compare and report; 1 if a law did not follow every impact."""
    for quantity in arguments.quantity or ():
        quantity_named(quantity, where="--quantity")
    file = _file(arguments)
    if arguments.all:
        compared = _all(arguments, file)
    else:
        own = file.laws.resolved().tangential
        arguments.tangential = arguments.tangential or list(dict.fromkeys([own, *DEFAULT_LAWS]))
        compared = simulations(arguments, file.laws)
    with shared.progress(arguments.progress, "runs") as progress:
        comparison = compare(
            file,
            compared,
            history=bool(arguments.figure) and not arguments.all,
            estimate_error=arguments.estimate_error or arguments.all,
            progress=progress,
        )
    quantities = arguments.quantity or side_by_side.default_quantities(comparison)
    saved = shared.save(
        (arguments.figure, lambda path: _draw(path, arguments, comparison)),
        progress_wanted=arguments.progress,
    )
    if arguments.json:
        content = to_dict(comparison, quantities) | {"title": file.title}
        content["complete"] = not comparison.interrupted
        if arguments.all:
            found = scores(comparison, compared)
            content["scores"] = [plain_score(score) for score in found]
        print(json.dumps(content, indent=2, allow_nan=False))
    elif arguments.csv:
        write_csv(comparison, quantities, sys.stdout)
    elif arguments.all:
        found = scores(comparison, compared)
        print(side_by_side.describe_scores(found, comparison, file))
    else:
        print(side_by_side.describe(comparison, quantities, file))
    failures = comparison.failures()
    for sentence in failures:
        print(f"contactlab compare: failed: {sentence}", file=sys.stderr)
    if comparison.interrupted:
        left = ", ".join(name for name in compared if name not in comparison.names)
        print(f"contactlab compare: interrupted: not compared: {left}", file=sys.stderr)
        return shared.INTERRUPTED
    return shared.FAILED if failures else saved


def _file(arguments: argparse.Namespace) -> SceneFile:
    """Return the scene file, or what stands in place of one: psi1 and chi."""
    given = {name: getattr(arguments, name) for name in ("psi1", "chi")}
    varied = {name: value for name, value in given.items() if np.ndim(value)}
    missing = [f"--{name}" for name, value in given.items() if value is None]
    if len(missing) == len(given):
        return read_scene(arguments.scene or DEFAULT_SCENE)
    check_alone(arguments)
    if missing:
        raise ValueError(f"{missing[0]}: must be given too (chi is 1.4412 for a solid sphere)")
    if len(varied) > 1:
        raise ValueError("--psi1, --chi: one of them may be a range; give the other one number")
    return SceneFile(
        path=Path("--psi1, --chi"),
        title="",
        citation="",
        notes="",
        scene=Scene.nondimensional(**given),
        varied=varied,
        laws=LawChoice(),
        encounter=None,
        measured=(),
        tables={},
    )


def _draw(path: Path, arguments: argparse.Namespace, comparison: Comparison) -> None:
    from contactlab.cli.drawing import draw_all, draw_comparison  # matplotlib only when drawing

    quantities = arguments.quantity or side_by_side.default_quantities(comparison)
    if arguments.all:
        draw_all(path, comparison, quantities[0], **shared.look(arguments))
    else:
        draw_comparison(path, comparison, quantities, **shared.look(arguments))


def _all(arguments: argparse.Namespace, file: SceneFile) -> dict[str, Simulation]:
    """Return every law that fits, and say on stderr which do not.

    Raises
    ------
    ValueError
        With laws that were asked for beside all, or a file of a single impact.
    """
    if arguments.tangential or arguments.integrator or (arguments.normal and arguments.normal[1:]):
        raise ValueError(
            "--all takes every tangential law, each under its integrator; leave out --tangential "
            "and --integrator, and name one normal law at most"
        )
    for path, _ in arguments.settings:
        if path.count(".") < 2 and kind_of(path) != "normal":
            example = "--set integrator.symplectic.steps=400"
            raise ValueError(f"--set {path}: with --all say of which law, such as {example}")
    if not file.scene.shape:
        raise ValueError(
            f"{file.path}: --all compares over a sweep; a file needs [sweep], and "
            "--psi1 a range START:STOP:COUNT"
        )
    chosen = file.laws.choose(normal=arguments.normal[0] if arguments.normal else None)
    found = candidates(chosen.set(dict(arguments.settings)))
    for name, reason in found.left_out.items():
        print(f"contactlab compare: {name} is left out: {reason}", file=sys.stderr)
    return found.simulations


def simulations(arguments: argparse.Namespace, laws: LawChoice) -> dict[str, Simulation]:
    """Return every combination of the laws asked for, named by what differs between them.

    ``laws`` says which where the arguments do not. Its integrator is taken for the laws that it
    runs, another that suits for the others.
    """
    asked = {kind: getattr(arguments, kind) or [getattr(laws, kind)] for kind in KINDS}
    asked = {
        kind: [name and short_name(full_name(kind, name)) for name in names]
        for kind, names in asked.items()
    }
    several = [kind for kind in KINDS if len(asked[kind]) > 1] or ["tangential"]
    found = {}
    used: set[str] = set()
    offered: set[str] = set()
    for combination in itertools.product(*asked.values()):
        chosen = dict(zip(KINDS, combination, strict=True))
        choice = laws.choose(**chosen)
        choice = (choice if arguments.integrator else choice.suited()).resolved()
        settings = {
            path: value for path, value in arguments.settings if _knows(choice, path, used, offered)
        }
        name = " + ".join(getattr(choice, kind) for kind in several)
        found[name] = choice.set(settings).simulation()
    for path, _ in arguments.settings:
        if path not in used:
            raise ValueError(
                f"--set {path}: none of the laws asked for has this option; "
                f"{nearest(path, offered)}they have {', '.join(sorted(offered)) or 'none'}"
            )
    return found


def _knows(choice: LawChoice, path: str, used: set[str], offered: set[str]) -> bool:
    """Return True if the option is one of the chosen laws', and note that it was used.

    Parameters
    ----------
    choice : LawChoice
    path : str
        As it was given: ``tangential.springs``, or ``tangential.annulus.annuli`` for one law.
    used : set of str
        Paths that some law takes; added to.
    offered : set of str
        Paths that the laws would take; added to.
    """
    owner, _, option = path.rpartition(".")
    kind = kind_of(owner)
    if kind not in KINDS:
        used.add(path)
        return True  # let the choice refuse it, with the remedy
    chosen = full_name(kind, getattr(choice, kind))
    options = inspect.signature(REGISTRY.law_class(chosen)).parameters
    offered.update(f"{kind}.{each}" for each in options)
    if owner != kind and not same_law(owner, chosen):
        return False
    known = option in options
    used.update([path] if known else [])
    return known
