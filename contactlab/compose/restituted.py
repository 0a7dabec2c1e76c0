"""Impacts with a restitution in place of laws: their results, and their plans."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import attrs
import numpy as np

from contactlab.compose.collision_plan import by_rebound
from contactlab.compose.normal_spin_words import with_normal_spin
from contactlab.compose.rebound import laws_of, rebound
from contactlab.compose.simulation import Simulation
from contactlab.contracts.restitution import LEAST_RESTITUTION
from contactlab.contracts.status import Status
from contactlab.impact.inverse_mass import unit_slip
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import filled, spread
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array, Real
from contactlab.outcome.motion import ENDS, Motion
from contactlab.outcome.plan import Plan
from contactlab.outcome.result import ImpactResult

#: Different restitutions beyond which a plan has one statement, and the cautions of the least, for
#: all impacts with loss.
MOST_STATEMENTS = 20


def run_in_blocks(simulation: Simulation, scene: Scene) -> ImpactResult:
    """Return the result of a scene, by blocks if the scene has one axis."""
    return simulation.sweep(scene) if len(scene.shape) == 1 else simulation.run(scene)


def run_by_restitution(scene: Scene, restitution: Real) -> ImpactResult:
    """Return the result of impacts under a restitution, one number or one for each."""
    if isinstance(restitution, float):
        return _run(scene, restitution)
    groups = _alike(restitution)
    if len(groups) == 1:
        return _run(scene, groups[0][1])
    parts = [(mask, _run(scene.take(mask), e)) for mask, e in groups]
    return ImpactResult(
        scene=scene,
        plan=Plan.merged([(mask, part.plan) for mask, part in parts], scene.shape),
        motion=Motion.merged([(mask, part.motion) for mask, part in parts], scene.shape),
        laws=parts[0][1].laws,
        run_time=sum(part.run_time for _, part in parts),
    )


def _run(scene: Scene, restitution: float) -> ImpactResult:
    """Return the result of impacts of one restitution."""
    if restitution >= LEAST_RESTITUTION:
        return run_in_blocks(_simulation(restitution), scene)
    return _hardly_rebounding(scene, restitution)


def _hardly_rebounding(scene: Scene, restitution: float) -> ImpactResult:
    """Return velocities of impacts of a restitution that no law has; the rest is NaN.

    Raises
    ------
    ValueError
        If friction changes the approach of any.
    """
    (_, part), *others = scene.parts()
    if others or part.inverse_mass is not None:
        rule = (
            f"must be from {LEAST_RESTITUTION} where friction changes the approach: steps lose a "
            "dashpot so strong"
        )
        remedy = f"take {LEAST_RESTITUTION}, from which psi2 is linear down to 0"
        raise refuse("restitution", restitution, rule, remedy)
    rate: Any = -restitution * np.asarray(part.normal_speed)
    psi2: Any = rebound(part.psi1, part.chi, restitution=restitution)
    change = (psi2 - part.psi1) / np.asarray(part.psi_scale)
    _, _, lost = part.energies(rate, change)
    entries: dict[str, Any] = dict.fromkeys(ENDS, np.nan) | {"normal_velocity": rate}
    motion = Motion(
        **{name: spread(entry, part.shape) for name, entry in entries.items()},
        slip_velocity_change=spread(change, part.shape),
        friction_work=spread(lost, part.shape),
        status=filled(Status.SUCCESS, part.shape),
    )
    if scene.slip_axes:
        motion = motion.turned(unit_slip(scene.slip_velocity))
    plan = planned(part, restitution)
    return ImpactResult(scene=scene, plan=plan, motion=motion, run_time=0.0, laws={})


def planned(scene: Scene, restitution: Real) -> Plan:
    """Return the plan of impacts that ``contactlab.rebound`` answers."""
    plan = _of_groups(attrs.evolve(scene, encounter=None, normal_spin=0.0), restitution)
    return Plan(plan.columns, lambda: with_normal_spin(plan.words, scene))


def _of_groups(scene: Scene, restitution: Real) -> Plan:
    """Return the plan of impacts, with the words of each restitution."""
    if isinstance(restitution, float):
        return _planned(scene, restitution, restitution)
    groups = _alike(restitution)
    if len(groups) > MOST_STATEMENTS:
        masks = [mask for mask in (restitution == 1.0, restitution < 1.0) if mask.any()]
        groups = [(mask, float(restitution[mask].min())) for mask in masks]
    plans = [(mask, _planned(scene.take(mask), value, restitution[mask])) for mask, value in groups]
    return Plan.merged(plans, scene.shape)


def _planned(scene: Scene, restitution: float, each: Real) -> Plan:
    """Return the plan of impacts, with the cautions of one restitution and the errors of each."""
    plan = _simulation(max(restitution, LEAST_RESTITUTION)).plan(scene)
    return plan if restitution == 1.0 else by_rebound(plan, scene.chi, each)


@lru_cache(maxsize=16)  # to compose laws takes as long as to solve an impact
def _simulation(restitution: float) -> Simulation:
    """Return laws with the answers of ``contactlab.rebound``."""
    return Simulation() if restitution == 1.0 else laws_of(restitution)


def _alike(restitution: Array) -> list[tuple[Any, float]]:
    """Return masks of equal restitutions, and the restitution of each mask."""
    return [(restitution == value, value) for value in np.unique(restitution).tolist()]
