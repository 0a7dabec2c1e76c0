"""Impacts with a tabulated rebound: elastic, or with one restitution."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from contactlab.compose.rebound import laws_of, rebound
from contactlab.compose.simulation import Simulation
from contactlab.contracts.status import Status
from contactlab.impact.cautions import unit_slips
from contactlab.impact.coupling import coupling
from contactlab.impact.scene import Scene
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import Clause, Plan, PlanColumns, Words
from contactlab.outcome.result import ImpactResult


def holds(simulation: Simulation | None) -> bool:
    """Return whether ``contactlab.rebound`` answers for these laws.

    None stands for the exact elastic laws. Other laws are tabulated if their normal law is the
    one of ``rebound(restitution=)`` and tangential law and integrator are the defaults.
    """
    if simulation is None:
        return True
    normal = simulation.normal
    if type(normal) is not _normal_law() or getattr(normal, "restitution", None) is None:
        return False
    return simulation == Simulation(normal=normal)


@cache
def _normal_law() -> type:
    """Return the class of the normal law behind ``rebound(restitution=)``."""
    return type(laws_of(0.9).normal)


def impacts(scene: Scene, simulation: Simulation | None) -> ImpactResult:
    """Return the impacts of a batch by the table of psi2; friction work is NaN."""
    shape, laws = scene.shape, simulation or Simulation()
    damping: Any = {} if simulation is None else {"restitution": laws.normal.restitution}  # type: ignore[attr-defined]
    psi2, course = rebound(scene.psi1, scene.chi, **damping), laws.normal_motion(scene)
    change: Any = (psi2 - scene.psi1) / np.asarray(scene.psi_scale)
    motion = Motion(
        slip_velocity_change=change,
        friction_work=np.full(shape, np.nan),
        status=np.full(shape, Status.SUCCESS, dtype=object),
        duration=np.broadcast_to(course.duration, shape),
        normal_velocity=np.broadcast_to(course.final_rate, shape),
        maximum_radius=np.broadcast_to(course.maximum_radius, shape),
        maximum_approach=np.broadcast_to(course.maximum_approach, shape),
        maximum_force=np.broadcast_to(course.maximum_force, shape),
    )
    everywhere = np.ones(shape, dtype=bool)

    def clauses() -> Words:
        said = (*unit_slips(scene), *laws.normal.cautions(scene, course), *coupling(scene))
        return (), (), tuple(Clause(text, everywhere) for text in said)

    plan = Plan(PlanColumns.nothing(shape), clauses)
    return ImpactResult(scene=scene, plan=plan, motion=motion, run_time=0.0, laws={})
