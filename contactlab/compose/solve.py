"""The outcome of a scene under three laws: plan and motion, by whole-impact answers or a march."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from contactlab.compose import together
from contactlab.compose.answers import Answered, answers, show
from contactlab.compose.composition import Laws, Way
from contactlab.compose.normal_motion import normal_or_failed
from contactlab.compose.pieces import Piece
from contactlab.compose.planning import columns_of
from contactlab.compose.solved_motion import FailedMotion
from contactlab.contracts import faults
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.sampled_motion import Ends
from contactlab.contracts.status import Status, succeeded
from contactlab.contracts.tangential_motion import Observer, TangentialMotion
from contactlab.impact.inverse_mass import unit_slip
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import are_zeros, consecutive, every, some, zeros
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Index, Mask
from contactlab.outcome.chunk_forms import Chunk
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
    answered: list[Answered]
    columns: PlanColumns
    books_bound: Any


@np.errstate(under="ignore")  # small numbers may vanish, whatever a user has asked for
def outcome(
    ways: Sequence[Way], scene: Scene, history: bool | str, recorder: Recorder | None
) -> tuple[PlanColumns, Motion]:
    """Return columns of the plan, and motion, each impact of a scene solved in its own way.

    A law that raises costs its impacts only. Numbers of impacts that failed are what the laws made
    of them. A history of a batch is refused if its impacts have instants of their own.
    """
    if len(ways) == 1:
        _, part, laws = ways[0]
        columns, motion = _alike(laws, part, history, recorder)
        return columns, _in_axes(motion, scene, part)
    pieces = []
    for where, part, laws in ways:
        columns, motion = _alike(laws, part, history, recorder)
        pieces.append((where, columns, _in_axes(motion, scene.take(where), part)))
    return (
        PlanColumns.merged([(where, columns) for where, columns, _ in pieces], scene.shape),
        Motion.merged([(where, motion) for where, _, motion in pieces], scene.shape),
    )


def _in_axes(motion: Motion, scene: Scene, part: Scene) -> Motion:
    """Return the motion of a part with its slip in the axes of the scene."""
    if scene.slip_axes == part.slip_axes:
        return motion
    if part.inverse_mass is not None:  # slip along t1, of either sign
        return motion.turned(np.array([1.0, 0.0]))
    return motion.turned(unit_slip(scene.slip_velocity))


def _alike(
    laws: Laws, scene: Scene, history: bool | str, recorder: Recorder | None
) -> tuple[PlanColumns, Motion]:
    """Return columns and motion of impacts that are solved in one way."""
    coupled = scene.inverse_mass is not None
    if coupled and recorder is None and scene.shape and scene.shape[0] > together.AT_A_TIME:
        return _cut(laws, scene, _blocks(scene.shape[0], together.AT_A_TIME))
    solve = _together if coupled else _along
    try:
        columns, motion, bound = solve(laws, scene, history, recorder)
    except faults.LawFaultError as fault:
        if recorder is None and math.prod(scene.shape) > 1:
            return _cut(laws, scene, _parts(*scene.shape, most=1))
        nothing = Motion.nothing(scene.shape, fault.status, fault.detail, axes=scene.slip_axes)
        return PlanColumns.nothing(scene.shape), nothing
    motion = sound(motion, together=coupled)
    # Bound of the imbalance of the energy books: the law's own, and the integrator's share.
    bound = bound + WORK_ACCURACY * (laws.integrator.accuracy or 0.0)
    return columns, balanced(motion, scene, bound, together=coupled)


class _Scattered(faults.LawFaultError):
    """A batch that must be solved in parts."""


def _along(
    laws: Laws, scene: Scene, history: bool | str, recorder: Recorder | None
) -> tuple[PlanColumns, Motion, Any]:
    """Return columns, motion and bound of the books of impacts along a known normal motion."""
    normal, answered, columns, bound = prepare(laws, scene, history)
    if scene.shape:
        _halved_if_failed(normal, recorder)
    tangential = _tangential(laws, normal, answered, columns.marched, recorder)
    return columns, Motion.along(normal, tangential), bound


def _together(
    laws: Laws, scene: Scene, history: bool | str, recorder: Recorder | None
) -> tuple[PlanColumns, Motion, Any]:
    """Return columns, motion and bound of the books of impacts whose motions are one."""
    prepared = prepare(laws, scene, history)
    normal = prepared.normal
    _halved_if_failed(normal, recorder)
    if isinstance(normal, FailedMotion):
        status, detail = normal.status, normal.detail
        nothing = Motion.nothing(scene.shape, status, detail, axes=scene.slip_axes)
        return prepared.columns, nothing, prepared.books_bound
    motion = together.moved(laws, scene, normal, recorder)
    if scene.shape and scene.shape != (1,) and recorder is None:
        motion = _apart(laws, scene, motion)
    return prepared.columns, motion, prepared.books_bound


def _halved_if_failed(normal: NormalMotion, recorder: Recorder | None) -> None:
    """Let a batch whose normal law failed be solved in parts."""
    if isinstance(normal, FailedMotion) and recorder is None and math.prod(normal.scene.shape) > 1:
        raise _Scattered(Status.LAW_RAISED, "")


def _apart(laws: Laws, scene: Scene, motion: Motion) -> Motion:
    """Return a motion with the impacts solved again that failed beside others."""
    again = together.given_up(motion)
    if not again.any():
        return motion
    part = scene.take(again)
    size = part.shape[0]
    if size == scene.shape[0]:
        _, repeated = _cut(laws, part, _parts(size, most=ONE_BY_ONE))
    else:
        _, repeated = _alike(laws, part, False, None)
    return Motion.merged(
        [(np.ones(scene.shape, dtype=bool), motion), (again, repeated)], scene.shape
    )


def _cut(laws: Laws, scene: Scene, places: list[slice]) -> tuple[PlanColumns, Motion]:
    """Return columns and motion of a batch that is solved in consecutive parts."""
    parts = [_alike(laws, scene.take(place), False, None) for place in places]
    columns, motions = zip(*parts, strict=True)
    return PlanColumns.joined(columns, scene.shape), Motion.joined(motions, scene.shape)


def _blocks(size: int, block: int) -> list[slice]:
    """Return the places of blocks of a batch."""
    return [slice(first, min(first + block, size)) for first in range(0, size, block)]


@np.errstate(under="ignore")
def planned(ways: Sequence[Way], scene: Scene, history: bool | str) -> PlanColumns:
    """Return the columns of the plan, without a march."""
    parts = [(where, prepare(laws, part, history).columns) for where, part, laws in ways]
    return parts[0][1] if len(parts) == 1 else PlanColumns.merged(parts, scene.shape)


def solved(laws: Laws, scene: Scene, chunk: Chunk, block: int) -> Piece:
    """Return the piece of a sweep's chunk, a block at a time; ``scene`` is the chunk alone."""
    scenes = (scene.take(place) for place in _blocks(chunk.size, block))
    pieces = (outcome(laws.ways(each), each, False, None) for each in scenes)
    columns, motions = zip(*pieces, strict=True)
    shape = (chunk.size,)
    return Piece(chunk, PlanColumns.joined(columns, shape), Motion.joined(motions, shape))


def prepare(laws: Laws, scene: Scene, history: bool | str) -> Prepared:
    """Return what impacts of one way need before the march, or raise LawFaultError."""
    coupled = scene.inverse_mass is not None
    if (
        history
        and scene.shape
        and (not laws.integrator.common_instants or (coupled and laws.tangential.together))
    ):
        raise refuse(
            "history",
            history,
            f"impacts of a batch have instants of their own under {laws.integrator!r}",
            "run them one by one",
        )
    normal = normal_or_failed(laws.normal, scene.central if coupled else scene)
    accuracy = laws.integrator.accuracy
    with faults.blaming(laws.tangential):
        if coupled:
            columns = together.columns_of(laws, scene, normal)
            return Prepared(normal, [], columns, together.books_bound(laws, normal.scene))
        answered = answers(normal, laws.tangential, history=history, accuracy=accuracy)
        bound = laws.tangential.books_bound(scene)
        return Prepared(normal, answered, columns_of(normal, laws, answered), bound)


def _parts(size: int, *, most: int) -> list[slice]:
    """Return the two halves of a batch, or its impacts if there are at most ``most``."""
    return consecutive([1] * size if size <= most else [size // 2, size - size // 2])


def _tangential(
    laws: Laws,
    normal: NormalMotion,
    answered: list[Answered],
    marched: Mask,
    recorder: Recorder | None,
) -> TangentialMotion:
    """Return the tangential motion, by whole-impact answers where there are any, else marched."""
    shape = normal.scene.shape
    if every(marched):
        return _march(laws, normal, recorder)
    if recorder is not None and not some(marched):
        show(normal, answered, recorder)
    if not shape:
        if not answered:
            return TangentialMotion.nothing((), normal.status, normal.detail)
        answer = answered[0].answer
        return TangentialMotion(
            slip_velocity_change=float(answer.slip_velocity_change),
            friction_work=float(answer.friction_work),
            normal_spin_change=float(answer.normal_spin_change),
            status=answer.status,
            detail=answer.detail,
            counters={} if answer.counter is None else {answer.counter: 1},
            normal=answer.normal,
        )
    motion = _joined(normal, answered)
    if not some(marched):
        return motion
    parts = [(np.ones(shape, dtype=bool), motion), (marched, _march(laws, normal.take(marched)))]
    return TangentialMotion.merged(parts, shape)


def _march(laws: Laws, normal: NormalMotion, observer: Observer | None = None) -> TangentialMotion:
    """Return the tangential motion; in a batch only the impacts that fail have no answer."""
    # With an observer, failures are not isolated: the observer would be called again.

    def part(index: Index) -> TangentialMotion:
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


def _joined(normal: NormalMotion, answered: list[Answered]) -> TangentialMotion:
    """Return the tangential motion of a batch by its whole-impact answers, NaN elsewhere."""
    shape = normal.scene.shape
    change, work = np.full((2, *shape), math.nan)
    turns = not all(are_zeros(answer.normal_spin_change) for _, answer in answered)
    spin_change = np.full(shape, math.nan) if turns else zeros(shape)
    status, detail = (
        np.array(np.broadcast_to(np.asarray(entry, dtype=object), shape))
        for entry in (normal.status, normal.detail)
    )
    counters: Counter[str] = Counter()
    for where, answer in answered:
        np.copyto(change, answer.slip_velocity_change, where=where)
        np.copyto(work, answer.friction_work, where=where)
        if turns:
            np.copyto(spin_change, answer.normal_spin_change, where=where)
        if not isinstance(normal.detail, str):
            detail[where] = ""
        if answer.status is not Status.SUCCESS:
            np.copyto(status, np.asarray(answer.status, dtype=object), where=where)
            detail[where & (status != Status.SUCCESS)] = answer.detail
        if answer.counter is not None:
            counters[answer.counter] += int(np.count_nonzero(where))
    own = None
    if any(answer.normal is not None for _, answer in answered):
        parts = [(where, each.normal and each.normal.take(where)) for where, each in answered]
        own = Ends.merged([(np.ones(shape, dtype=bool), None), *parts], shape)
    return TangentialMotion(
        slip_velocity_change=change,
        friction_work=work,
        normal_spin_change=spin_change,
        status=status,
        detail=detail,
        counters=dict(counters),
        normal=own,
    )
