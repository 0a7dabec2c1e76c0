"""The scene of a subcommand, from a file or from psi1 and chi, and its laws."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from contactlab.cli import arguments as shared
from contactlab.impact.scene import Scene
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import LawChoice, SceneFile, read_scene
from contactlab.scene_file.laws import beside

#: Most impacts of a range, so that a typing error does not fill the memory.
MOST_IMPACTS = 1_000_000


class Inputs(NamedTuple):
    """Scene and laws of a subcommand; ``file`` is None for psi1 and chi."""

    file: SceneFile | None
    scene: Any
    simulation: Simulation


def add_allow_code(parser: argparse.ArgumentParser) -> None:
    """Add ``--allow-code``, which every command that reads a scene has."""
    words = "run the Python files that the scene names as laws: they may do anything"
    parser.add_argument("--allow-code", action="store_true", help=words)


def add_file(
    parser: argparse.ArgumentParser, words: str = "a scene or a sweep", *, needed: bool = False
) -> None:
    """Add the scene file with ``words`` as its help, and ``--allow-code``."""
    many = None if needed else "?"
    parser.add_argument("scene", nargs=many, metavar="SCENE.toml", help=words)
    add_allow_code(parser)


def read(
    arguments: argparse.Namespace, defaults: Mapping[str, float] | None = None
) -> SceneFile | None:
    """Return the scene file of the arguments; None if they name none.

    ``defaults`` are those of ``read_scene``.
    """
    if not arguments.scene:
        return None
    return read_scene(arguments.scene, defaults=defaults, allow_code=arguments.allow_code)


def add_scene(parser: argparse.ArgumentParser) -> None:
    """Add the scene file, ``--psi1``, ``--chi`` and the laws."""
    add_file(parser)
    parser.add_argument(
        "--psi1", type=shared.finite, help="non-dimensional angle of incidence psi1, without a file"
    )
    parser.add_argument(
        "--chi", type=shared.finite, help="inertia ratio (38): 1.4412 for a solid sphere, nu = 0.3"
    )
    shared.add_laws(parser)


def add_ranges(parser: argparse.ArgumentParser) -> None:
    """Add ``--psi1`` and ``--chi``, each one number or a range."""
    for name, words in (
        ("psi1", "angle of incidence, 0 for no slip"),
        ("chi", "inertia ratio, 1.4412 for a solid sphere"),
    ):
        parser.add_argument(
            f"--{name}", type=numbers, metavar="START:STOP:COUNT", help=f"{words}; or one number"
        )


def numbers(text: str) -> Any:
    """Return one number, or an evenly spaced array from START:STOP:COUNT."""
    parts = text.split(":")
    if len(parts) < 3:
        return shared.finite(text)  # of START:STOP it says what is missing
    if len(parts) != 3:
        raise argparse.ArgumentTypeError(f"{text!r}: write START:STOP:COUNT, or one number")
    start, stop = shared.finite(parts[0]), shared.finite(parts[1])
    try:
        count = int(parts[2])
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: COUNT must be a whole number") from None
    if not 1 <= count <= MOST_IMPACTS:
        raise argparse.ArgumentTypeError(f"{text!r}: COUNT must lie in [1, {MOST_IMPACTS}]")
    if count == 1 and start != stop:
        raise argparse.ArgumentTypeError(f"{text!r}: COUNT must be at least 2 between two numbers")
    return np.linspace(start, stop, count)


def check_alone(arguments: argparse.Namespace) -> None:
    """Refuse psi1 or chi beside a scene file."""
    if arguments.scene and not (arguments.psi1 is None and arguments.chi is None):
        if getattr(arguments, "csv", False) and not arguments.scene.endswith(".toml"):
            told = f"{arguments.scene}: is read as a scene file, as --csv prints"
            raise ValueError(f"{told}; to write a file: --csv > {arguments.scene}")
        raise ValueError(
            "--psi1, --chi: cannot stand beside a scene file; leave out the file, or both of them"
        )


def inputs(arguments: argparse.Namespace) -> Inputs:
    """Return the scene and the simulation of the arguments."""
    file = read(arguments)
    scene = _scene(arguments, file)
    return Inputs(file, scene, compose_laws(arguments, file.laws if file else LawChoice()))


def compose_laws(arguments: argparse.Namespace, choice: LawChoice) -> Simulation:
    """Return the laws of ``choice``, replaced by the laws and options of the arguments."""
    settings = dict(arguments.settings)
    if arguments.restitution is not None:
        if arguments.normal is not None:
            told = beside(
                arguments.normal,
                arguments.restitution,
                given="--restitution ",
                law="--normal ",
                option="--set normal.restitution=",
            )
            raise ValueError(told)
        choice = choice.without("normal").set(settings).restituted(arguments.restitution)
    choice = choice.choose(
        normal=arguments.normal, tangential=arguments.tangential, integrator=arguments.integrator
    )
    return choice.set(settings).simulation()


def _scene(arguments: argparse.Namespace, file: SceneFile | None) -> Any:
    """Return the scene of the file, or of psi1 and chi."""
    check_alone(arguments)
    if file is not None:
        return file.scene
    groups = (arguments.psi1, arguments.chi)
    if None in groups:
        missing = "--chi" if groups[1] is None else "--psi1"
        missing = "a scene file, or --psi1 and --chi" if groups == (None, None) else missing
        raise ValueError(f"{missing}: must be given (chi is 1.4412 for a solid sphere, nu = 0.3)")
    return Scene.nondimensional(psi1=groups[0], chi=groups[1])
