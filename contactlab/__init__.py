"""contactlab computes oblique impacts of elastic bodies, with contact laws as plug-ins.

A ``Scene`` describes an impact: bodies of any shape, friction, velocities. A ``Simulation``
combines a normal law, a tangential law and an integrator. ``Simulation.run`` returns an
``ImpactResult``, which has velocities after the impact, energies, the numerical error, and the
plan, which states what was computed and which effects were left out::

    from contactlab import HalfSpace, Material, Scene, Simulation, Sphere

    steel = Material.named("steel")
    ball = Sphere(radius=0.01, material=steel)
    scene = Scene.at_angle(ball, HalfSpace(steel), 0.2, speed=1.0, angle_deg=30.0)
    result = Simulation().run(scene)
    print(result.psi2, result.plan)

The package has these parts. Each imports only from the parts above it:

================ =========================================================================
``numeric``      checked numbers, vectors, batches, collocation, Runge-Kutta, lazy imports
``registration`` names, hooks, the one plug-in manager of the process
``impact``       materials, bodies, scenes, encounters, Hertz's closed forms, cautions
``contracts``    base classes of normal laws, tangential laws and integrators; statuses
``outcome``      results: motion, plan, energy books, history, tables, files, figure
``registry``     laws found by name, fitted together, made from options
``solve``        impacts in the decoupled and the coupled way, plans, errors
``runs``         simulations, sweeps here and by workers, into memory and folders
``collisions``   encounters in space, rebounds, velocities of bodies
``paths``        laws along given paths
``scene_file``   scenes and sweeps in TOML
``testing``      the conformance kit, which checks laws against their contracts
``study``        comparison, cost against error, stability, validation, the paper's figures
``figures``      functions that draw on Matplotlib axes
``cli``          the command line
================ =========================================================================

The laws are in the package ``contactlab_laws``, fits to measured impacts in ``contactlab_fit``,
HTML pages in ``contactlab_pages``: each plugs in by entry points and hooks. The guide is in
``guide/``; the friction law as a kernel in C and JavaScript is in ``kernels/``, without Python.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, overload

from contactlab.numeric.names import import_on_use

if TYPE_CHECKING:
    from contactlab.collisions.collide import collide
    from contactlab.collisions.collision import Collision
    from contactlab.collisions.rebound import rebound
    from contactlab.contracts.contact import NormalContact
    from contactlab.contracts.integrator import CoupledIntegrator, Integrator
    from contactlab.contracts.law import Law
    from contactlab.contracts.motion import ClosedFormMotion
    from contactlab.contracts.normal import ClosedFormNormalLaw, NormalLaw, UnfollowedNormalLaw
    from contactlab.contracts.path import Cost, PathTangentialLaw, Stretch
    from contactlab.contracts.status import Status
    from contactlab.contracts.tangential import (
        AllStepsResponse,
        AllStepsTangentialLaw,
        CausalTangentialLaw,
        CoupledTangentialLaw,
        Errors,
        ResolvingTangentialLaw,
        SteppedTangentialLaw,
        TangentialLaw,
        TangentialResponse,
        WholeImpactTangentialLaw,
    )
    from contactlab.contracts.tangential_motion import TangentialMotion
    from contactlab.contracts.whole_impact import WholeImpact
    from contactlab.impact import material as materials
    from contactlab.impact import shapes
    from contactlab.impact.bodies import HalfSpace, Sphere
    from contactlab.impact.encounter import Encounter
    from contactlab.impact.gathering import Body, Gathering, Touch
    from contactlab.impact.material import Material
    from contactlab.impact.rigid_body import RigidBody
    from contactlab.impact.scene import Scene
    from contactlab.outcome.answer import ImpactError
    from contactlab.outcome.energy import EnergyLedger
    from contactlab.outcome.result import ImpactResult
    from contactlab.outcome.sweep_folder import SweepFolder
    from contactlab.paths.load_path import load_path
    from contactlab.registration.hooks import PluginError, hookimpl
    from contactlab.registration.manager import plugin_manager
    from contactlab.registry.loading import register
    from contactlab.registry.named_laws import IntegratorName, NormalName, TangentialName
    from contactlab.runs.simulation import Simulation
    from contactlab.scene_file import read_scene
    from contactlab.study.comparison import compare
    from contactlab_fit.estimation import fit as fit  # not in __all__: the folder can be taken out

__version__ = "0.1.0"

__all__ = [
    "AllStepsResponse",
    "AllStepsTangentialLaw",
    "Body",
    "CausalTangentialLaw",
    "ClosedFormMotion",
    "ClosedFormNormalLaw",
    "Collision",
    "Cost",
    "CoupledIntegrator",
    "CoupledTangentialLaw",
    "Encounter",
    "EnergyLedger",
    "Errors",
    "Gathering",
    "HalfSpace",
    "ImpactError",
    "ImpactResult",
    "Integrator",
    "Material",
    "NormalContact",
    "NormalLaw",
    "PathTangentialLaw",
    "PluginError",
    "ResolvingTangentialLaw",
    "RigidBody",
    "Scene",
    "Simulation",
    "Sphere",
    "Status",
    "SteppedTangentialLaw",
    "Stretch",
    "SweepFolder",
    "TangentialLaw",
    "TangentialMotion",
    "TangentialResponse",
    "Touch",
    "UnfollowedNormalLaw",
    "WholeImpact",
    "WholeImpactTangentialLaw",
    "collide",
    "compare",
    "create",
    "hookimpl",
    "load_path",
    "materials",
    "plugin_manager",
    "read_scene",
    "rebound",
    "register",
    "shapes",
]


@overload
def create(name: NormalName, **options: object) -> NormalLaw: ...
@overload
def create(name: TangentialName, **options: object) -> TangentialLaw: ...
@overload
def create(name: IntegratorName, **options: object) -> Integrator: ...
@overload
def create(name: str, **options: object) -> Law: ...
def create(name: str, **options: object) -> Law:
    """Return a new law by name: ``create("tangential.annulus", annuli=50)``.

    Parameters
    ----------
    name : str
        Kind and name, such as ``"tangential.annulus"``, or file and class,
        ``"my_law.py:Stribeck"``.
    **options
        Options of the law; ``contactlab plugins show NAME`` lists them with units.

    Raises
    ------
    ValueError
        If no such law is installed, with the nearest name, or if an option is refused.
    PluginError
        If the plug-in fails to load; the message has its traceback.
    """
    from contactlab.registry.registry import REGISTRY

    return REGISTRY.create(name, **options)


#: Where the public names are: ``import contactlab`` imports none of them.
MODULES = {
    "Body": "impact.gathering",
    "Collision": "collisions.collision",
    "Encounter": "impact.encounter",
    "EnergyLedger": "outcome.energy",
    "Gathering": "impact.gathering",
    "HalfSpace": "impact.bodies",
    "ImpactError": "outcome.answer",
    "ImpactResult": "outcome.result",
    "Material": "impact.material",
    "PluginError": "registration.hooks",
    "RigidBody": "impact.rigid_body",
    "Scene": "impact.scene",
    "Simulation": "runs.simulation",
    "Sphere": "impact.bodies",
    "Status": "contracts.status",
    "SweepFolder": "outcome.sweep_folder",
    "Touch": "impact.gathering",
    "collide": "collisions.collide",
    "compare": "study.comparison",
    "fit": "contactlab_fit",
    "hookimpl": "registration.hooks",
    "load_path": "paths.load_path",
    "materials": "impact.material",
    "plugin_manager": "registration.manager",
    "read_scene": "scene_file",
    "rebound": "collisions.rebound",
    "register": "registry.loading",
    "shapes": "impact.shapes",
    # the classes that authors of laws derive from, and what their methods return
    "NormalLaw": "contracts.normal",
    "ClosedFormNormalLaw": "contracts.normal",
    "UnfollowedNormalLaw": "contracts.normal",
    "NormalContact": "contracts.contact",
    "ClosedFormMotion": "contracts.motion",
    "TangentialLaw": "contracts.tangential",
    "SteppedTangentialLaw": "contracts.tangential",
    "CausalTangentialLaw": "contracts.tangential",
    "AllStepsTangentialLaw": "contracts.tangential",
    "WholeImpactTangentialLaw": "contracts.tangential",
    "CoupledTangentialLaw": "contracts.tangential",
    "TangentialResponse": "contracts.tangential",
    "AllStepsResponse": "contracts.tangential",
    "Errors": "contracts.tangential",
    "PathTangentialLaw": "contracts.path",
    "ResolvingTangentialLaw": "contracts.tangential",
    "Stretch": "contracts.path",
    "Cost": "contracts.path",
    "WholeImpact": "contracts.whole_impact",
    "TangentialMotion": "contracts.tangential_motion",
    "Integrator": "contracts.integrator",
    "CoupledIntegrator": "contracts.integrator",
    # the public submodules
    "contracts": "contracts",
    "figures": "figures",
    "plugin": "plugin",
    "study": "study",
    "testing": "testing",
}

__getattr__, __dir__ = import_on_use(__name__, MODULES)
