"""The range of psi2, in terms of which its numerical error counts.

The change of slip velocity lies between 0 and the lesser of what friction can do in a whole
elastic impact of slip (4 chi in psi) and twice the velocity it starts with (|psi2| <= |psi1|). So
an error of 1 over the range is an answer that says nothing, at any psi1, chi and friction
coefficient, zero and huge ones included.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlab.impact.scene import Scene

#: An answer whose numerical error is more than this share of the range has no digit: it is coarse.
COARSE = 0.25
#: No answer is further off than this, over the range: one annulus may overshoot it a little.
LARGEST_SHARE = 1.1


class Range(NamedTuple):
    """Of a scene, in m/s: the unit of psi, the range of the change, and |v_x|."""

    unit: Any
    width: Any
    speed: Any


def range_of(scene: Scene) -> Range:
    """Return the range in which the change of slip velocity must lie."""
    pair = scene.pair
    speed: Any = abs(scene.slip_velocity)
    lesser: Any = np.minimum if scene.shape else min
    with np.errstate(over="ignore", under="ignore"):
        friction: Any = scene.friction_coefficient * scene.normal_speed
        # 4 chi in psi, without forming psi, which is infinite without friction.
        most = 2.0 * (friction * (pair.normal_mass / pair.tangential_mass))
        return Range(friction / pair.stiffness_ratio, lesser(most, 2.0 * speed), speed)


def psi_magnitude(scene: Scene) -> Any:
    """Return max(1, |psi1|), of which errors of psi2 are shares; 1 where psi1 is infinite."""
    size: Any = abs(scene.psi1)
    if not scene.shape:
        return max(1.0, size) if math.isfinite(size) else 1.0
    return np.maximum(1.0, np.where(np.isfinite(size), size, 1.0))
