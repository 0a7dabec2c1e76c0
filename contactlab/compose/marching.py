"""The march of impacts by an integrator; failures in a batch are traced to single impacts."""

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

#: A failed batch of at most so many impacts is run one by one; a larger batch is halved first.
FEW = 8


def march(laws: Laws, normal: NormalMotion, observer: Observer | None = None) -> TangentialMotion:
    """Return the tangential motion; in a batch only the impacts that fail have no answer."""
    # With an observer, failures are not isolated: the observer would be called again.

    def part(index: Any) -> TangentialMotion:
        return march(laws, normal.take(index))

    shape = normal.scene.shape
    size = math.prod(shape)
    if shape and size == 1 and observer is None:  # one impact is faster as plain numbers
        return TangentialMotion.joined([part((0,) * len(shape))], shape)
    motion, raised = _attempt(laws, normal, observer)
    if not shape or observer is not None or np.all(motion.status == Status.SUCCESS):
        return motion
    if laws.integrator.own_statuses and not raised:
        return motion
    parts = np.ndindex(shape) if size <= FEW else halves(shape)
    return TangentialMotion.joined([part(index) for index in parts], shape)


def _attempt(
    laws: Laws, normal: NormalMotion, observer: Observer | None
) -> tuple[TangentialMotion, bool]:
    """Return the motion, and True if the integrator raised instead of returning a motion."""
    scene = normal.scene
    try:
        # Underflow is harmless here, even if the user has numpy raise for it.
        with np.errstate(under="ignore"):
            return laws.integrator.integrate(normal, laws.tangential, scene, observer), False
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a plug-in may not end the process
        sentence = faults.sentence(laws.integrator, faults.raised(error), 1)
        return TangentialMotion.nothing(scene.shape, Status.LAW_RAISED, sentence), True
