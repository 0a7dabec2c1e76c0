"""contactlab: oblique impact of elastic bodies, with contact laws as plug-ins.

A scene meets three interchangeable laws, and the answer comes back with its error, its
cost, its energy books and a list of what was left out.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from contactlab.bodies import HalfSpace, Material, Pair, Sphere
from contactlab.energy import EnergyLedger
from contactlab.hookspecs import hookimpl
from contactlab.rebounds import rebound
from contactlab.registry import REGISTRY, PluginError
from contactlab.result import ImpactError, ImpactResult
from contactlab.scene import Scene
from contactlab.signatures import named_arguments
from contactlab.simulation import Simulation
from contactlab.status import Status

if TYPE_CHECKING:
    from contactlab.scene_file import SceneFile

__version__ = "0.1.0"

__all__ = [
    "EnergyLedger",
    "HalfSpace",
    "ImpactError",
    "ImpactResult",
    "Material",
    "Pair",
    "PluginError",
    "Scene",
    "Simulation",
    "Sphere",
    "Status",
    "create",
    "hookimpl",
    "read_scene",
    "rebound",
]


@named_arguments("create('tangential.annulus', annuli=50)")
def create(name: str, **options: Any) -> Any:
    """Return a new law by name: ``create("tangential.annulus", annuli=50)``.

    Raises
    ------
    ValueError
        If no such law is installed (with the nearest match), or an option is refused.
    PluginError
        If the plug-in is broken, with its traceback.
    """
    return REGISTRY.create(name, **options)


@named_arguments("read_scene('scene.toml')")
def read_scene(path: str | Path) -> SceneFile:
    """Read a scene or a sweep, its laws and its measured values from a TOML file.

    Raises
    ------
    ValueError
        If the file cannot be read, is not TOML, or says something unknown or not physical,
        with the key, the value, the rule and the remedy.
    """
    from contactlab import scene_file  # only those who read files pay for the reader

    return scene_file.read_scene(path)
