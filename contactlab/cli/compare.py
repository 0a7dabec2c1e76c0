"""Run several laws on one scene: differences, cost, measured values.

With --all every installed friction law that fits is run, each under the integrator that suits it,
and has one row: distance from the exact law, energy from nothing, force from load alone, cost.
The default scene is the impact of a solid sphere at 65 angles.

Examples
--------
  contactlab compare --all --figure laws.png
  contactlab compare examples/kharaz2001.toml --figure kharaz.png
  contactlab compare examples/steel_ball.toml --tangential annulus,coulomb
  contactlab compare --psi1 0:6:13 --chi 1.18 --tangential fronts,stronge,coulomb
  contactlab compare examples/sweep.toml --integrator paper,symplectic --csv > sweep.csv
  contactlab compare examples/steel_ball.toml --tangential springs,mindlin_cap --loops loops.png
"""

from __future__ import annotations

import argparse
import inspect
import itertools
import sys
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

import attrs
import numpy as np

from contactlab.cli import arguments as shared
from contactlab.cli.scene import (
    add_file,
    add_groups,
    check_alone,
    read,
    settle_chi,
    with_restitution,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.names import nearest
from contactlab.numeric.types import Json
from contactlab.outcome.columns import find_quantity, json_value
from contactlab.registration.hooks import Execute, hookimpl
from contactlab.registration.names import KINDS, full_name, kind_of
from contactlab.registry.composition import ON_A_PATH
from contactlab.registry.registry import REGISTRY
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import LawChoice, SceneFile, read_scene
from contactlab.scene_file.laws import same_law
from contactlab.solve.solve import accept_scene
from contactlab.study import side_by_side
from contactlab.study.comparison import Comparison, compare
from contactlab.study.loops import loops
from contactlab.study.scores import (
    DEFAULT_SCENE,
    candidates,
    describe_scores,
    scores,
    write_csv,
)

#: Default laws: the exact elastic law and Coulomb's law for rigid bodies.
DEFAULT_LAWS = ["fronts", "coulomb"]


@hookimpl
def contactlab_command(parser: argparse.ArgumentParser) -> Execute:
    """Add the scene, the laws, the quantities and the outputs."""
    add_file(parser, "a scene or a sweep (default: psi2 over psi1 of a solid sphere, chi = 49/34)")
    add_groups(parser)
    words = "every installed tangential law that fits, one row a law"
    parser.add_argument("--all", action="store_true", help=words)
    shared.add_laws(parser, many=True)
    words = "quantities to compare (default: the measured quantities, or psi2)"
    shared.add_names(parser, "--quantity", words)
    shared.add_figure(parser, "also draw the comparison")
    words = "also draw friction force over displacement, at constant and at oscillating load"
    shared.add_file(parser, "--loops", *shared.PICTURES, words=words)
    parser.add_argument(
        "--estimate-error",
        action="store_true",
        help="estimate the numerical error of each law for the figure's bands (--all always does)",
    )
    shared.add_file(parser, "--out", ".csv", ".json", words="also write .csv or .json")
    shared.add_forms(parser, "tables")
    shared.add_progress(parser)
    return shared.check_outputs_first(execute)


def execute(arguments: argparse.Namespace) -> int:
    """Compare and report; the status is 1 if a law failed in an impact."""
    for quantity in arguments.quantity or ():
        find_quantity(quantity, where="--quantity")
    file = shared.scene_file(arguments, partial(_file, arguments))
    file = attrs.evolve(file, laws=with_restitution(arguments, file.laws))
    named = bool(arguments.tangential)
    if arguments.all:
        compared = _all(arguments, file)
    elif named:
        compared = simulations(arguments, file.laws)
    else:
        own = own_laws(arguments, file.laws, file.scene)
        stepped = [ON_A_PATH] if arguments.loops else []
        defaults = list(dict.fromkeys([*own, *stepped, *DEFAULT_LAWS]))
        compared = simulations(arguments, file.laws, defaults)
    compared = _answering(file.scene, compared, told=named or arguments.all)
    with shared.progress(arguments.progress, "runs") as progress:
        comparison = compare(
            file,
            compared,
            history=bool(arguments.figure) and not arguments.all,
            estimate_error=arguments.estimate_error or arguments.all,
            progress=progress,
        )
    quantities = arguments.quantity or side_by_side.default_quantities(comparison)
    scored = arguments.all and bool(file.scene.shape)

    def content() -> dict[str, Json]:
        whole = comparison.to_dict(quantities) | {"title": file.title}
        whole["complete"] = not comparison.interrupted
        if scored:
            whole["scores"] = json_value(scores(comparison, compared))
        return whole

    def text() -> str:
        if scored:
            return describe_scores(scores(comparison, compared), comparison, file)
        return side_by_side.describe(comparison, quantities, file)

    saved = shared.report(
        arguments,
        (arguments.figure, lambda path: _draw(path, arguments, comparison, quantities)),
        (arguments.loops, lambda path: _draw_loops(path, arguments, file.scene, compared)),
        content=content,
        to_csv=lambda stream: write_csv(comparison, quantities, stream),
        text=text,
        interrupted=comparison.interrupted,
    )
    if arguments.json or arguments.csv or arguments.all:  # these show no plan
        shared.tell_normal_spin(file.scene, *compared.values())
    failures = comparison.failures()
    for sentence in failures:
        print(f"contactlab compare: failed: {sentence}", file=sys.stderr)
    if comparison.interrupted:
        left = ", ".join(name for name in compared if name not in comparison.names)
        print(f"contactlab compare: interrupted: not compared: {left}", file=sys.stderr)
        return shared.INTERRUPTED
    return shared.FAILED if failures else saved


def _answering(
    scene: Scene, compared: dict[str, Simulation], *, told: bool
) -> dict[str, Simulation]:
    """Return the simulations that have an answer; report the others on stderr if ``told``."""
    answering, refused = {}, None
    reasons: dict[str, list[str]] = {}
    for name, simulation in compared.items():
        try:
            accept_scene(simulation.laws, scene)
            answering[name] = simulation
        except ValueError as error:
            refused = error
            reasons.setdefault(str(error).partition(": ")[2], []).append(name)
    for reason, names in reasons.items() if told else ():
        are = "is" if len(names) == 1 else "are"
        if are == "are" and reason.startswith("has "):
            reason = f"each {reason}"
        print(f"contactlab compare: {', '.join(names)} {are} left out: {reason}", file=sys.stderr)
    if not answering and refused is not None:
        raise refused
    return answering


def _file(arguments: argparse.Namespace, defaults: Mapping[str, float] | None) -> SceneFile:
    """Return the scene file, the default one, or a nameless one from psi1 and chi."""
    settle_chi(arguments)
    parameters = {name: getattr(arguments, name) for name in ("psi1", "chi")}
    varied = {name: value for name, value in parameters.items() if np.ndim(value)}
    missing = [f"--{name}" for name, value in parameters.items() if value is None]
    if len(missing) == len(parameters):
        return read(arguments, defaults) or read_scene(DEFAULT_SCENE)
    check_alone(arguments)
    if missing:
        raise ValueError(f"{missing[0]}: must be given too (chi is 1.4412 for a solid sphere)")
    if len(varied) > 1:
        raise ValueError("--psi1, --chi: only one may be a range; give one number for the other")
    scene = Scene.nondimensional(**parameters)
    return SceneFile(path=Path("--psi1, --chi"), scene=scene, varied=varied)


def _draw(
    path: Path,
    arguments: argparse.Namespace,
    comparison: Comparison,
    quantities: Sequence[str],
) -> None:
    """Draw the comparison, or all laws."""
    from contactlab.cli.drawing import draw_all, draw_comparison  # matplotlib only when drawing

    if arguments.all and comparison.scene.shape:
        draw_all(path, comparison, quantities[0], **shared.look(arguments))
    else:
        draw_comparison(path, comparison, quantities, **shared.look(arguments))


def _draw_loops(
    path: Path, arguments: argparse.Namespace, scene: Scene, compared: dict[str, Simulation]
) -> None:
    """Draw hysteresis loops of the laws that have some; name the others on stderr."""
    from contactlab.cli.drawing import draw_load_paths  # matplotlib only when drawing

    paths = loops(scene, compared)
    for name, reason in paths.left_out.items():
        print(f"contactlab compare: --loops: {name} is left out: {reason}", file=sys.stderr)
    draw_load_paths(path, paths, **shared.look(arguments))


def _all(arguments: argparse.Namespace, file: SceneFile) -> dict[str, Simulation]:
    """Return the simulations of all laws that fit; report the others on stderr."""
    if arguments.tangential or arguments.integrator or (arguments.normal and arguments.normal[1:]):
        raise ValueError(
            "--all runs every tangential law with its own integrator; leave out --tangential and "
            "--integrator, and name at most one normal law"
        )
    for path, _ in arguments.settings:
        if path.count(".") < 2 and kind_of(path) != "normal":
            example = "--set integrator.symplectic.steps=400"
            raise ValueError(f"--set {path}: with --all name one law, such as {example}")
    chosen = file.laws.choose(normal=arguments.normal[0] if arguments.normal else None)
    fitting = candidates(chosen.set(dict(arguments.settings)))
    for name, reason in fitting.left_out.items():
        print(f"contactlab compare: {name} is left out: {reason}", file=sys.stderr)
    return fitting.simulations


def own_laws(arguments: argparse.Namespace, laws: LawChoice, scene: Scene | None) -> list[str]:
    """Return the friction law of a file beside each normal law requested."""
    integrator = arguments.integrator[0] if arguments.integrator else None
    found = []
    for normal in arguments.normal or [None]:
        choice = laws.choose(normal=normal, integrator=integrator)
        suit = choice.resolve() if scene is None else choice.suit_to(scene)
        found.append(str(suit.tangential))
    return list(dict.fromkeys(found))


def simulations(
    arguments: argparse.Namespace, laws: LawChoice, defaults: Sequence[str] = ()
) -> dict[str, Simulation]:
    """Return all combinations of the requested laws, named by the kinds that differ.

    ``laws`` holds the laws of kinds without a request. Its integrator is replaced
    by the preferred one for tangential laws that it does not run. Combinations that do not fit are
    left out if their friction law is one of the ``defaults``.
    """
    requested = {kind: getattr(arguments, kind) or [None] for kind in KINDS}
    if defaults:
        requested["tangential"] = list(defaults)
    several = [kind for kind in KINDS if len(requested[kind]) > 1] or ["tangential"]
    combinations = {}
    used: set[str] = set()
    offered: set[str] = set()
    for combination in itertools.product(*requested.values()):
        chosen = dict(zip(KINDS, combination, strict=True))
        choice = laws.choose(**chosen)
        if not arguments.integrator:
            choice = choice.suit()
        if defaults and not _fit(choice):
            continue
        choice = choice.resolve()
        settings = {
            path: value for path, value in arguments.settings if _knows(choice, path, used, offered)
        }
        name = " + ".join(getattr(choice, kind) for kind in several)
        combinations[name] = choice.set(settings).simulation()
    for path, _ in arguments.settings:
        if path not in used:
            raise ValueError(
                f"--set {path}: no chosen law has this option; "
                f"{nearest(path, offered)}known: {', '.join(sorted(offered)) or 'none'}"
            )
    return combinations


def _fit(choice: LawChoice) -> bool:
    """Return whether laws run beside each other."""
    try:
        choice.simulation()
    except ValueError:
        return False
    return True


def _knows(choice: LawChoice, path: str, used: set[str], offered: set[str]) -> bool:
    """Return whether a chosen law has the option; add to the ``used`` and ``offered`` paths."""
    owner, _, option = path.rpartition(".")
    kind = kind_of(owner)
    if kind not in KINDS:
        used.add(path)
        return True  # LawChoice.set refuses this path
    chosen = full_name(kind, getattr(choice, kind))
    options = inspect.signature(REGISTRY.law_class(chosen)).parameters
    offered.update(f"{kind}.{name}" for name in options)
    if owner != kind and not same_law(owner, chosen):
        return False
    has_option = option in options
    used.update([path] if has_option else [])
    return has_option
