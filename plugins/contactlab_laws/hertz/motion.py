"""The motion of a Hertz impact in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, lru_cache
from typing import Any

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    NormalContact,
    NormalLaw,
    NormalSample,
    ScaledContact,
)
from contactlab.impact.hertz import DURATION_CONSTANT, hertz_scales
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import fill
from contactlab.numeric.types import Array, Index, Real

#: Longer tables are not cached: 64 tables of three columns of 8 bytes are 6 MB at most.
LONGEST_KEPT = 4000
#: Nodes of Gauss's rule that give T to rounding, and steps of Newton's method from the first guess,
#: sqrt(T) times 1 at first touch and 1.295 at the greatest compression, which is 1 % off at most.
NODES, NEWTON, AT_THE_TOP = 16, 4, 0.295


def velocity_factor(root: Real) -> Real:
    """Return g(u) = sqrt((1+u+u²+u³+u⁴)/(1+u)), so that V = cos x g(u), theory §3."""
    u = root
    return ((1.0 + u * (1.0 + u * (1.0 + u * (1.0 + u)))) / (1.0 + u)) ** 0.5


@cache
def _gauss() -> tuple[Array, Array]:
    """Return nodes and weights of Gauss's rule in [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    return 0.5 * (nodes + 1.0), 0.5 * weights


def _slope(phase: Array) -> Array:
    """Return dT/dx = 2u/g(u), theory §3."""
    u = np.sin(phase)
    return 2.0 * u / velocity_factor(u)


def rising_time(phase: Array) -> Array:
    """Return T at a phase x up to pi/2: the integral of dT/dx."""
    nodes, weights = _gauss()
    mean: Array = np.einsum("...j,j->...", _slope(np.multiply.outer(phase, nodes)), weights)
    return phase * mean


def scale_motion(phase: Array) -> tuple[Array, Array, Array]:
    """Return u = sqrt(zeta), V and T at ``phase``."""
    u = np.maximum(np.sin(phase), 0.0)
    rising = rising_time(np.minimum(phase, np.pi - phase))
    instant = np.where(phase <= 0.5 * np.pi, rising, DURATION_CONSTANT - rising)
    return u, np.cos(phase) * velocity_factor(u), instant


def phase_at_fraction(fraction: Array) -> tuple[Array]:
    """Return the phase at ``fraction`` of the duration, by Newton's method for ``rising_time``."""
    share = np.minimum(fraction, 1.0 - fraction)
    instant = DURATION_CONSTANT * share
    phase = np.sqrt(instant) * (1.0 + AT_THE_TOP * 2.0 * share)
    for _ in range(NEWTON):
        off = rising_time(phase) - instant
        phase = phase - off / np.maximum(_slope(phase), np.finfo(np.float64).tiny)
    return (np.where(fraction <= 0.5, phase, np.pi - phase),)


def remember(function: Callable[[Array], tuple[Array, ...]], at: Real) -> tuple[Array, ...]:
    """Return ``function(at)``, cached if short: impacts with equal steps share their phases."""
    points = np.asarray(at, dtype=np.float64)
    if points.size > LONGEST_KEPT:
        return function(points)
    return tuple(array.reshape(points.shape) for array in _cache(function, points.tobytes()))


@lru_cache(maxsize=64)
def _cache(function: Callable[[Array], tuple[Array, ...]], at: bytes) -> tuple[Array, ...]:
    columns = function(np.frombuffer(at))
    for column in columns:
        column.flags.writeable = False
    return columns


@lru_cache(maxsize=16)
def _share(*_: float) -> dict[Any, Any]:
    """Return the dict that motions with equal numbers and as many axes share."""
    return {}


@attrs.frozen(kw_only=True, eq=False, repr=False, slots=False)  # frozen slots are slow to fill
class HertzMotion(ClosedFormMotion):
    """Elastic impact: V² + zeta^2.5 = 1 in scaled variables, theory §§1 and 3.

    With the phase x in [0, pi]: sqrt(zeta) = sin x = u, V = cos x g(u), dT/dx = 2u/g(u).
    """

    law: NormalLaw
    scene: Scene
    duration: Real
    maximum_radius: Real
    maximum_approach: Real
    maximum_force: Real
    final_rate: Real
    total_load_impulse: Real
    accuracy = 1e-14  # rounding: the impulse is a closed form

    @classmethod
    def of(cls, law: NormalLaw, scene: Scene) -> HertzMotion:
        """Return the motion of ``scene``, eqs (7)-(9); the final rate is minus the first."""
        (radius, approach, force, duration), speed = hertz_scales(scene), scene.normal_speed
        entries = {
            "law": law,
            "scene": scene,
            "duration": duration,
            "maximum_radius": radius,
            "maximum_approach": approach,
            "maximum_force": force,
            "final_rate": -speed,
            "total_load_impulse": 2.0 * scene.pair.normal_mass * speed,
        }
        return fill(cls, entries)

    @property
    def shared(self) -> dict[Any, Any] | None:
        """Values that equal motions share; arrays are slow to compare and share nothing."""
        if not isinstance(self.maximum_force, float):
            return None
        pair, speed = self.scene.pair, self.scene.normal_speed
        numbers: Any = (pair.radius, pair.effective_modulus, pair.normal_mass, speed)
        return _share(len(self.scene.shape), *numbers)

    def take(self, part: Index) -> HertzMotion:
        """Return the motion of some impacts."""
        return HertzMotion.of(self.law, self.scene.take(part))

    @property
    def scaled_mass(self) -> float:
        """Return 1/1.25, from V' = -1.25 zeta^1.5, theory §1."""
        return 0.8

    def scaled(self, phase: Array) -> ScaledContact:
        """Return zeta = u², b/a = u, V = cos x g(u), P/P_max = u³ and dT/dx = 2u/g(u)."""
        u = np.sin(phase)
        square = u * u
        g = np.sqrt(1.0 + square + square * square / (1.0 + u))
        return ScaledContact(phase, square, u, np.cos(phase) * g, u * square, (u + u) / g)

    def scaled_at(self, phase: float) -> ScaledContact:
        """Return the scaled motion at one phase, in plain floats."""
        u = math.sin(phase)
        square = u * u
        g = math.sqrt(1.0 + square + square * square / (1.0 + u))
        return ScaledContact(phase, square, u, math.cos(phase) * g, u * square, 2.0 * u / g)

    def phase_at_rate(self, rate: Real) -> Real:
        """Return x where V = ``rate``; by the tangent, accurate near the greatest compression."""
        u = np.maximum(0.0, (1.0 - rate) * (1.0 + rate)) ** 0.2
        return np.arctan2(u, rate / velocity_factor(u))

    def at(self, phase: Real) -> NormalSample:
        """Return the motion at ``phase`` in [0, pi]."""
        speed = self.scene.normal_speed
        u, rate, instant = remember(scale_motion, phase)
        instant = instant * (self.maximum_approach / speed)
        approach = u * u * self.maximum_approach
        force = u**3 * self.maximum_force
        contact = NormalContact(force, u * self.maximum_radius, approach, force)
        impulse = self.scene.pair.normal_mass * speed * (1.0 - rate)
        return NormalSample(instant, approach, rate * speed, contact, impulse)

    def phase(self, fraction: Real) -> Real:
        """Return the phase at ``fraction`` of the duration, by the inverse of ``scaled_time``."""
        return remember(phase_at_fraction, fraction)[0]
