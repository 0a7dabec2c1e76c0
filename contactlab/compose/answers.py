"""Whole-impact answers: what a tangential law knows of a scene without a march."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import faults
from contactlab.contracts.integrator import Observer, Sample
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import TangentialLaw, WholeImpactTangentialLaw
from contactlab.contracts.whole_impact import WholeImpact
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import locked
from contactlab.numeric.checks import shown

Mask = NDArray[np.bool_]

#: The masks of a single impact: NumPy takes longer to make one than to say what it says.
ONE: Mask = locked(np.array(True))
NONE: Mask = locked(np.array(False))


#: Instants in the history of an impact that is not marched.
INSTANTS = 201


class Answer(NamedTuple):
    """A whole-impact answer and the impacts that it is taken for."""

    where: Mask
    known: WholeImpact


def answers(
    scene: Scene, normal: NormalMotion, tangential: TangentialLaw, *, history: bool | str
) -> list[Answer]:
    """Return the answers of ``tangential`` to whole impacts, each impact in one of them at most.

    None where a march is asked for: traction and stick/slip fields come from nothing else, and
    the impacts of a batch that keeps its history share one time axis.

    Parameters
    ----------
    scene : Scene
    normal : NormalMotion
        Of the scene.
    tangential : TangentialLaw
    history : bool or "fields"
        What is asked for.
    """
    shape = scene.shape
    always = isinstance(tangential, WholeImpactTangentialLaw)
    if history == "fields" and not always:
        return []
    if not shape:
        if normal.status is not Status.SUCCESS:
            return []
        for known in tangential.whole_impacts(scene, normal):
            if known.where:
                return [Answer(ONE, _checked(known, tangential, shape))]
        if always:
            raise _unanswered(tangential)
        return []
    left = np.asarray(np.asarray(normal.status, dtype=object) == Status.SUCCESS)
    left = np.array(np.broadcast_to(left, shape))
    found = []
    for known in tangential.whole_impacts(scene, normal):
        where = left & np.broadcast_to(known.where, shape)
        if where.any():
            found.append(Answer(where, _checked(known, tangential, shape)))
            left &= ~where
    if always and left.any():
        raise _unanswered(tangential)
    if history and left.any():
        return []
    return found


def show(normal: NormalMotion, known: Sequence[Answer], observer: Observer) -> None:
    """Show ``observer`` the impacts that have whole-impact answers, at ``INSTANTS`` of each.

    NaN stands for slip velocity and force where an answer has no ``course``.
    """
    scene = normal.scene
    for phase in np.linspace(0.0, np.pi, INSTANTS).tolist():
        time, approach, rate, contact, impulse = normal.at(phase)
        change: Any = np.full(scene.shape, np.nan)
        force: Any = np.full(scene.shape, np.nan)
        for where, answer in known:
            if answer.course is not None:
                gained, acting = answer.course(impulse, contact.friction_load)
                change, force = np.where(where, gained, change), np.where(where, acting, force)
        observer(
            Sample(
                time=time,
                approach=approach,
                normal_velocity=rate,
                contact=contact,
                slip_velocity=scene.slip_velocity + change,
                tangential_force=force,
                fields=dict,
            )
        )


def _checked(known: WholeImpact, law: TangentialLaw, shape: tuple[int, ...]) -> WholeImpact:
    """Return an answer that is made of real numbers.

    Raises
    ------
    LawFaultError
        If it is not.
    """
    for entry in (known.slip_velocity_change, known.friction_work):
        if faults.malformed(entry, shape):
            sentence = faults.sentence(law, f"the answer {shown(entry)} to a whole impact", 1)
            raise faults.LawFaultError(Status.MALFORMED, sentence)
    return known


def _unanswered(law: TangentialLaw) -> faults.LawFaultError:
    """Return the error of a whole-impact law that leaves impacts without an answer."""
    sentence = faults.sentence(law, "no answer to some impacts, and no other way to run them", 1)
    return faults.LawFaultError(Status.MALFORMED, sentence)
