"""The range of psi2, the unit in which the numerical error of psi2 is judged.

The magnitude of the change of slip velocity is at most the change in an elastic impact of gross
slip (4 chi in psi) and at most twice the slip velocity at first touch (|psi2| <= |psi1|). The range
is the lesser of the two bounds. An answer whose error equals the range is worthless, at any psi1,
chi and friction coefficient, zero and huge values included.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import choose, greater
from contactlab.numeric.types import Real

#: An answer is coarse if its numerical error is more than this share of the range.
COARSE = 0.25
#: Cap on the declared error, over the range; above 1, as one annulus may exceed the range.
LARGEST_SHARE = 1.1


class Range(NamedTuple):
    """Velocity of psi = 1, range of the change of slip velocity, and |v_x|; all in m/s."""

    unit: Real
    width: Real
    speed: Real


def range_of(scene: Scene) -> Range:
    """Return the range of the change of slip velocity, in m/s, of the batch shape."""
    speed = kinetics.slip_speed(scene)
    lesser: Callable[[Real, Real], Real] = np.minimum if scene.shape else min
    with np.errstate(over="ignore", under="ignore"):
        friction: Real = scene.friction_coefficient * scene.normal_speed
        width = lesser(kinetics.most_slip_change(scene), 2.0 * speed)
        return Range(friction / scene.pair.stiffness_ratio, width, speed)


def psi_magnitude(scene: Scene) -> Real:
    """Return max(1, |psi1|), the scale of relative errors of psi2; 1 where psi1 is infinite."""
    magnitude = kinetics.size_of(scene, scene.psi1)
    if isinstance(magnitude, float):
        return magnitude if 1.0 < magnitude < math.inf else 1.0
    return greater(choose(magnitude < math.inf, magnitude, 1.0), 1.0)
