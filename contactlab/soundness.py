"""The last look at a motion: no number that is not finite leaves as a success."""

from __future__ import annotations

import math
from typing import Any

import attrs
import numpy as np

from contactlab.contracts.integrator import MOTION_ENTRIES, Motion
from contactlab.status import Status

NUMBERS = tuple(name for name in MOTION_ENTRIES if name != "status")


def sound(motion: Motion) -> Motion:
    """Return ``motion``, its status ``NON_FINITE`` where a success holds such a number.

    Integrators look at what they use as they go; this also finds what overflows on the way back
    to SI, and what an integrator forgets.
    """
    values = [getattr(motion, name) for name in NUMBERS]
    if all(isinstance(value, float) for value in values):
        if motion.status is not Status.SUCCESS or all(map(math.isfinite, values)):
            return motion
        return attrs.evolve(motion, status=Status.NON_FINITE, detail=_told(values))
    status: Any = np.array(motion.status, dtype=object)
    good = np.all([np.isfinite(np.broadcast_to(value, status.shape)) for value in values], axis=0)
    bad = (status == Status.SUCCESS) & ~good
    if not bad.any():
        return motion
    if not status.shape:
        return attrs.evolve(motion, status=Status.NON_FINITE, detail=_told(values))
    status[bad] = Status.NON_FINITE
    return attrs.evolve(motion, status=status, detail=motion.detail or _told(values))


def _told(values: list[Any]) -> str:
    names = [
        name.replace("_", " ")
        for name, value in zip(NUMBERS, values, strict=True)
        if not np.isfinite(value).all()
    ]
    return f"Not finite at the end of contact: {', '.join(names)}."
