"""The march of impacts by an integrator, with failures within a batch traced to their impacts."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.compose.composition import Laws
from contactlab.contracts import faults
from contactlab.contracts.integrator import Observer, TangentialMotion
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.status import Status
from contactlab.numeric.arrays import halves

#: So many impacts of a batch that failed are tried one by one; more are halved first.
FEW = 8


def march(laws: Laws, normal: NormalMotion, observer: Observer | None = None) -> TangentialMotion:
    """Return the tangential motion; a failure within a batch costs the impacts that fail only.

    Of a batch that is observed failures are not traced: the observer would be called again.
    """

    def part(index: Any) -> TangentialMotion:
        return march(laws, normal.take(index))

    shape = normal.scene.shape
    size = math.prod(shape)
    if shape and size == 1 and observer is None:  # one impact is faster as plain numbers
        return TangentialMotion.joined([part((0,) * len(shape))], shape)
    motion, raised = _attempt(laws, normal, observer)
    if not shape or observer or np.all(motion.status == Status.SUCCESS):
        return motion
    if laws.integrator.own_statuses and not raised:
        return motion
    parts = np.ndindex(shape) if size <= FEW else halves(shape)
    return TangentialMotion.joined([part(index) for index in parts], shape)


def _attempt(
    laws: Laws, normal: NormalMotion, observer: Observer | None
) -> tuple[TangentialMotion, bool]:
    """Return the motion, and whether the integrator raised instead of returning one."""
    scene = normal.scene
    try:
        # Where a user has asked for errors of underflow: small numbers may vanish here.
        with np.errstate(under="ignore"):
            return laws.integrator.integrate(normal, laws.tangential, scene, observer), False
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a plug-in may not end the process
        sentence = faults.sentence(laws.integrator, faults.raised(error), 1)
        return TangentialMotion.nothing(scene.shape, Status.LAW_RAISED, sentence), True
