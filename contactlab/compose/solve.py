"""The outcome of a scene under three laws: plan and motion, from what is known and what is not."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.compose.answers import Answer, answers, show
from contactlab.compose.composition import Laws
from contactlab.compose.marching import march
from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.planning import make_plan
from contactlab.compose.registry import REGISTRY
from contactlab.compose.solved_motion import FailedMotion
from contactlab.contracts import faults
from contactlab.contracts.integrator import TangentialMotion
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import filled, halves
from contactlab.numeric.checks import refuse
from contactlab.outcome.energy import balanced
from contactlab.outcome.history import Recorder
from contactlab.outcome.motion import Motion, sound
from contactlab.outcome.plan import Plan

#: Friction work over the energy at the start is this many times less accurate than psi2.
WORK_ACCURACY = 10.0


class Prepared(NamedTuple):
    """What comes before the march: the normal motion, whole-impact answers, and the plan."""

    normal: NormalMotion
    known: list[Answer]
    plan: Plan


@np.errstate(under="ignore")  # small numbers may vanish, whatever a user has asked for
def outcome(
    laws: Laws, scene: Scene, history: bool | str, recorder: Recorder | None
) -> tuple[Plan, Motion]:
    """Return plan and motion; a law that raises in a batch costs those impacts only.

    Parameters
    ----------
    laws : Laws
    scene : Scene
    history : bool or "fields"
        What the plan is to say of a history.
    recorder : Recorder or None
        What keeps it.

    Raises
    ------
    ValueError
        If a history is asked of a batch whose impacts have instants of their own.
    """
    shape = scene.shape
    if history and shape and not laws.integrator.common_instants:
        raise refuse(
            "history",
            history,
            f"impacts of a batch have instants of their own under {laws.integrator!r}",
            "run them one by one",
        )
    try:
        prepared = prepare(laws, scene, history)
    except faults.LawFaultError as fault:
        if recorder is None and math.prod(shape) > 1:
            return _by_halves(laws, scene)
        return Plan.nothing(shape), _named(laws, Motion.nothing(shape, fault.status, fault.detail))
    if isinstance(prepared.normal, FailedMotion) and math.prod(shape) > 1:
        return _by_halves(laws, scene)
    tangential = _tangential(laws, prepared, recorder)
    motion = sound(Motion.along(prepared.normal, tangential))
    # What the books may miss by: the law's own bound, and the integrator's share.
    bound = laws.tangential.books_bound + WORK_ACCURACY * (laws.integrator.accuracy or 0.0)
    return prepared.plan, _named(laws, balanced(motion, scene, bound))


def _named(laws: Laws, motion: Motion) -> Motion:
    """Return the motion, its sentences with the distribution of the law that each blames."""
    if not (motion.detail if isinstance(motion.detail, str) else np.any(motion.detail)):
        return motion

    def named(sentence: str) -> str:
        for law in laws:
            blamed = f", from {type(law).__name__}."
            sentence = sentence.replace(blamed, f"{blamed[:-1]}, {REGISTRY.describe(law)}.")
        return sentence

    detail: Any = motion.detail
    if isinstance(detail, np.ndarray):
        detail = np.array([named(one) for one in detail.ravel()], dtype=object).reshape(
            detail.shape
        )
    else:
        detail = named(detail)
    return attrs.evolve(motion, detail=detail)


def prepare(laws: Laws, scene: Scene, history: bool | str) -> Prepared:
    """Return what comes before the march.

    Raises
    ------
    LawFaultError
        If a law raises where it is asked what it knows.
    """
    with np.errstate(under="ignore"):
        normal = normal_or_failed(laws, scene)
        with faults.blaming(laws.tangential):
            known = answers(scene, normal, laws.tangential, history=history)
            return Prepared(normal, known, make_plan(scene, normal, laws, known, history=history))


def normal_or_failed(laws: Laws, scene: Scene) -> NormalMotion:
    """Return the normal motion of ``scene``; of a law that fails one of which nothing is known."""
    try:
        return normal_motion(laws.normal, scene)
    except faults.LawFaultError as fault:
        return FailedMotion(laws.normal, scene, fault.status, fault.detail)


def _by_halves(laws: Laws, scene: Scene) -> tuple[Plan, Motion]:
    """Return plan and motion of a batch, half by half, down to the impacts that fail."""
    shape = scene.shape
    parts = [outcome(laws, scene.take(half), False, None) for half in halves(shape)]
    plans, motions = zip(*parts, strict=True)
    return Plan.joined(plans, shape), Motion.joined(motions, shape)


def _tangential(laws: Laws, prepared: Prepared, recorder: Recorder | None) -> TangentialMotion:
    """Return the tangential motion: what is known as a whole, and the rest marched."""
    normal, known, plan = prepared
    shape, marched = normal.scene.shape, plan.marched
    if marched.all():
        return march(laws, normal, recorder)
    if recorder is not None and not marched.any():
        show(normal, known, recorder)
    if not shape:
        if not known:
            return TangentialMotion.nothing((), normal.status, normal.detail)
        answer = known[0].known
        return TangentialMotion(
            slip_velocity_change=float(answer.slip_velocity_change),
            friction_work=float(answer.friction_work),
        )
    nothing = TangentialMotion.nothing(shape, Status.NOT_SEPARATED)
    nothing = attrs.evolve(nothing, status=normal.status, detail=normal.detail)
    parts: list[tuple[Any, TangentialMotion]] = [(np.ones(shape, dtype=bool), nothing)]
    parts += [(answer.where, _answered(answer, shape)) for answer in known]
    if marched.any():
        parts.append((marched, march(laws, normal.take(marched))))
    return TangentialMotion.merged(parts, shape)


def _answered(answer: Answer, shape: tuple[int, ...]) -> TangentialMotion:
    """Return the tangential motion of those impacts of a batch that an answer is taken for."""
    change, work = (
        np.broadcast_to(np.asarray(entry, dtype=np.float64), shape)[answer.where]
        for entry in (answer.known.slip_velocity_change, answer.known.friction_work)
    )
    return TangentialMotion(
        slip_velocity_change=change,
        friction_work=work,
        status=filled(Status.SUCCESS, change.shape),
    )
