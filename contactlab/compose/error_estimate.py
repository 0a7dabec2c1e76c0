"""An estimate of the numerical error of psi2, for any laws, from answers at other resolutions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from contactlab.contracts.error_model import psi_magnitude
from contactlab.contracts.status import Status
from contactlab.numeric.checks import Real

if TYPE_CHECKING:
    from contactlab.compose.simulation import Simulation
    from contactlab.impact.scene import Scene
    from contactlab.outcome.result import ImpactResult

#: By how much a resolution is changed: a count is doubled, a tolerance divided by this.
COUNT, TOLERANCE = 2, 16.0
#: The order of convergence is believed between these.
LEAST_ORDER, MOST_ORDER = 1.0, 2.0


def estimated(simulation: Simulation, result: ImpactResult) -> Real:
    """Return the estimated numerical error of psi2 of a result.

    Each impact is run again at half and at twice the resolution that it got, of integrator and
    tangential law together. If the change of psi2 falls by r from one doubling to the next the
    error that is left is the last change over 1 - 1/r, r = 2 for a method of first order and 4 for
    one of second; 2 too where the second change turns back, and no order shows. Of an integrator
    with a tolerance that is the error in time, and the resolution of the law alone is changed, if
    it has one. The errors of the model are not in it. What has no resolution, and is known in
    closed form, has the error that the plan declares.

    Parameters
    ----------
    simulation : Simulation
    result : ImpactResult

    Returns
    -------
    float or array
        NaN where one of the runs failed.
    """
    scene = result.scene
    successes = _successes(result)
    error = np.where(successes, result.plan.psi2_error, np.nan)
    marched = successes & result.plan.marched
    got = _resolution(simulation, scene) if np.any(marched) else np.zeros(scene.shape)
    change = np.asarray(result.motion.slip_velocity_change)
    for value in np.unique(got[marched]).tolist():
        where = marched & (got == value)
        left = _left(simulation, scene.take(where) if scene.shape else scene, value, change[where])
        # Answers that do not differ at all say nothing: what is declared stands.
        error[where] = np.where(left == 0.0, error[where], left)
    return error if error.ndim else float(error)


def _resolution(simulation: Simulation, scene: Scene) -> Any:
    """Return the resolution of the integrator that each impact gets; 0 of one without."""
    integrator = simulation.integrator
    normal = simulation.normal_motion(scene)
    got = integrator.resolution_for(normal, simulation.tangential, scene)
    return np.broadcast_to(got, scene.shape)


def _left(simulation: Simulation, scene: Scene, resolution: float, change: Any) -> Any:
    """Return the estimated error of impacts that all got one resolution; 0 where they have none.

    Parameters
    ----------
    simulation : Simulation
    scene : Scene
    resolution : float
        Of the integrator.
    change : array
        Change of slip velocity, in m/s.
    """
    fine, coarse = (_at(simulation, resolution, doublings) for doublings in (1, -1))
    if fine is None:
        return np.zeros(change.shape)
    better = fine.run(scene)
    last = np.asarray(better.motion.slip_velocity_change) - change
    ratio: Any = COUNT**MOST_ORDER
    if coarse is not None:
        ratio = COUNT**LEAST_ORDER
        if _gets_what_it_asks(coarse, scene):
            worse = coarse.run(scene)
            first = change - np.asarray(worse.motion.slip_velocity_change)
            with np.errstate(all="ignore"):
                found = np.where(last != 0.0, first / last, COUNT**MOST_ORDER)
            found = np.where(_successes(worse), found, COUNT**LEAST_ORDER)
            ratio = np.clip(found, COUNT**LEAST_ORDER, COUNT**MOST_ORDER)
    with np.errstate(all="ignore"):
        error = np.abs(scene.psi(last / (1.0 - 1.0 / ratio)))
    if fine.integrator == simulation.integrator and simulation.integrator.resolution:
        error = error + resolution * psi_magnitude(scene)  # the tolerance that was kept
    return np.where(_successes(better), error, np.nan)


def _gets_what_it_asks(simulation: Simulation, scene: Scene) -> bool:
    """Return whether the integrator has as many steps as asked for, raised for no impact."""
    integrator = simulation.integrator
    asked = getattr(integrator, integrator.resolution) if integrator.resolution else 0.0
    return bool(np.all(_resolution(simulation, scene) == asked))


def _successes(result: ImpactResult) -> Any:
    return np.asarray(result.status, dtype=object) == Status.SUCCESS


def _at(simulation: Simulation, resolution: float, doublings: int) -> Simulation | None:
    """Return the simulation at twice, or half, the resolution; None if there is none.

    ``resolution`` is what the integrator got; the law has that of its option. A tolerance is kept
    where the law has a resolution.
    """
    changed: dict[str, Any] = {}
    for kind in ("tangential", "integrator"):
        law: Any = getattr(simulation, kind)
        if law.resolution is None:
            continue
        value = getattr(law, law.resolution)
        if kind == "integrator":
            value = type(value)(resolution)
        if isinstance(value, int):
            other: Any = max(round(value * float(COUNT) ** doublings), 1)
        elif changed:
            continue
        elif doublings < 0:
            return None  # a looser tolerance says nothing of the error at this one
        else:
            other = value / TOLERANCE
        try:
            changed[kind] = attrs.evolve(law, **{law.resolution: other})
        except ValueError:  # beyond what the law allows
            continue
    return attrs.evolve(simulation, **changed) if changed else None
