"""Impacts with a tabulated rebound: elastic, or with one loss for pressure and shear."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np

from contactlab.collisions.rebound import rebound
from contactlab.contracts.status import Status
from contactlab.impact.cautions import unit_slips
from contactlab.impact.coupling import coupling
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab.outcome.motion import ENDS, Motion
from contactlab.outcome.plan import Clause, Plan, PlanColumns, Words
from contactlab.outcome.result import ImpactResult
from contactlab.registry import composition
from contactlab.registry.law_words import tell_assumptions
from contactlab.runs.simulation import Simulation

#: The normal law behind ``rebound(restitution=)``.
LOSSY = composition.RESTITUTION["normal"]
RESTITUTION = "restitution"
#: Steepest impacts, by tangential over normal speed, that tell of no friction.
STEEP = 0.1


def fit_restitution(scene: Scene, parameters: Iterable[str]) -> str:
    """Return in words how a restitution is fitted beside parameters, with the option to write."""
    along = np.max(np.abs(scene.slip_velocity) / np.asarray(scene.normal_speed))
    names = [name for name in parameters if name != "friction_coefficient" or along > STEEP]
    return (
        f"fit restitution too: that of normal={LOSSY}, equal damping in compression and shear "
        f"(--fit {','.join([*names, 'restitution'])})"
    )


def holds(simulation: Simulation | None) -> bool:
    """Return whether ``contactlab.rebound`` answers for these laws.

    None stands for the exact elastic laws. Other laws are tabulated if their normal law is the
    one of ``rebound(restitution=)`` and tangential law and integrator are the defaults.
    """
    if simulation is None:
        return True
    normal = simulation.normal
    lossy = type(composition.law("normal", LOSSY))  # behind ``rebound(restitution=)``
    if type(normal) is not lossy or getattr(normal, RESTITUTION, None) is None:
        return False
    return simulation == Simulation(normal=normal)


def with_loss(restitution: float) -> Simulation:
    """Return the laws of one loss for pressure and shear, beside default laws."""
    return Simulation(normal=composition.law("normal", LOSSY, restitution=restitution))


def impacts(scene: Scene, simulation: Simulation | None) -> ImpactResult:
    """Return the impacts of a batch by the table of psi2; friction work is NaN."""
    laws = simulation or Simulation()
    lossy = "viscous" in laws.laws.capability.normal_claims
    if not lossy:
        laws = Simulation()
    course = laws.normal_motion(scene)
    ends = {name: getattr(course, source) for name, source in ENDS.items()}
    everywhere = np.ones(scene.shape, dtype=bool)

    def clauses() -> Words:
        said = (*unit_slips(scene), *laws.normal.cautions(scene, course), *coupling(scene))
        said += tuple(tell_assumptions(laws.normal, laws.tangential))
        if lossy:
            said += laws.tangential.cautions(scene, course)
        return (), (), tuple(Clause(text, everywhere) for text in dict.fromkeys(said))

    restitution: Real = getattr(laws.normal, RESTITUTION) if lossy else 1.0
    return _result(scene, restitution, ends, clauses)


def rebounds(scene: Scene, restitution: Real) -> ImpactResult:
    """Return impacts with a restitution each: velocities only, the rest NaN, without a plan."""
    rate: Real = -restitution * np.asarray(scene.normal_speed)
    ends = dict.fromkeys(ENDS, np.nan) | {"normal_velocity": rate}
    return _result(scene, restitution, ends, lambda: ((), (), ()))


def _result(
    scene: Scene,
    restitution: Real,
    ends: Mapping[str, Real],
    words: Callable[[], Words],
) -> ImpactResult:
    """Return the impacts of a batch with psi2 by the table."""
    shape, e = scene.shape, restitution
    each = e if isinstance(e, float) else np.broadcast_to(e, shape)
    psi2: Real = rebound(scene.psi1, scene.chi, restitution=each)
    course = {name: np.broadcast_to(ends[name], shape) for name in ENDS}
    motion = Motion(
        slip_velocity_change=(psi2 - scene.psi1) / np.asarray(scene.psi_scale),
        friction_work=np.full(shape, np.nan),
        status=np.full(shape, Status.SUCCESS, dtype=object),
        duration=course["duration"],
        normal_velocity=course["normal_velocity"],
        maximum_radius=course["maximum_radius"],
        maximum_approach=course["maximum_approach"],
        maximum_force=course["maximum_force"],
    )
    plan = Plan(PlanColumns.nothing(shape), words)
    return ImpactResult(scene=scene, plan=plan, motion=motion, run_time=0.0, laws={})
