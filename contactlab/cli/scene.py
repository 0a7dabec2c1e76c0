"""The scene of a subcommand, from a file or from psi1 and chi, and its laws."""

from __future__ import annotations

import argparse
from collections.abc import Mapping

import numpy as np

from contactlab.cli import arguments as shared
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array, Real
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import LawChoice, SceneFile, read_scene
from contactlab.scene_file.laws import beside

#: Most impacts of a range, so that a typing error does not fill the memory.
MOST_IMPACTS = 1_000_000


def add_allow_code(parser: argparse.ArgumentParser) -> None:
    """Add ``--allow-code``, which every command that reads a scene has."""
    words = "run the Python files that the scene names as laws: code can do anything"
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


def add_scene(parser: argparse.ArgumentParser, *, ranges: bool = False) -> None:
    """Add the scene file, ``--psi1``, ``--chi`` and the laws."""
    add_file(parser)
    add_groups(parser, ranges=ranges)
    shared.add_laws(parser)


def add_groups(parser: argparse.ArgumentParser, *, ranges: bool = True) -> None:
    """Add ``--psi1`` and ``--chi``, each one number, or with ``ranges`` a range too."""
    convert, metavar = (numbers, "NUMBER or START:STOP:COUNT") if ranges else (None, "NUMBER")
    for name, words in (
        ("psi1", "scaled slip velocity before the impact, in place of a file"),
        ("chi", "inertia ratio, eq. (38): 1.4412 for a solid sphere, nu = 0.3"),
    ):
        parser.add_argument(f"--{name}", type=convert or shared.finite, metavar=metavar, help=words)
    add_ball(parser, "in place of --chi, with --gyration-ratio")


def add_ball(parser: argparse.ArgumentParser, words: str) -> None:
    """Add Poisson's ratio and radius of gyration of a sphere, which give chi."""
    words = f"Poisson's ratio of sphere and half-space, {words}"
    parser.add_argument("--poisson-ratio", type=shared.finite, metavar="NU", help=words)
    words = "radius of gyration of the sphere over its radius, 0.6325 if solid"
    parser.add_argument("--gyration-ratio", type=shared.finite, metavar="K", help=words)


def settle_chi(arguments: argparse.Namespace) -> None:
    """Set chi of a sphere by Poisson's ratio and radius of gyration, where they are given."""
    given = {
        "--poisson-ratio": arguments.poisson_ratio,
        "--gyration-ratio": arguments.gyration_ratio,
    }
    named = [option for option, value in given.items() if value is not None]
    if not named:
        return
    if arguments.scene:
        told = f"{arguments.scene} is a scene already; leave out the file, or the options"
        raise ValueError(f"{', '.join(named)}: {told}")
    if arguments.chi is not None:
        raise ValueError(f"--chi, {', '.join(named)}: say the same; leave out --chi, or the others")
    if len(named) < len(given):
        (lacking,) = given.keys() - {*named}
        told = "0.6325 of a solid sphere" if "gyration" in lacking else "0.3 of steel"
        raise ValueError(f"{lacking}: must be given beside {named[0]} ({told})")
    from contactlab.study.paper_figures import chi_of_gyration  # few commands need it

    arguments.chi = chi_of_gyration(arguments.gyration_ratio, arguments.poisson_ratio)
    arguments.poisson_ratio = arguments.gyration_ratio = None  # done


def numbers(text: str) -> Real:
    """Return one number, or an evenly spaced array from START:STOP:COUNT."""
    parts = text.split(":")
    if len(parts) < 3:
        return shared.finite(text)  # START:STOP gets a hint on COUNT
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
    """Refuse psi1 or chi beside a scene file; find chi of a sphere of numbers."""
    settle_chi(arguments)
    if arguments.scene and not (arguments.psi1 is None and arguments.chi is None):
        if getattr(arguments, "csv", False) and not arguments.scene.endswith(".toml"):
            raise ValueError(
                f"{arguments.scene!r} was read as a scene. --csv prints; to write a file: "
                f"--out {arguments.scene}"
            )
        raise ValueError(
            f"--psi1, --chi: {arguments.scene} is a scene already; leave out the file, or both"
        )


def inputs(arguments: argparse.Namespace) -> tuple[SceneFile | None, Scene, Simulation]:
    """Return file, scene and simulation of the arguments; no file for psi1 and chi."""
    file = read(arguments)
    scene = _scene(arguments, file)
    return file, scene, compose_laws(arguments, file.laws if file else LawChoice())


def with_restitution(arguments: argparse.Namespace, choice: LawChoice) -> LawChoice:
    """Return the laws of ``choice``, the normal law replaced by that of ``--restitution``."""
    if arguments.restitution is None:
        return choice
    if arguments.normal is not None:
        normal = arguments.normal
        told = beside(
            normal if isinstance(normal, str) else ",".join(normal),
            arguments.restitution,
            given="--restitution ",
            law="--normal ",
            option="--set normal.restitution=",
        )
        raise ValueError(told)
    settings = dict(getattr(arguments, "settings", ()))
    return choice.without("normal").set(settings).with_restitution(arguments.restitution)


def compose_laws(arguments: argparse.Namespace, choice: LawChoice) -> Simulation:
    """Return the laws of ``choice``, replaced by the laws and options of the arguments."""
    settings = dict(arguments.settings)
    choice = with_restitution(arguments, choice).choose(
        normal=arguments.normal, tangential=arguments.tangential, integrator=arguments.integrator
    )
    return choice.set(settings).simulation()


def _scene(arguments: argparse.Namespace, file: SceneFile | None) -> Scene:
    """Return the scene of the file, or of psi1 and chi."""
    check_alone(arguments)
    if file is not None:
        return file.scene
    psi1, chi = arguments.psi1, arguments.chi
    if psi1 is None or chi is None:
        missing = "--chi" if chi is None else "--psi1"
        missing = "a scene file, or --psi1 and --chi" if psi1 is chi else missing
        raise ValueError(f"{missing}: must be given (chi is 1.4412 for a solid sphere, nu = 0.3)")
    if np.ndim(psi1) or np.ndim(chi):
        return grid(psi1, chi)
    return Scene.nondimensional(psi1=psi1, chi=chi)


def grid(psi1: Real | None, chi: Real | None) -> Scene:
    """Return the scene of every psi1 with every chi, psi1 varying fastest."""
    remedy = "contactlab sweep --out folder/ holds more"
    return Scene.grid(**grid_entries(psi1, chi, most=MOST_IMPACTS, remedy=remedy))


def grid_entries(
    psi1: Real | None, chi: Real | None, *, most: int, remedy: str
) -> dict[str, Array]:
    """Return the entries of a grid, or refuse more impacts than ``most``."""
    if psi1 is None or chi is None:
        missing = " and ".join(n for n, v in (("--psi1", psi1), ("--chi", chi)) if v is None)
        raise ValueError(f"{missing}: must be given, or a sweep file")
    if (size := np.size(psi1) * np.size(chi)) > most:
        raise refuse("--psi1, --chi", size, f"at most {most} impacts", remedy)
    return {"chi": np.atleast_1d(chi), "psi1": np.atleast_1d(psi1)}
