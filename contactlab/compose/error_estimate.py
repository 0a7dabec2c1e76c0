"""An estimate of the numerical error of psi2, for any laws, from answers at finer resolutions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from contactlab.compose.planning import CLOSED_FORM
from contactlab.contracts.error_model import psi_magnitude
from contactlab.contracts.status import Status
from contactlab.numeric.checks import Real

if TYPE_CHECKING:
    from contactlab.compose.simulation import Simulation
    from contactlab.impact.scene import Scene
    from contactlab.outcome.result import ImpactResult

#: A count that is refined alone is multiplied by this factor and by its square, several counts
#: together by the lesser factor: the finest run costs about sixteen times the first.
ALONE, TOGETHER = 4, 2
#: A tolerance is divided by this times the square of the lesser factor, as for a method of second
#: order. Steps are doubled until a tolerance is kept: a lesser change might change no step.
TOLERANCE = 4.0
#: Share of the last change that the finest run is taken to be off by. A method of second order
#: leaves a third of the change of a doubling, one of first order all of it.
LEFT = 0.5


def estimated(simulation: Simulation, result: ImpactResult) -> Real:
    """Return the estimated numerical error of psi2 of a result, of the scene's shape.

    Each impact is run again at two finer resolutions, of all laws that have one: normal law,
    tangential law and, where it marches the impact, integrator. The estimate is the distance of
    psi2 from the finest answer, plus half the last change, and no less than rounding. No order of
    convergence is assumed. A tolerance that cannot be kept when it is tightened stays, and the
    error in time is not in the estimate then. Nor are the errors of the model. Where the answers
    do not differ, or no law has a finer resolution, the estimate is what the plan declares.

    Parameters
    ----------
    simulation : Simulation
    result : ImpactResult

    Returns
    -------
    float or array
        NaN where a run failed, and where nothing is declared and no resolution shows an error.
    """
    scene = result.scene
    successes = _successes(result)
    error = np.where(successes, result.plan.psi2_error, np.nan)
    marched = successes & result.plan.marched
    got = np.where(marched, _resolution(simulation, scene) if np.any(marched) else 0.0, np.nan)
    change = np.asarray(result.motion.slip_velocity_change)
    for value in [*np.unique(got[marched]).tolist(), None]:
        where = successes & ~marched if value is None else marched & (got == value)
        if np.any(where):
            part = scene.take(where) if scene.shape else scene
            found = _distance(simulation, part, value, change[where])
            error[where] = np.where(found == 0.0, error[where], found)
    return error if error.ndim else float(error)


def _resolution(simulation: Simulation, scene: Scene) -> Any:
    """Return the resolution of the integrator that each impact gets; 0 of one without."""
    integrator = simulation.integrator
    normal = simulation.normal_motion(scene)
    got = integrator.resolution_for(normal, simulation.tangential, scene)
    return np.broadcast_to(got, scene.shape)


def _distance(simulation: Simulation, scene: Scene, resolution: float | None, change: Any) -> Any:
    """Return the estimated error of psi2 of impacts; 0 where no finer run is possible.

    Parameters
    ----------
    simulation : Simulation
    scene : Scene
    resolution : float or None
        That all impacts got of the integrator; None for impacts that were not marched.
    change : array
        Change of slip velocity, in m/s.
    """
    options = _options(simulation, resolution)
    counts = {kind: value for kind, value in options.items() if isinstance(value, int)}
    factor = ALONE if len(options) == len(counts) == 1 else TOGETHER
    answers = []
    for times in (factor, factor**2):
        finer = _finer(simulation, options, times)
        if finer is None:
            return np.zeros(change.shape)
        found = _change(finer, scene)
        coarser = _finer(simulation, counts, times) if counts else None
        if coarser is not None and np.isnan(found).any():  # the tolerance cannot be tightened
            found = np.where(np.isnan(found), _change(coarser, scene), found)
        answers.append(found)
    fine, finest = answers
    distance = scene.psi(np.abs(finest - change) + LEFT * np.abs(finest - fine))
    return np.where(
        distance > 0.0, np.maximum(distance, CLOSED_FORM * psi_magnitude(scene)), distance
    )


def _change(simulation: Simulation, scene: Scene) -> Any:
    """Return the change of slip velocity in m/s; NaN where the run failed."""
    result = simulation.run(scene)
    return np.where(_successes(result), result.motion.slip_velocity_change, np.nan)


def _options(simulation: Simulation, resolution: float | None) -> dict[str, Any]:
    """Return the value of each resolution that has a part in the answer, by the kind of its law."""
    found = {}
    for kind in ("normal", "tangential", "integrator"):
        law: Any = getattr(simulation, kind)
        if law.resolution is None or (kind == "integrator" and resolution is None):
            continue
        value = getattr(law, law.resolution)
        found[kind] = type(value)(resolution) if kind == "integrator" else value
    return found


def _finer(simulation: Simulation, options: dict[str, Any], times: int) -> Simulation | None:
    """Return the simulation with finer resolutions; None if there are none, or a law refuses.

    Parameters
    ----------
    simulation : Simulation
    options : mapping of str to int or float
        As of ``_options``.
    times : int
        What a count is multiplied by.
    """
    changed = {}
    for kind, value in options.items():
        law: Any = getattr(simulation, kind)
        other = value * times if isinstance(value, int) else value / (TOLERANCE * times**2)
        try:
            changed[kind] = attrs.evolve(law, **{law.resolution: other})
        except ValueError:  # beyond what the law allows
            return None
    return attrs.evolve(simulation, **changed) if changed else None


def _successes(result: ImpactResult) -> Any:
    return np.asarray(result.status, dtype=object) == Status.SUCCESS
