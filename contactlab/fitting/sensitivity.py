"""What the intervals of a fit do not hold: cautions of its scenes, and assumptions of its laws."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose.rebound import damped
from contactlab.compose.simulation import Simulation
from contactlab.fitting import tabulated
from contactlab.fitting.measurements import Measurements
from contactlab.fitting.problem import Problem, solved
from contactlab.impact.coupling import coupling_shift
from contactlab.outcome.columns import QUANTITIES

Array = NDArray[np.float64]

#: Shifts below this part of a parameter's standard error are not told.
LEAST_PART = 0.1
#: Restitution of the lossy law that is tried where none was measured.
LOSSY = 0.9
#: Restitutions of the laws that would serve a measured one, by their plug-in names.
SERVING = ("tsuji", "hunt_crossley", "kuwabara_kono", "walton_braun")
#: A measured restitution is below 1 by more than this.
ELASTIC = 0.02


def cautions(
    problem: Problem, table: Measurements, values: Array, errors: Sequence[float]
) -> tuple[str, ...]:
    """Return the cautions of the fitted scenes, and what shifts the parameters beyond them.

    Parameters
    ----------
    problem : Problem
    table : Measurements
    values : array, shape (parameters,)
        The best values.
    errors : sequence of float
        Their standard errors.
    """
    setup = problem.model.setup
    for parameter, value in zip(problem.model.parameters, values.tolist(), strict=True):
        setup = parameter.applied(setup, value)
    simulation = setup.simulation or Simulation()
    told = [str(caution) for caution in simulation.plan(setup.scene).cautions]
    shifts = {
        "the coupling of unlike bodies, which is left out,": _by_coupling(problem, setup, values),
        "angles of incidence 1 degree greater": _by_angle(problem, table, values),
        f"a normal restitution of {LOSSY:g} in place of 1": _by_loss(problem, values),
    }
    for cause, shift in shifts.items():
        words = [
            f"{parameter.name} by {by:+.2g}"
            for parameter, by, error in zip(problem.model.parameters, shift, errors, strict=True)
            if abs(by) > LEAST_PART * error
        ]
        if words:
            told.append(f"not in the intervals: {cause} would move {', '.join(words)}")
    return tuple(told)


def _moved(problem: Problem, values: Array, shifted: Mapping[str, Array]) -> Array:
    """Return how far the parameters move where the predictions move by ``shifted``."""
    scales = problem.scales(problem.residuals(values[None]))
    _, jacobian = problem.linearised(values, scales)
    present = {name: np.isfinite(numbers) for name, numbers in problem.measured.items()}
    change = np.concatenate(
        [
            (np.broadcast_to(shifted[name] / scales[name], here.shape))[here]
            for name, here in present.items()
        ]
    )
    return np.asarray(np.linalg.lstsq(jacobian, np.nan_to_num(change), rcond=None)[0])


def _by_coupling(problem: Problem, setup: Any, values: Array) -> Array:
    """Return the shift by elastic coupling, whose size is known by a table; it lowers psi2."""
    scene, nothing = setup.scene, np.zeros(len(values))
    if not np.any(scene.pair.dundurs_beta) or not tabulated.holds(setup.simulation):
        return nothing
    result = tabulated.impacts(scene, setup.simulation)
    unit = np.sign(scene.psi1) / np.asarray(scene.psi_scale)
    change = result.motion.slip_velocity_change - coupling_shift(scene) * unit
    moved = attrs.evolve(result, motion=attrs.evolve(result.motion, slip_velocity_change=change))
    shifted = {
        name: QUANTITIES[name].of(moved) - QUANTITIES[name].of(result) for name in problem.measured
    }
    return _moved(problem, values, shifted)


def _by_angle(problem: Problem, table: Measurements, values: Array) -> Array:
    """Return the shift by angles of incidence that are all one degree greater."""
    scene = problem.model.setup.scene
    if "angle_deg" not in table.given or scene.sphere is None:
        return np.zeros(len(values))
    angle, more = np.arctan2(scene.tangential_velocity, scene.normal_speed), np.radians(1.0)
    speed = np.hypot(scene.tangential_velocity, scene.normal_speed)
    steep = np.minimum(angle + more, 0.5 * np.pi - more)
    tilted = attrs.evolve(
        scene, normal_speed=speed * np.cos(steep), tangential_velocity=speed * np.sin(steep)
    )
    names = list(problem.measured)
    there = problem.model.at(tilted).predicted(values[None], names)
    here = problem.model.predicted(values[None], names)
    return _moved(problem, values, {name: there[name][0] - here[name][0] for name in names})


def _by_loss(problem: Problem, values: Array) -> Array:
    """Return the shift by a lossy normal law, where the law is elastic by its table."""
    setup = problem.model.setup
    if setup.simulation is not None or "normal_restitution" in problem.measured:
        return np.zeros(len(values))
    lossy = setup._replace(simulation=Simulation(normal=damped(LOSSY).normal))
    model = attrs.evolve(problem.model, setup=lossy)
    return np.asarray(solved(attrs.evolve(problem, model=model), values) - values)


def serving(problem: Problem, measured: Mapping[str, Array], values: Array) -> list[str]:
    """Return a sentence where a restitution below 1 was measured and the law is elastic."""
    setup, numbers = problem.model.setup, measured.get("normal_restitution")
    if numbers is None or setup.simulation is not None:
        return []
    mean = float(np.nanmean(numbers))
    if not 0.1 < mean < 1.0 - ELASTIC:
        return []
    laws = ", ".join(SERVING)
    start = (
        f"normal_restitution is {mean:.3g} on average, and the law is elastic: a lossy normal law "
        f"would serve ({laws}, with restitution = {mean:.3g} or fitted as normal.restitution)"
    )
    rest = {name: v for name, v in problem.measured.items() if name != "normal_restitution"}
    if not rest:
        return [start]
    lossy = setup._replace(simulation=Simulation(normal=damped(mean).normal))
    model = attrs.evolve(problem.model, setup=lossy)
    errors = {name: e for name, e in problem.errors.items() if name in rest}
    best = solved(attrs.evolve(problem, model=model, measured=rest, errors=errors), values)
    given = ", ".join(
        f"{parameter.name} = {value:.4g}"
        for parameter, value in zip(model.parameters, best.tolist(), strict=True)
    )
    return [f"{start}; tsuji gives {given}"]
