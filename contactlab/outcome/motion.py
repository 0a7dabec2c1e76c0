"""The motion of an impact, normal and tangential."""

from __future__ import annotations

import math
from typing import Any, Self

import attrs
import numpy as np

from contactlab.contracts.integrator import TangentialMotion
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.status import Status
from contactlab.numeric.arrays import locked, spread
from contactlab.numeric.checks import Real


@attrs.frozen(kw_only=True, eq=False)
class Motion(TangentialMotion):
    """A tangential motion with the duration, the maxima and the end of its normal motion.

    Attributes
    ----------
    duration : float or array
        Time of contact, in s.
    normal_velocity : float or array
        Rate of approach at the end, in m/s; negative: the bodies separate.
    maximum_radius, maximum_approach : float or array
        Greatest contact radius and approach, in m.
    maximum_force : float or array
        Greatest normal force, in N.
    """

    duration: Real
    normal_velocity: Real
    maximum_radius: Real
    maximum_approach: Real
    maximum_force: Real

    @classmethod
    def along(cls, normal: NormalMotion, tangential: TangentialMotion) -> Self:
        """Return the motion of one batch from its two parts; its arrays are read-only."""
        shape = normal.scene.shape
        entries: dict[str, Any] = {
            "duration": normal.duration,
            "normal_velocity": normal.final_rate,
            "maximum_radius": normal.maximum_radius,
            "maximum_approach": normal.maximum_approach,
            "maximum_force": normal.maximum_force,
            "slip_velocity_change": tangential.slip_velocity_change,
            "friction_work": tangential.friction_work,
        }
        return cls(
            **{name: locked(spread(value, shape)) for name, value in entries.items()},
            status=locked(tangential.status),
            detail=locked(tangential.detail),
            counters=tangential.counters,
        )


def sound(motion: Motion) -> Motion:
    """Return ``motion`` with status ``NON_FINITE`` where a success holds a number not finite.

    Integrators check the quantities that they use; this check adds overflows in the conversion
    to SI, and quantities that an integrator does not check.
    """
    if motion.status is Status.SUCCESS:
        if all(math.isfinite(getattr(motion, name)) for name in motion.numbers()):
            return motion
    elif not np.ndim(motion.status):
        return motion
    values = {name: np.asarray(getattr(motion, name)) for name in motion.numbers()}
    good = np.all([np.isfinite(value) for value in values.values()], axis=0)
    if np.all(good):
        return motion
    names = [
        name.replace("_", " ") for name, value in values.items() if not np.isfinite(value).all()
    ]
    sentence = f"Not finite at the end of contact: {', '.join(names)}."
    return motion.failing(~good, Status.NON_FINITE, sentence)
