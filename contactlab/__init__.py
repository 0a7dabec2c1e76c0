"""contactlab: oblique impact of elastic bodies, with contact laws as plug-ins.

A scene meets three interchangeable laws, and the answer comes back with its error, its
cost, its energy books and a list of what was left out.

The modules, each of which imports from those above it only:

===================== ==========================================================================
*numbers and files*
``status``            how a run ended
``checks``            checked numbers, refusals
``attributes``        refusals of unknown attributes
``signatures``        refusals of unknown arguments
``vectors``           checked vectors of three numbers, and their components
``batch``             trees of numbers stacked, taken apart and joined
``collocation``       nodes and matrices of Lobatto collocation
``json_values``       values as JSON takes them
``files``             output files that are whole or not there
*the problem*
``bodies``            materials, spheres, half-spaces, pairs
``materials``         materials by name, with sources
``scene``             one oblique impact, or a batch
``grid``              batches of every combination of some entries
``encounter``         two bodies in space, by vectors
``unit_slips``        numbers that look as if in another unit
``closed_forms``      Hertz's scales, gross slip, the rigid body
``calibration``       one constant of a law from a restitution
``adhesion``          which theory of adhesion holds
``cautions``          what a model leaves out, in sentences
``declared``          measured numerical errors, and the range of psi2
*the laws*
``contracts``         what a law promises: normal, tangential, integrator
``hookspecs``         the hook of a plug-in
``installed``         entry points that are installed
``loading``           the loading of one plug-in
``registry``          laws by name
``faults``            what is said of a law that fails
``composition``       which laws fit together
*one run*
``solved_motion``     a normal motion as a table
``scaled_normal_law`` a normal law as an equation of motion
``normal_motion``     the normal motion of any law
``answers``           whole impacts that a law knows without a march
``plan``              what is computed, left out and doubtful
``planning``          how a plan is made
``history``           the course of an impact
``motion``            normal and tangential motion together
``energy``            energy books
``marching``          the march, and failures within a batch
``outcome``           plan and motion of a scene under three laws
``sweeping``          a batch in blocks
``kept``              pieces of a sweep on disk
*the answer*
``result``            velocities, books, cost
``error_estimate``    the numerical error, estimated by other resolutions
``simulation``        three laws composed: plan, run, sweep
``workers``           processes of this machine
``executors``         a sweep on any executor
``rebounds``          psi2 of arrays of psi1 and chi
``impulses``          velocities and spins from an impulse
``collision_plan``    what its plan says besides that of its scenes
``collision``         what any law makes of an encounter
``export``            results as files
``labelled``          results with named axes: pandas, xarray
``quantities``        quantities of a result by name
``reading``           a result as titled tables
``options``           options of laws in words
``citations``         sources of laws, BibTeX
*around it*
``scene_file``        scenes in TOML
``analysis``          comparison, validation, stability, cost
``fitting``           parameters from measured impacts
``figures``           one function a figure
``pages``             pages that stand alone, notebooks
``testing``           the conformance kit
``cli``               the commands
===================== ==========================================================================
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from contactlab.bodies import HalfSpace, Material, Pair, Sphere
from contactlab.collision import Collision, collide
from contactlab.encounter import Encounter
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
    from contactlab import materials
    from contactlab.fitting import fit
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


@named_arguments("create('tangential.annulus', annuli=50)")
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


@named_arguments("read_scene('scene.toml')")
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
        return importlib.import_module("contactlab.materials")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
