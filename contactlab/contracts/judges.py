"""Judges of what laws answer: real numbers of the batch's shape, known, and of the right sign.

Every way to solve an impact, integrators and prescribed paths ask these. A refused answer has
status ``MALFORMED``, in the words of ``faults``.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.contracts import faults
from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import (
    Errors,
    SteppedTangentialLaw,
    TangentialLaw,
    TangentialResponse,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import quote
from contactlab.numeric.types import Real

#: Share of the largest of its kind up to which a number below zero counts as rounding.
ROUNDING = 1e-9
NEGATIVE_RADIUS = "a contact radius below zero"
NEGATIVE_LOAD = "a friction load below zero, of which Coulomb's limit would be negative"


def below_zero(radius: Real, load: Real, largest: tuple[Real, Real]) -> str:
    """Return which of contact radius (m) and friction load (N) is below zero in words, or "".

    ``largest`` are the scales of the two, over which rounding counts.
    """
    for value, scale, words in zip(
        (radius, load), largest, (NEGATIVE_RADIUS, NEGATIVE_LOAD), strict=True
    ):
        if np.any(np.less(value, -ROUNDING * np.asarray(scale))):
            return words
    return ""


def judge_contact(law: Law, contact: object, shape: tuple[int, ...], step: int) -> NormalContact:
    """Return a contact with its friction load; refuse an answer that is no contact.

    Parameters
    ----------
    law : Law
        The normal law that answered.
    contact : object
        Its answer.
    shape : tuple of int
        Shape of the batch.
    step : int
        Number of the step, from 1, for the sentence.
    """
    if not isinstance(contact, NormalContact):
        sentence = faults.sentence(law, f"respond gave {quote(contact)}, not a NormalContact", step)
        raise faults.LawFaultError(Status.LAW_RAISED, sentence)
    for entry in contact:
        if entry is not None and faults.is_malformed(entry, shape):
            raise _refusal(law, f"the answer {quote(entry)}", step)
    return contact.complete


def wrong_response(
    response: TangentialResponse, shape: tuple[int, ...], axes: tuple[int, ...] = ()
) -> str:
    """Return in words which entry of a response has wrong numbers or shape; "" if none has.

    ``axes`` are the axes of a force behind those of the batch.
    """
    force, work, settled, shear_loss = response
    for answer, wanted in ((force, (*shape, *axes)), (work, shape), (shear_loss, shape)):
        if faults.is_malformed(answer, wanted):
            return f"the answer {quote(answer)}"
    if axes and np.ndim(force) == 0 and force != 0.0:  # no force is a number
        return f"no vector: {quote(force)}"
    mask = isinstance(settled, np.ndarray) and settled.dtype == np.bool_
    return "" if mask or isinstance(settled, bool | np.bool_) else f"settled = {quote(settled)}"


def stiffness_of(law: SteppedTangentialLaw, scene: Scene, normal: NormalMotion) -> Real:
    """Return the stiffness in N/m that bounds a stable step; infinite if no step is stable."""
    return _read_declaration(law, "stiffness", law.stiffness(scene, normal), scene.shape)


def books_bound_of(law: TangentialLaw, scene: Scene) -> Real:
    """Return the bound of the energy books that a law declares; infinite if it declares none."""
    return _read_declaration(law, "books_bound", law.books_bound(scene), scene.shape)


def judge_errors(law: Law, errors: object, shape: tuple[int, ...]) -> Errors:
    """Return declared errors, numbers from 0; NaN where a law declares none."""
    if not isinstance(errors, Errors):
        raise _refusal(law, f"errors gave {quote(errors)}, not Errors", 1)
    for name, error in zip(errors._fields, errors, strict=True):
        if type(error) is float and not error < 0.0:  # NaN is not declared
            continue
        if faults.is_malformed(error, shape) or np.any(np.less(error, 0.0)):
            raise _refusal(law, f"errors gave {name} = {quote(error)}", 1)
    return errors


def _read_declaration(law: Law, name: str, value: Any, shape: tuple[int, ...]) -> Real:
    """Return a number from 0 that a law declares for each impact, or refuse the declaration."""
    if isinstance(value, float) and value >= 0.0:
        return value
    if faults.is_malformed(value, shape) or not np.all(np.greater_equal(value, 0.0)):
        raise _refusal(law, f"{name} gave {quote(value)}, not a number from 0", 1)
    number: Real = value
    return number


def _refusal(law: Law, what: str, step: int) -> faults.LawFaultError:
    """Return the ``LawFaultError`` of a refused answer."""
    return faults.LawFaultError(Status.MALFORMED, faults.sentence(law, what, step))
