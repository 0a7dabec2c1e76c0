"""The range of psi2 in a scene, in terms of which errors are judged.

The change of slip velocity lies between 0 and the lesser of what friction can do in a whole
elastic impact of slip (4 chi in psi) and twice the velocity it starts with (|psi2| <= |psi1|). So
an error of 1 over the range is an answer that says nothing, at any psi1, chi and friction
coefficient, zero and huge ones included.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.scene import Scene

#: An answer whose declared error is more than this share of the range has no digit: it is coarse.
COARSE = 0.25


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
        grip = 2.0 * (friction * (pair.normal_mass / pair.tangential_mass))
        return Range(friction / pair.stiffness_ratio, lesser(grip, 2.0 * speed), speed)


def psi2_range(scene: Scene) -> Any:
    """Return the range in psi: the lesser of 4 chi and 2 |psi1|."""
    return np.minimum(4.0 * np.asarray(scene.chi), 2.0 * np.abs(scene.psi1))
