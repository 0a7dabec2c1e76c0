"""The scene of a subcommand: a file, or psi1 and chi; and the laws to run it with."""

from __future__ import annotations

import argparse
from typing import NamedTuple

from contactlab.cli import arguments as shared
from contactlab.scene import Scene
from contactlab.scene_file import LawChoice, SceneFile, read_scene
from contactlab.simulation import Simulation


class Given(NamedTuple):
    """What the arguments of a subcommand stand for; ``file`` is None for psi1 and chi."""

    file: SceneFile | None
    scene: Scene
    simulation: Simulation

    @property
    def title(self) -> str:
        """Return the title of the file."""
        return self.file.title if self.file else ""


def add_scene(parser: argparse.ArgumentParser) -> None:
    """Add the scene file, ``--psi1``, ``--chi`` and the laws."""
    parser.add_argument("scene", nargs="?", metavar="SCENE.toml", help="a scene or a sweep")
    parser.add_argument(
        "--psi1", type=shared.finite, help="non-dimensional angle of incidence (29), without a file"
    )
    parser.add_argument(
        "--chi", type=shared.finite, help="inertia ratio (38): 1.4412 for a solid sphere, nu = 0.3"
    )
    shared.add_laws(parser)


def given(arguments: argparse.Namespace) -> Given:
    """Return the scene and the simulation.

    Raises
    ------
    ValueError
        If neither a file nor both numbers are given, or a file and a number.
    """
    file = read_scene(arguments.scene) if arguments.scene else None
    scene = _scene(arguments, file)
    return Given(file, scene, composed(arguments, file.laws if file else LawChoice()))


def composed(arguments: argparse.Namespace, choice: LawChoice) -> Simulation:
    """Return the laws of ``choice``, but for those that the arguments name, with their options."""
    choice = choice.choose(
        normal=arguments.normal, tangential=arguments.tangential, integrator=arguments.integrator
    )
    return choice.set(dict(arguments.settings)).simulation()


def _scene(arguments: argparse.Namespace, file: SceneFile | None) -> Scene:
    numbers = (arguments.psi1, arguments.chi)
    if file is not None:
        if numbers != (None, None):
            raise ValueError("--psi1, --chi: stand in place of a scene file; leave out one of them")
        return file.scene
    if None in numbers:
        missing = "a scene file, or --psi1 and --chi" if numbers == (None, None) else "both"
        missing = missing if missing != "both" else "--chi" if numbers[1] is None else "--psi1"
        raise ValueError(f"{missing}: must be given (chi is 1.4412 for a solid sphere, nu = 0.3)")
    return Scene.nondimensional(psi1=numbers[0], chi=numbers[1])
