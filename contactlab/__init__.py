"""contactlab: oblique impact of elastic bodies, with contact laws as plug-ins.

A scene meets three interchangeable laws, and the answer comes back with its error, its
cost, its energy books and a list of what was left out.

The rooms, each of which imports from those above it only:

============== ===========================================================================
``numeric``    checked numbers, vectors, batches, nodes of collocation
``impact``     materials, bodies, scenes, encounters, Hertz's closed forms, adhesion
``contracts``  what a law promises: normal, tangential, whole impact, integrator; statuses
``outcome``    motion, plan, energy books, history, results and the forms they are read in
``compose``    laws found by name and fitted together: run, sweep, rebound, collide
``scene_file`` scenes and sweeps in TOML
``testing``    the conformance kit for laws
``study``      comparison, cost against error, stability, validation, the paper's figures
``fitting``    parameters from measured impacts
``figures``    one function a figure
``pages``      pages that stand alone, notebooks
``cli``        the commands
============== ===========================================================================

The pages of the guide lie in ``guide/``, which holds no code.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from contactlab.compose.collision import Collision, collide
from contactlab.compose.hookspecs import hookimpl
from contactlab.compose.rebound import rebound
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.compose.simulation import Simulation
from contactlab.contracts.status import Status
from contactlab.impact.bodies import HalfSpace, Pair, Sphere
from contactlab.impact.encounter import Encounter
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.outcome.energy import EnergyLedger
from contactlab.outcome.result import ImpactError, ImpactResult

if TYPE_CHECKING:
    from contactlab.fitting import fit
    from contactlab.impact import material as materials
    from contactlab.scene_file import SceneFile

__version__ = "0.1.0"

__all__ = [
    "Collision",
    "Encounter",
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
    "collide",
    "create",
    "fit",
    "hookimpl",
    "materials",
    "read_scene",
    "rebound",
]


def create(name: str, **options: Any) -> Any:
    """Return a new law by name: ``create("tangential.annulus", annuli=50)``.

    Parameters
    ----------
    name : str
        Kind and name, such as ``"tangential.annulus"``.
    **options
        Of the law: ``contactlab plugins show NAME`` tells them with units.

    Raises
    ------
    ValueError
        If no such law is installed (with the nearest match), or an option is refused.
    PluginError
        If the plug-in is broken, with its traceback.
    """
    return REGISTRY.create(name, **options)


def read_scene(path: str | Path) -> SceneFile:
    """Read a scene or a sweep, its laws and its measured values from a TOML file.

    Parameters
    ----------
    path : str or Path
        Of a TOML file.

    Raises
    ------
    ValueError
        If the file cannot be read, is not TOML, or says something unknown or not physical,
        with the key, the value, the rule and the remedy.
    """
    from contactlab import scene_file  # only those who read files pay for the reader

    return scene_file.read_scene(path)


def __getattr__(name: str) -> Any:
    """Return what only some need, when it is asked for."""
    import importlib

    if name == "fit":
        return importlib.import_module("contactlab.fitting").fit
    if name == "materials":
        return importlib.import_module("contactlab.impact.material")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
