"""The last look at a motion: no number that is not finite leaves as a success."""

from __future__ import annotations

import math
from typing import Any

import attrs
import numpy as np

from contactlab.contracts.integrator import MOTION_NUMBERS, Motion
from contactlab.status import Status


def sound(motion: Motion) -> Motion:
    """Return ``motion``, its status ``NON_FINITE`` where a success holds such a number.

    Integrators look at what they use as they go; this also finds what overflows on the way back
    to SI, and what an integrator forgets.
    """
    values = [getattr(motion, name) for name in MOTION_NUMBERS]
    if all(isinstance(value, float) for value in values):
        if motion.status is not Status.SUCCESS or all(map(math.isfinite, values)):
            return motion
        return attrs.evolve(motion, status=Status.NON_FINITE, detail=_told(values))
    shape = np.shape(motion.status)
    good = np.all([np.isfinite(np.broadcast_to(value, shape)) for value in values], axis=0)
    return motion if good.all() else motion.failing(~good, Status.NON_FINITE, _told(values))


def _told(values: list[Any]) -> str:
    names = [
        name.replace("_", " ")
        for name, value in zip(MOTION_NUMBERS, values, strict=True)
        if not np.isfinite(value).all()
    ]
    return f"Not finite at the end of contact: {', '.join(names)}."
