"""Estimates of the numerical errors of an answer, for any laws, from finer resolutions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.integrator import resolution_for
from contactlab.contracts.law import Law
from contactlab.contracts.status import Status, Statuses
from contactlab.impact import kinetics
from contactlab.impact.error_model import psi_magnitude
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import plain
from contactlab.numeric.types import Array, Mask, Real
from contactlab.outcome.motion import Motion
from contactlab.outcome.result import ImpactResult
from contactlab.registry.composition import Laws
from contactlab.solve import solve
from contactlab.solve.decoupled import CLOSED_FORM
from contactlab.solve.normal_motion import try_normal

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


def estimate_errors(laws: Laws, result: ImpactResult) -> tuple[Real, Real]:
    """Return the estimated numerical errors of psi2 and of the normal restitution of a result.

    Both have the scene's shape. In space the error of psi2 is the length of a vector.

    Each impact is run again at two finer resolutions of all laws that have a resolution: normal
    law, tangential law and, if the impact is marched, integrator. The estimate is the distance from
    the finest answer, plus what the finest leaves by the ratio of the two changes, at least half
    the last change, and no less than rounding. If a tightened tolerance cannot be kept, the
    tolerance stays, and the estimate leaves out the error in time. The estimate never includes
    errors of the model. If the answers do not differ, or no law has a finer resolution, the
    estimate is what the plan declares. NaN where a run failed, and where nothing is declared and
    no resolution shows an error.
    """
    scene, plan, motion = result.scene, result.plan, result.motion
    errors = np.array(np.broadcast_arrays(plan.psi2_error, plan.restitution_error))
    errors = np.where(_successes(result.status), np.broadcast_to(errors, (2, *scene.shape)), np.nan)
    answer, successes = _answer(scene, motion), _successes(result.status)
    for way in solve.ways(laws, scene, as_one=bool(result.history)):
        where, part, used = way
        ended = successes[where]
        refined = ended & (plan.marched[where] | way.as_integrator)
        mine = errors[:, where]
        _fill(used, scene.take(where), part, mine, answer[:, where], refined, ended & ~refined)
        errors[:, where] = mine
    psi2, restitution = (plain(each) for each in errors)
    return psi2, restitution


def _fill(
    laws: Laws,
    scene: Scene,
    part: Scene,
    errors: Array,
    answer: NDArray[np.complex128],
    marched: Mask,
    left: Mask,
) -> None:
    """Write the errors of impacts that are solved alike, by the resolution that each has."""
    resolutions = np.full(scene.shape, np.nan)
    if np.any(marched):
        resolutions = np.where(marched, _resolution(laws, part), np.nan)
    # not np.unique, which imports numpy.ma
    for resolution in [*sorted(set(resolutions[marched].tolist())), None]:
        where = left if resolution is None else marched & (resolutions == resolution)
        if np.any(where):
            place: Any = where if scene.shape else ...
            distance = _distance(laws, scene.take(place), resolution, answer[:, place])
            errors[:, place] = np.where(distance == 0.0, errors[:, place], distance)


def _resolution(laws: Laws, scene: Scene) -> Array:
    """Return the resolution of the integrator for each impact; 0 if it has none."""
    normal = try_normal(laws, scene.central)
    resolution = resolution_for(laws.integrator, scene, normal, laws.tangential)
    return np.broadcast_to(resolution, scene.shape)


def _distance(
    laws: Laws, scene: Scene, resolution: float | None, answer: NDArray[np.complex128]
) -> Array:
    """Return the estimated errors, shape (2, ...); 0 where no finer run is possible."""
    options = _options(laws, resolution)
    counts = {kind: value for kind, value in options.items() if _counts(getattr(laws, kind))}
    factor = SINGLE_COUNT if len(options) == len(counts) == 1 else SEVERAL_COUNTS
    if _finer(laws, options, factor**2) is None:  # a law may refuse what is much finer
        factor = SEVERAL_COUNTS
    answers = []
    refined = {times: _finer(laws, options, times) for times in (factor, factor**2)}
    for times, finer in refined.items():
        if finer is None or refined[factor**2] is None:
            return np.zeros((2, *scene.shape))
        found = _run_finer(finer, scene)
        with_tolerance = _finer(laws, counts, times) if counts else None
        if with_tolerance is not None and np.isnan(found).any():  # it cannot be tightened
            found = np.where(np.isnan(found), _run_finer(with_tolerance, scene), found)
        answers.append(found)
    fine, finest = answers
    last, before, all_of = (
        np.abs(each) for each in (finest - fine, fine - answer, finest - answer)
    )
    # answers of counts converge by a ratio; those of a tolerance need not
    falls = (before > last) & (len(options) == len(counts))
    ratio = last / np.where(falls, before - last, 1.0)
    left = np.where(falls, np.clip(ratio, *LEFT), LEFT[0])
    distance = all_of + left * last
    central = scene.central
    distance[0] = central.psi(distance[0])
    distance[1] = distance[1] / scene.normal_speed
    least = CLOSED_FORM * np.stack(
        np.broadcast_arrays(psi_magnitude(central), np.ones(scene.shape))
    )
    errors: Array = np.where(distance > 0.0, np.maximum(distance, least), distance)
    return errors


def _run_finer(laws: Laws, scene: Scene) -> NDArray[np.complex128]:
    """Return the answer of finer laws, NaN where the run failed."""
    _, motion = solve.outcome(solve.ways(laws, scene), scene, False, None)
    answer = _answer(scene, motion)
    return np.where(_successes(motion.status), answer, np.nan)


def _answer(scene: Scene, motion: Motion) -> NDArray[np.complex128]:
    """Return slip (as a complex number) and rate of approach after impacts, shape (2, ...)."""
    change = np.asarray(motion.slip_velocity_change)
    if kinetics.slip_axes(scene):
        change = change[..., 0] + 1j * change[..., 1]
    rate = np.broadcast_to(motion.normal_velocity, scene.shape)
    return np.stack((np.broadcast_to(change, scene.shape), rate)).astype(complex)


def _options(laws: Laws, resolution: float | None) -> dict[str, Any]:
    """Return the value of each resolution by kind of law; ``resolution`` is the integrator's."""
    options = {}
    for kind, law in laws.by_kind().items():
        if law.resolution is None or (kind == "integrator" and resolution is None):
            continue
        value = getattr(law, law.resolution)
        options[kind] = type(value)(resolution) if kind == "integrator" else value
    return options


def _finer(laws: Laws, options: Mapping[str, float], times: int) -> Laws | None:
    """Return the laws with counts ``times`` as large; None without options, or if a law refuses."""
    changed = {}
    for kind, value in options.items():
        law = getattr(laws, kind)
        finer = value * times if _counts(law) else value / (TOLERANCE * times**2)
        try:
            changed[kind] = attrs.evolve(law, **{law.resolution: finer})
        except ValueError:  # beyond what the law allows
            return None
    return laws.change(**changed) if changed else None


def _counts(law: Law) -> bool:
    """Return whether the resolution of a law is a count, finer the greater."""
    return law.resolution != "tolerance"


def _successes(status: Statuses) -> NDArray[np.bool_]:
    found: NDArray[np.bool_] = np.asarray(status, dtype=object) == Status.SUCCESS
    return found
