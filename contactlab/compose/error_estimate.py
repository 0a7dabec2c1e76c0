"""An estimate of the numerical error of psi2, for any laws, from answers at finer resolutions."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from contactlab.compose import eccentric, solve
from contactlab.compose.composition import Laws
from contactlab.compose.planning import CLOSED_FORM
from contactlab.contracts.error_model import psi_magnitude
from contactlab.contracts.status import Status
from contactlab.impact.eccentric import EccentricScene
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real
from contactlab.outcome.answer import RunResult

#: A single count is multiplied by the first factor and by its square, several counts together, or
#: one that a law accepts no further, by the second: the finest run costs about sixteen times the
#: first.
SINGLE_COUNT, SEVERAL_COUNTS = 4, 2
#: A tolerance is divided by this times the square of the factor of the counts, as for a method of
#: second order. Steps are doubled until a tolerance is kept: a lesser change might change no step.
TOLERANCE = 4.0
#: Least and greatest error of the finest run, over the last change. After a doubling a method of
#: second order leaves a third of the change, one of first order all of it.
LEFT = 0.5, 1.0


def estimated(laws: Laws, result: RunResult) -> Real:
    """Return the estimated numerical error of psi2 of a result, of the scene's shape.

    In space the error of psi2 is the length of a vector.

    Each impact is run again at two finer resolutions of all laws that have a resolution: normal
    law, tangential law and, if the impact is marched, integrator. The estimate is the distance of
    psi2 from the finest answer, plus what the finest leaves by the ratio of the two changes, at
    least half the last change, and no less than rounding. If a tightened tolerance cannot be
    kept, the tolerance stays, and the estimate leaves out the error in time. The estimate never
    includes errors of the model. If the answers do not differ, or no law has a finer resolution,
    the estimate is what the plan declares. NaN where a run failed, and where nothing is declared
    and no resolution shows an error.
    """
    scene = result.scene
    successes = _successes(result.status)
    error = np.where(successes, result.plan.psi2_error, np.nan)
    marched = successes & result.plan.marched
    if isinstance(scene, EccentricScene):
        marched = successes  # an answer as a whole has the accuracy of its integrator
    resolutions = np.where(marched, _resolution(laws, scene) if np.any(marched) else 0.0, np.nan)
    change = np.asarray(result.motion.slip_velocity_change)
    # not np.unique, which imports numpy.ma
    for resolution in [*sorted(set(resolutions[marched].tolist())), None]:
        where = successes & ~marched
        if resolution is not None:
            where = marched & (resolutions == resolution)
        if np.any(where):
            part = scene.take(where) if scene.shape else scene
            distance = _distance(laws, part, resolution, change[where])
            error[where] = np.where(distance == 0.0, error[where], distance)
    return error if error.ndim else float(error)


def _resolution(laws: Laws, scene: Any) -> Any:
    """Return the resolution of the integrator for each impact; 0 if it has none."""
    central = _central(scene)
    normal = solve.normal_or_failed(laws, central)
    resolution = laws.integrator.resolution_for(normal, laws.tangential, central)
    return np.broadcast_to(resolution, scene.shape)


def _distance(laws: Laws, scene: Any, resolution: float | None, change: Any) -> Any:
    """Return the estimated error of psi2; 0 where no finer run is possible."""
    options = _options(laws, resolution)
    counts = {kind: value for kind, value in options.items() if isinstance(value, int)}
    factor = SINGLE_COUNT if len(options) == len(counts) == 1 else SEVERAL_COUNTS
    if _finer(laws, options, factor**2) is None:  # a law may refuse what is much finer
        factor = SEVERAL_COUNTS
    answers = []
    refined = {times: _finer(laws, options, times) for times in (factor, factor**2)}
    for times, finer in refined.items():
        if finer is None or refined[factor**2] is None:
            return np.zeros(scene.shape)
        answer = _change(finer, scene)
        with_tolerance = _finer(laws, counts, times) if counts else None
        if with_tolerance is not None and np.isnan(answer).any():  # it cannot be tightened
            answer = np.where(np.isnan(answer), _change(with_tolerance, scene), answer)
        answers.append(answer)
    fine, finest = answers
    last, before, all_of = (
        _size(scene, each) for each in (finest - fine, fine - change, finest - change)
    )
    # by a ratio, if the answers converge; steps of a tolerance fall by none
    falls = (before > last) & (len(options) == len(counts))
    ratio = last / np.where(falls, before - last, 1.0)
    left = np.where(falls, np.clip(ratio, *LEFT), LEFT[0])
    central = _central(scene)
    distance = central.psi(all_of + left * last)
    return np.where(
        distance > 0.0, np.maximum(distance, CLOSED_FORM * psi_magnitude(central)), distance
    )


def _change(laws: Laws, scene: Any) -> Any:
    """Return the change of slip velocity in m/s; NaN where the run failed."""
    if isinstance(scene, EccentricScene):
        return eccentric.run(laws, scene, None).slip_velocity_change
    _, motion = solve.outcome(laws, scene, False, None)
    return np.where(_successes(motion.status), motion.slip_velocity_change, np.nan)


def _central(scene: Any) -> Scene:
    """Return a central scene as it is; of an eccentric one the impact with the same approach."""
    central: Scene = scene.central if isinstance(scene, EccentricScene) else scene
    return central


def _size(scene: Any, change: Any) -> Any:
    """Return the magnitude of changes of slip velocity, of the scene's shape."""
    if isinstance(scene, EccentricScene):
        return np.hypot(change[..., 0], change[..., 1])
    return np.abs(change)


def _options(laws: Laws, resolution: float | None) -> dict[str, Any]:
    """Return the value of each resolution by kind of law; ``resolution`` is the integrator's."""
    options = {}
    for kind, law in laws._asdict().items():
        if law.resolution is None or (kind == "integrator" and resolution is None):
            continue
        value = getattr(law, law.resolution)
        options[kind] = type(value)(resolution) if kind == "integrator" else value
    return options


def _finer(laws: Laws, options: dict[str, Any], times: int) -> Laws | None:
    """Return the laws with counts ``times`` as large; None without options, or if a law refuses."""
    changed = {}
    for kind, value in options.items():
        law: Any = getattr(laws, kind)
        finer = value * times if isinstance(value, int) else value / (TOLERANCE * times**2)
        try:
            changed[kind] = attrs.evolve(law, **{law.resolution: finer})
        except ValueError:  # beyond what the law allows
            return None
    return laws._replace(**changed) if changed else None


def _successes(status: Any) -> Any:
    return np.asarray(status, dtype=object) == Status.SUCCESS
