"""Results and plans of impacts with a restitution in place of laws."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import attrs
import numpy as np

from contactlab.collisions.collision_plan import by_rebound
from contactlab.collisions.rebound import laws_of
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab.outcome.motion import Motion
from contactlab.outcome.normal_spin_words import with_normal_spin
from contactlab.outcome.plan import Plan
from contactlab.outcome.result import ImpactResult
from contactlab.runs.simulation import Simulation, run_in_blocks

#: Different restitutions beyond which a plan has one statement, and the cautions of the least, for
#: all impacts with loss.
MOST_STATEMENTS = 20


def run_by_restitution(scene: Scene, restitution: Real) -> ImpactResult:
    """Return the result of impacts under a restitution, one number or one for each."""
    if not scene.shape:
        return _run(scene, float(restitution))
    groups = _alike(restitution)
    if len(groups) == 1:
        return _run(scene, groups[0][1])
    parts = [(mask, _run(scene.take(mask), e)) for mask, e in groups]
    return ImpactResult(
        scene=scene,
        plan=Plan.merge([(mask, part.plan) for mask, part in parts], scene.shape),
        motion=Motion.merge([(mask, part.motion) for mask, part in parts], scene.shape),
        laws=parts[0][1].laws,
        run_time=sum(part.run_time for _, part in parts),
    )


def _run(scene: Scene, restitution: float) -> ImpactResult:
    """Return the result of impacts of one restitution."""
    return run_in_blocks(_simulation(restitution), scene)


def plan_rebounds(scene: Scene, restitution: Real) -> Plan:
    """Return the plan of impacts that ``contactlab.rebound`` answers."""
    plan = _of_groups(attrs.evolve(scene, encounter=None, normal_spin=0.0), restitution)
    return Plan(plan.columns, lambda: with_normal_spin(plan.words, scene))


def _of_groups(scene: Scene, restitution: Real) -> Plan:
    """Return the plan of impacts, with the words of each restitution."""
    groups = _alike(restitution)
    if len(groups) == 1:
        return _plan_of_each(scene, groups[0][1], restitution)
    restitution = np.asarray(restitution)
    if len(groups) > MOST_STATEMENTS:
        masks = [mask for mask in (restitution == 1.0, restitution < 1.0) if mask.any()]
        groups = [(mask, float(restitution[mask].min())) for mask in masks]
    plans = [
        (mask, _plan_of_each(scene.take(mask), value, restitution[mask])) for mask, value in groups
    ]
    return Plan.merge(plans, scene.shape)


def _plan_of_each(scene: Scene, restitution: float, each: Real) -> Plan:
    """Return the plan of impacts, with the cautions of one restitution and the errors of each."""
    plan = _simulation(restitution).plan(scene)
    return plan if restitution == 1.0 else by_rebound(plan, scene.chi, each)


@lru_cache(maxsize=16)  # to compose laws takes as long as to solve an impact
def _simulation(restitution: float) -> Simulation:
    """Return laws with the answers of ``contactlab.rebound``."""
    return Simulation() if restitution == 1.0 else laws_of(restitution)


def _alike(restitution: Real) -> list[tuple[Any, float]]:
    """Return masks of equal restitutions, and the restitution of each mask."""
    return [(restitution == value, value) for value in np.unique(restitution).tolist()]
