"""What a law declares as its numerical error, and the range of psi2 in terms of which errors count.

The change of slip velocity lies between 0 and the lesser of what friction can do in a whole
elastic impact of slip (4 chi in psi) and twice the velocity it starts with (|psi2| <= |psi1|). So
an error of 1 over the range is an answer that says nothing, at any psi1, chi and friction
coefficient, zero and huge ones included.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real

#: An answer whose declared error is more than this share of the range has no digit: it is coarse.
COARSE = 0.25
#: What is declared over the largest error measured at an inertia ratio.
SAFETY = 2.0
#: Nothing is further off than this, over the range: one annulus may overshoot it a little.
LARGEST_SHARE = 1.1
#: Beyond the largest chi measured errors grow at least as this power: the contact oscillates
#: about sqrt(chi) times.
LEAST_SLOPE = 0.5
#: Rounding, over max(1, |psi1|).
ROUNDING = 1e-12


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


def psi2_range(scene: Scene) -> Any:
    """Return the range in psi: the lesser of 4 chi and 2 |psi1|."""
    return np.minimum(4.0 * np.asarray(scene.chi), 2.0 * np.abs(scene.psi1))


def psi_magnitude(scene: Scene) -> Any:
    """Return max(1, |psi1|), of which errors of psi2 are shares; 1 where psi1 is infinite."""
    size: Any = abs(scene.psi1)
    if not scene.shape:
        return max(1.0, size) if math.isfinite(size) else 1.0
    return np.maximum(1.0, np.where(np.isfinite(size), size, 1.0))


@attrs.frozen(kw_only=True)
class ErrorModel:
    """Largest numerical error of psi2 over its range, as measured: A(chi)/N² + B(chi)/n^p.

    Measured against the exact solution over psi1 from 0.01 to slip throughout, N from what the
    stiffness needs to 64 times that, n from 1 to 200; between the knots interpolated in
    logarithms, beyond them continued as powers. It holds for elastic Hertz contacts.

    Attributes
    ----------
    chi : tuple of float
        Knots.
    steps, parts : tuple of float
        A and B there; no parts for a law that has none.
    power : float
        p.
    """

    chi: tuple[float, ...]
    steps: tuple[float, ...]
    parts: tuple[float, ...] = ()
    power: float = 1.5

    def psi2_error(self, scene: Scene, steps: Any, parts: float | None = None) -> Real:
        """Return the declared error of psi2 at ``steps`` steps and ``parts`` parts."""
        with np.errstate(all="ignore"):
            share: Any = self._at(scene.chi, self.steps) / np.square(np.asarray(steps, float))
            if parts is not None:
                share = share + self._at(scene.chi, self.parts) / float(parts) ** self.power
            rounding = ROUNDING * psi_magnitude(scene)
            error = np.minimum(SAFETY * share, LARGEST_SHARE) * psi2_range(scene) + rounding
        return float(error) if not np.ndim(error) else error

    def _at(self, chi: Any, values: tuple[float, ...]) -> Any:
        knots, logs = np.log(self.chi), np.log(values)
        place = np.log(chi)
        slope = max((logs[-1] - logs[-3]) / (knots[-1] - knots[-3]), LEAST_SLOPE)
        beyond = np.maximum(place - knots[-1], 0.0) * slope
        return np.exp(np.interp(place, knots, logs) + beyond)
