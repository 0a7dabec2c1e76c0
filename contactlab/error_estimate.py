"""An estimate of the numerical error of psi2, for any laws, from answers at other resolutions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import attrs
import numpy as np

from contactlab.checks import Real
from contactlab.status import Status

if TYPE_CHECKING:
    from contactlab.result import ImpactResult
    from contactlab.simulation import Simulation

#: By how much a resolution is changed: a count is doubled, a tolerance divided by this.
COUNT, TOLERANCE = 2, 16.0
#: The order of convergence is believed between these.
LEAST_ORDER, MOST_ORDER = 1.0, 2.0


def estimated(simulation: Simulation, result: ImpactResult) -> Real:
    """Return the estimated numerical error of psi2 of a result.

    The scene is run again at half and at twice the resolution of integrator and tangential law
    together. If the change of psi2 falls by r from one doubling to the next the error that is left
    is the last change over 1 - 1/r, r = 2 for a method of first order and 4 for one of second. The
    errors of the model are not in it. What has no resolution, and is known in closed form, has
    the error that the plan declares.

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
    fine, coarse = _at(simulation, 1), _at(simulation, -1)
    if fine is None:
        return result.plan.psi2_error
    better = fine.run(scene)
    here = np.asarray(result.motion.slip_velocity_change)
    last = np.abs(np.asarray(better.motion.slip_velocity_change) - here)
    ratio: Any = COUNT**MOST_ORDER
    good = _successes(result) & _successes(better)
    if coarse is not None:
        worse = coarse.run(scene)
        first = np.abs(here - np.asarray(worse.motion.slip_velocity_change))
        with np.errstate(all="ignore"):
            found = np.where(last > 0.0, first / last, ratio)
        found = np.where(_successes(worse), found, COUNT**LEAST_ORDER)
        ratio = np.clip(found, COUNT**LEAST_ORDER, COUNT**MOST_ORDER)
    with np.errstate(all="ignore"):
        error = np.abs(scene.psi(last / (1.0 - 1.0 / ratio)))
        # Answers that do not differ at all say nothing: what is declared stands.
        error = np.where(result.plan.marched & (last > 0.0), error, result.plan.psi2_error)
        error = np.where(good, error, np.nan)
    return float(error) if not error.ndim else error


def _successes(result: ImpactResult) -> Any:
    return np.asarray(result.status, dtype=object) == Status.SUCCESS


def _at(simulation: Simulation, doublings: int) -> Simulation | None:
    """Return the simulation at twice, or half, the resolution; None if there is none."""
    changed: dict[str, Any] = {}
    for kind in ("tangential", "integrator"):
        law: Any = getattr(simulation, kind)
        if law.resolution is None:
            continue
        value = getattr(law, law.resolution)
        if isinstance(value, int):
            other: Any = max(round(value * float(COUNT) ** doublings), 1)
        elif doublings < 0:
            return None  # a looser tolerance says nothing of the error at this one
        else:
            other = value / TOLERANCE
        try:
            changed[kind] = attrs.evolve(law, **{law.resolution: other})
        except ValueError:  # beyond what the law allows
            continue
    return attrs.evolve(simulation, **changed) if changed else None
