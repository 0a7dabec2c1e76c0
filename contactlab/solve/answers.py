"""Whole-impact answers of a tangential law to a scene, without a march."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import partial
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import faults, judges
from contactlab.contracts.contact import NormalContact
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.status import Status, succeeded
from contactlab.contracts.tangential import Errors, TangentialLaw
from contactlab.contracts.tangential_motion import Observer, Sample, TangentialMotion
from contactlab.contracts.whole_impact import WholeImpact
from contactlab.numeric.arrays import lock_arrays
from contactlab.numeric.checks import quote
from contactlab.numeric.types import Real

Mask = NDArray[np.bool_]

#: The mask of a single impact: making an array costs more than the test of a mask.
ONE: Mask = lock_arrays(np.array(True))
#: The numbers of a whole-impact answer: one call is faster than a loop over names.
_numbers = attrgetter("slip_velocity_change", "friction_work", "shear_loss", "normal_spin_change")
#: Types of these numbers in most answers to one impact.
FLOATS = {float}
#: Instants in the history of an impact that is not marched.
INSTANTS = 201


class Answered(NamedTuple):
    """A whole-impact answer and the impacts that take it."""

    where: Mask
    answer: WholeImpact


def answers(
    normal: NormalMotion,
    tangential: TangentialLaw,
    *,
    always: bool,
    history: bool | str,
    largest_error: Real = math.inf,
) -> list[Answered]:
    """Return the answers of ``tangential`` to whole impacts, each impact in one of them at most.

    The list is empty if fields are requested, or the history of a batch: tractions and stick/slip
    fields come of a march only, and the impacts of a batch share the time axis of its history. If
    the law does not answer ``always``, an answer without a course is not used for a history, and no
    answer with an error of psi2 above ``largest_error`` is used.
    """
    scene = normal.scene
    shape = scene.shape
    if history == "fields" and not always:
        return []
    if not shape:
        if normal.status is not Status.SUCCESS:
            return []
        for answer in tangential.whole_impacts(scene, normal):
            if answer.where and (always or not _falls_short(answer, history, largest_error)):
                return [Answered(ONE, _check_answer(answer, tangential, shape))]
        if always:
            raise _complain_of_gaps(tangential)
        return []
    left = np.asarray(separates(normal))
    given = []
    for answer in tangential.whole_impacts(scene, normal):
        where = left & answer.where
        if where.shape != shape:
            np.broadcast_to(answer.where, shape)  # raises for a mask of another shape
        if not always:
            where &= np.logical_not(_falls_short(answer, history, largest_error))
        if where.any():
            given.append(Answered(where, _check_answer(answer, tangential, shape)))
            left &= ~where
    if always and left.any():
        raise _complain_of_gaps(tangential)
    if history and left.any():
        return []
    return given


def separates(normal: NormalMotion) -> bool | Mask:
    """Return the impacts that the normal motion ends: a bool, or of a batch a new array."""
    shape = normal.scene.shape
    if not shape:
        return normal.status is Status.SUCCESS
    if normal.status is Status.SUCCESS:
        return np.ones(shape, dtype=bool)
    success = np.asarray(np.asarray(normal.status, dtype=object) == Status.SUCCESS)
    return np.array(np.broadcast_to(success, shape))


def show(normal: NormalMotion, answered: Sequence[Answered], observer: Observer) -> None:
    """Show ``observer`` the impacts that have whole-impact answers, at ``INSTANTS`` of each.

    NaN stands for slip velocity and force where an answer has no ``course``.
    """
    scene = normal.scene
    shape = (INSTANTS, *scene.shape)
    phases = np.linspace(0.0, np.pi, INSTANTS).reshape(-1, *(1 for _ in scene.shape))
    columns = _columns(normal, phases)
    change, force = np.full((2, *shape), np.nan)
    for where, answer in answered:
        if answer.normal is not None:
            pairs = zip(_columns(answer.normal, phases), columns, strict=True)
            columns = [np.where(where, *pair) for pair in pairs]
        if answer.course is not None:
            gained, acting = answer.course(columns[-1], columns[-2])
            change, force = np.where(where, gained, change), np.where(where, acting, force)
    *columns, impulse = columns
    lists = [
        np.broadcast_to(column, shape)
        for column in (*columns, scene.slip_velocity + change, force, impulse)
    ]
    rows = lists if scene.shape else [column.tolist() for column in lists]
    for time, approach, rate, load, radius, overlap, friction_load, velocity, acting, passed in zip(
        *rows, strict=True
    ):
        touching = NormalContact(load, radius, overlap, friction_load)
        fields = partial(_fields, answered, passed, scene.shape)
        observer(Sample(time, approach, rate, touching, velocity, acting, fields))


def _columns(normal: NormalMotion, phases: Real) -> list[Real]:
    """Return time, approach, rate, the entries of the contact, and load impulse."""
    time, approach, rate, contact, impulse = normal.at(phases)
    return [time, approach, rate, *contact, impulse]


def _fields(
    answered: Sequence[Answered], impulse: Real, shape: tuple[int, ...]
) -> Mapping[str, Any]:
    """Return the fields of whole-impact answers at one instant; NaN for impacts without."""
    fields: dict[str, Any] = {}
    if not shape:
        return {} if answered[0].answer.fields is None else answered[0].answer.fields(impulse)
    for where, answer in answered:
        if answer.fields is None:
            continue
        for name, values in answer.fields(impulse).items():
            tail = values.shape[len(shape) :]
            column = fields.setdefault(name, np.full((*shape, *tail), np.nan))
            column[where] = values[where]
    return fields


def _falls_short(answer: WholeImpact, history: bool | str, largest_error: Real) -> bool | Mask:
    """Return where a march is more accurate than an answer, or has a requested course."""
    if history and answer.course is None:
        return True
    return answer.psi2_error > largest_error


def _check_answer(answer: WholeImpact, law: TangentialLaw, shape: tuple[int, ...]) -> WholeImpact:
    """Return an answer that is made of real numbers.

    Raises
    ------
    LawFaultError
        If it is not.
    """
    numbers = _numbers(answer)
    for entry in () if {*map(type, numbers)} == FLOATS else numbers:
        if faults.is_malformed(entry, shape):
            sentence = faults.sentence(law, f"the answer {quote(entry)} to a whole impact", 1)
            raise faults.LawFaultError(Status.MALFORMED, sentence)
    if not (type(answer.psi2_error) is float and answer.psi2_error >= 0.0):
        judges.judge_errors(law, Errors(answer.psi2_error), shape)
    return answer


def _complain_of_gaps(law: TangentialLaw) -> faults.LawFaultError:
    """Return the error of a whole-impact law that leaves impacts without an answer."""
    sentence = faults.sentence(law, "no answer to some impacts, and no other way to run them", 1)
    return faults.LawFaultError(Status.MALFORMED, sentence)


def check_motion(
    motion: object, shape: tuple[int, ...], axes: tuple[int, ...] = ()
) -> TangentialMotion:
    """Return the motion of a law or an integrator, or raise an error for a malformed one.

    ``axes`` are the axes of a slip velocity behind those of the batch.
    """
    if not isinstance(motion, TangentialMotion):
        raise TypeError(f"gave {quote(motion)}, not a TangentialMotion")
    for name, own in ("slip_velocity_change", axes), ("friction_work", ()), ("shear_loss", ()):
        value, whole = getattr(motion, name), (*shape, *own)
        if faults.is_malformed(value, whole):
            raise TypeError(f"{name} = {quote(value)}: must be real, of shape {whole}")
    if not _of_each(motion.status, shape):
        raise TypeError(f"status = {quote(motion.status)}: must be a Status for each impact")
    return motion


def _of_each(status: Any, shape: tuple[int, ...]) -> bool:
    """Return whether there is a status for each impact of a batch, or one for a single impact."""
    if not shape:
        return isinstance(status, Status)
    if not (isinstance(status, np.ndarray) and status.shape == shape):
        return False
    return succeeded(status) or all(isinstance(each, Status) for each in status.flat)
