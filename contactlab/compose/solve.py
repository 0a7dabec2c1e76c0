"""The outcome of a scene under three laws: plan and motion, by whole-impact answers or a march."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.compose.answers import Answer, answers, show
from contactlab.compose.composition import Laws
from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.pieces import Chunk, Piece
from contactlab.compose.planning import columns_of
from contactlab.compose.registry import REGISTRY
from contactlab.compose.solved_motion import FailedMotion
from contactlab.contracts import faults
from contactlab.contracts.integrator import Observer, TangentialMotion
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.sampled_motion import Ends
from contactlab.contracts.status import Status, succeeded
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import consecutive, every, some
from contactlab.numeric.checks import refuse
from contactlab.outcome.energy import balanced
from contactlab.outcome.history import Recorder
from contactlab.outcome.motion import Motion, sound
from contactlab.outcome.plan import PlanColumns

#: Friction work over the energy at the start is this many times less accurate than psi2.
WORK_ACCURACY = 10.0
#: A failed batch of at most so many impacts is marched one by one; a larger batch is halved first.
ONE_BY_ONE = 8


class Prepared(NamedTuple):
    """Normal motion, whole-impact answers and columns of the plan, made before the march."""

    normal: NormalMotion
    known: list[Answer]
    columns: PlanColumns
    books_bound: Any


@np.errstate(under="ignore")  # small numbers may vanish, whatever a user has asked for
def outcome(
    laws: Laws, scene: Scene, history: bool | str, recorder: Recorder | None
) -> tuple[PlanColumns, Motion]:
    """Return columns of the plan, and motion; a law that raises costs its impacts only.

    Numbers of impacts that failed are what the laws made of them. A history of a batch is refused
    if its impacts have instants of their own.
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
        nothing = PlanColumns.nothing(shape)
        return nothing, _named(laws, Motion.nothing(shape, fault.status, fault.detail))
    if isinstance(prepared.normal, FailedMotion) and math.prod(shape) > 1:
        return _by_halves(laws, scene)
    tangential = _tangential(laws, prepared, recorder)
    motion = sound(Motion.along(prepared.normal, tangential))
    # Bound of the imbalance of the energy books: the law's own, and the integrator's share.
    bound = prepared.books_bound + WORK_ACCURACY * (laws.integrator.accuracy or 0.0)
    motion = balanced(motion, scene, bound)
    return prepared.columns, motion if succeeded(motion.status) else _named(laws, motion)


def solved(laws: Laws, scene: Scene, chunk: Chunk, block: int) -> Piece:
    """Return the piece of a sweep's chunk, a block at a time; ``scene`` is the chunk alone."""
    ends = range(0, chunk.size, block)
    scenes = (scene.take(slice(first, min(first + block, chunk.size))) for first in ends)
    columns, motions = zip(*(outcome(laws, each, False, None) for each in scenes), strict=True)
    shape = (chunk.size,)
    return Piece(chunk, PlanColumns.joined(columns, shape), Motion.joined(motions, shape))


def _named(laws: Laws, motion: Motion) -> Motion:
    """Return the motion, its sentences with the distribution of the law that each blames."""
    names = [(type(law).__name__, REGISTRY.describe(law)) for law in laws]

    def named(sentence: str) -> str:
        for name, described in names:
            sentence = sentence.replace(f", from {name}.", f", from {name}, {described}.")
        return sentence

    detail: Any = motion.detail
    if isinstance(detail, str):
        return attrs.evolve(motion, detail=named(detail))
    sentences = [named(one) for one in detail.ravel()]
    detail = np.array(sentences, dtype=object).reshape(detail.shape)
    return attrs.evolve(motion, detail=detail)


def prepare(laws: Laws, scene: Scene, history: bool | str) -> Prepared:
    """Return what a scene needs before the march, or raise LawFaultError if a law raises."""
    normal = normal_or_failed(laws, scene)
    accuracy = laws.integrator.accuracy
    with faults.blaming(laws.tangential):
        known = answers(normal, laws.tangential, history=history, accuracy=accuracy)
        bound = laws.tangential.books_bound(scene)
        return Prepared(normal, known, columns_of(normal, laws, known), bound)


def normal_or_failed(laws: Laws, scene: Scene) -> NormalMotion:
    """Return the normal motion of ``scene``; all its values are NaN if the law fails."""
    try:
        return normal_motion(laws.normal, scene)
    except faults.LawFaultError as fault:
        return FailedMotion(laws.normal, scene, fault.status, fault.detail)


def _by_halves(laws: Laws, scene: Scene) -> tuple[PlanColumns, Motion]:
    """Return columns and motion of a batch, half by half, down to the impacts that fail."""
    size = scene.shape[0]
    parts = [outcome(laws, scene.take(half), False, None) for half in _parts(size, most=1)]
    columns, motions = zip(*parts, strict=True)
    return PlanColumns.joined(columns, (size,)), Motion.joined(motions, (size,))


def _parts(size: int, *, most: int) -> list[slice]:
    """Return the two halves of a batch, or its impacts if there are at most ``most``."""
    return consecutive([1] * size if size <= most else [size // 2, size - size // 2])


def _tangential(laws: Laws, prepared: Prepared, recorder: Recorder | None) -> TangentialMotion:
    """Return the tangential motion, by whole-impact answers where there are any, else marched."""
    normal, known, columns, _ = prepared
    shape, marched = normal.scene.shape, columns.marched
    if every(marched):
        return _march(laws, normal, recorder)
    if recorder is not None and not some(marched):
        show(normal, known, recorder)
    if not shape:
        if not known:
            return TangentialMotion.nothing((), normal.status, normal.detail)
        answer = known[0].known
        return TangentialMotion(
            slip_velocity_change=float(answer.slip_velocity_change),
            friction_work=float(answer.friction_work),
            status=answer.status,
            detail=answer.detail,
            counters={} if answer.counter is None else {answer.counter: 1},
            normal=answer.normal,
        )
    motion = _answered(normal, known)
    if not some(marched):
        return motion
    parts = [(np.ones(shape, dtype=bool), motion), (marched, _march(laws, normal.take(marched)))]
    return TangentialMotion.merged(parts, shape)


def _march(laws: Laws, normal: NormalMotion, observer: Observer | None = None) -> TangentialMotion:
    """Return the tangential motion; in a batch only the impacts that fail have no answer."""
    # With an observer, failures are not isolated: the observer would be called again.

    def part(index: Any) -> TangentialMotion:
        return _march(laws, normal.take(index))

    shape = normal.scene.shape
    if shape == (1,) and observer is None:  # one impact is faster as plain numbers
        return TangentialMotion.joined([part(0)], shape)
    try:
        with np.errstate(under="ignore"):  # harmless here, even if the user has numpy raise for it
            motion = laws.integrator.integrate(normal, laws.tangential, normal.scene, observer)
        raised = False
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a plug-in may not end the process
        sentence = faults.sentence(laws.integrator, faults.raised(error), 1)
        motion, raised = TangentialMotion.nothing(shape, Status.LAW_RAISED, sentence), True
    if not shape or observer is not None or succeeded(motion.status):
        return motion
    if laws.integrator.own_statuses and not raised:
        return motion
    return TangentialMotion.joined([part(each) for each in _parts(*shape, most=ONE_BY_ONE)], shape)


def _answered(normal: NormalMotion, known: list[Answer]) -> TangentialMotion:
    """Return the tangential motion of a batch by its whole-impact answers, NaN elsewhere."""
    shape = normal.scene.shape
    change, work = np.full((2, *shape), math.nan)
    status, detail = (
        np.array(np.broadcast_to(np.asarray(entry, dtype=object), shape))
        for entry in (normal.status, normal.detail)
    )
    counters: Counter[str] = Counter()
    for where, answer in known:
        np.copyto(change, answer.slip_velocity_change, where=where)
        np.copyto(work, answer.friction_work, where=where)
        if not isinstance(normal.detail, str):
            detail[where] = ""
        if answer.status is not Status.SUCCESS:
            np.copyto(status, np.asarray(answer.status, dtype=object), where=where)
            detail[where & (status != Status.SUCCESS)] = answer.detail
        if answer.counter is not None:
            counters[answer.counter] += int(np.count_nonzero(where))
    own = None
    if any(answer.normal is not None for _, answer in known):
        parts = [(where, each.normal and each.normal.take(where)) for where, each in known]
        own = Ends.merged([(np.ones(shape, dtype=bool), None), *parts], shape)
    return TangentialMotion(
        slip_velocity_change=change,
        friction_work=work,
        status=status,
        detail=detail,
        counters=dict(counters),
        normal=own,
    )
