"""The motion of an impact under a spring and dashpot, in closed form."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    ClosedFormMotion,
    NormalContact,
    NormalLaw,
    NormalSample,
    ScaledContact,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real
from contactlab.numeric.lobatto import lobatto, rows
from contactlab_laws.dashpot.oscillator import Oscillator

Array = NDArray[np.float64]

#: Panels over which time is added up: even ones, then halved towards the end, where x^-0.2 is
#: nearly singular under little damping; and nodes in each.
EDGES = np.concatenate((np.arange(8) / 8.0, 1.0 - 0.125 * 0.5 ** np.arange(1, 41), [1.0]))
NODES = 16
#: Points from which an inverse begins, and steps of Newton's method.
POINTS, NEWTON = 2000, 4
#: Time goes as the fourth power of the phase at first touch, approach as the fifth: the fifth root
#: of either makes a table of the inverse even.
ROOT = 0.2


def stretched(share: Any) -> Any:
    """Return tau = t⁵/(t⁵ + (1 - t)/16): oscillator time over duration, t the phase over pi.

    tau = ½ at t = ½, greatest compression; x^0.2 and so zeta^¼ is analytic at first touch.
    """
    fifth = share**5
    return fifth / (fifth + (1.0 - share) / 16.0)


def stretching(share: Any) -> Any:
    """Return d tau/dt over t⁴."""
    return (5.0 - 4.0 * share) / 16.0 / (share**5 + (1.0 - share) / 16.0) ** 2


class Scaled(NamedTuple):
    """zeta, V, force and dT/dt in the units of the undamped impact; t is the phase over pi."""

    approach: Any
    rate: Any
    force: Any
    pace: Any


@attrs.frozen
class Course:
    """The scaled motion: the oscillator with x = zeta^q, d sigma = q zeta^(q-1) dT.

    V' = -q P^, P^ = zeta^(q-1) (x + 2 beta V).

    Attributes
    ----------
    damping : float
        beta.
    power : float
        q: 1 of the linear law, 1.25 of Tsuji's.
    """

    damping: float
    power: float

    @property
    def oscillator(self) -> Oscillator:
        """The motion in its own time."""
        return Oscillator(self.damping)

    @property
    def deepest(self) -> float:
        """Greatest zeta: x_max = sqrt e."""
        return math.pow(self.oscillator.restitution, 0.5 / self.power)

    @property
    def strongest(self) -> float:
        """Greatest P^, from its derivative.

        It is zero where y = V/x solves 2 beta p y² + (1 + p - 4 beta²) y - 2 beta = 0, with
        p = 1 - 1/q, that is at tan(w sigma) = w/(y + beta), w² = 1 - beta². A linear dashpot of
        beta >= ½ has no such y: its force is greatest at first touch.
        """
        beta, p = self.damping, 1.0 - 1.0 / self.power
        if beta == 0.0:
            return 1.0
        linear = 1.0 + p - 4.0 * beta * beta
        if p == 0.0 and linear <= 0.0:
            return 2.0 * beta
        size = math.hypot(linear, 4.0 * beta * p**0.5)
        ratio = 4.0 * beta / (linear + size) if linear > 0.0 else (size - linear) / (4.0 * beta * p)
        square = (1.0 - beta) * (1.0 + beta)
        root = abs(square) ** 0.5
        if square > 0.0:
            instant = math.atan2(root, ratio + beta) / root
        else:
            instant = math.atanh(root / (ratio + beta)) / root if root else 1.0 / (ratio + beta)
        x, _, pull = self.oscillator.at(instant)
        return float(x**p * pull)

    def at(self, phase: Any) -> Scaled:
        """Return the scaled motion at ``phase`` in [0, pi]."""
        share = np.asarray(phase) / math.pi
        duration = self.oscillator.duration
        x, rate, pull = self.oscillator.at(duration * stretched(share))
        p = 1.0 - 1.0 / self.power
        factor = x**p  # zeta^(q-1)
        pace = duration * stretching(share) * share**4 / (self.power * factor + (factor == 0.0))
        return Scaled(x ** (1.0 / self.power), rate, factor * pull, pace)

    def time(self, phase: Any) -> Array:
        """Return T at ``phase``."""
        share = np.clip(np.asarray(phase, dtype=np.float64) / math.pi, 0.0, 1.0)
        values = _times(self)
        panel = np.clip(EDGES.searchsorted(share) - 1, 0, len(EDGES) - 2)
        place = (share - EDGES[panel]) / (EDGES[panel + 1] - EDGES[panel])
        return np.asarray((rows(lobatto(NODES), place) * values[panel]).sum(axis=-1))

    @property
    def duration(self) -> float:
        """T at the end."""
        return float(_times(self)[-1, -1])

    def phase_at(self, fraction: Real) -> Array:
        """Return the phase at ``fraction`` of the duration."""
        asked, points = np.asarray(fraction, dtype=np.float64), _points()
        listed = np.maximum(self.time(points), 0.0) / self.duration
        found = np.interp(np.clip(asked, 0.0, 1.0) ** ROOT, listed**ROOT, points)
        for _ in range(NEWTON):
            slope = self.at(found).pace / (math.pi * self.duration)
            away = (self.time(found) / self.duration - asked) / (slope + (slope == 0.0))
            found = np.clip(found - away, 0.0, math.pi)
        return np.where(asked >= 1.0, math.pi, np.where(asked <= 0.0, 0.0, found))

    def phase_at_rate(self, rate: Real) -> Array:
        """Return the phase at which V = ``rate``."""
        asked, points = np.asarray(rate, dtype=np.float64), _points()
        fallen = np.maximum(1.0 - self.at(points).rate, 0.0)
        found = np.interp(np.maximum(1.0 - asked, 0.0) ** ROOT, fallen**ROOT, points)
        for _ in range(NEWTON):
            here = self.at(found)
            slope = -self.power * here.force * here.pace / math.pi
            found = np.clip(found - (here.rate - asked) / (slope - (slope == 0.0)), 0.0, math.pi)
        return found


@lru_cache(maxsize=64)
def _times(course: Course) -> Array:
    """Return T at the nodes of each panel, shape (panels, NODES)."""
    width = np.diff(EDGES)[:, None]
    pace = course.at(math.pi * (EDGES[:-1, None] + width * lobatto(NODES).points)).pace
    within = width * (pace @ lobatto(NODES).integral.T)
    before = np.concatenate(([0.0], np.cumsum(within[:-1, -1])))
    return np.asarray(before[:, None] + within)


def _points() -> Array:
    """Return phases close to both ends."""
    return 0.5 * math.pi * (1.0 - np.cos(np.linspace(0.0, math.pi, POINTS)))


@lru_cache(maxsize=64)
def _phases(course: Course, fractions: bytes) -> Array:
    found = course.phase_at(np.frombuffer(fractions))
    found.flags.writeable = False
    return found


@attrs.frozen(kw_only=True, eq=False, repr=False)
class DashpotMotion(ClosedFormMotion):
    """The scaled motion in SI: ``approach`` and ``force`` are those of the undamped impact."""

    law: NormalLaw
    scene: Scene
    course: Course
    undamped_approach: Real
    duration: Real
    maximum_radius: Real
    maximum_approach: Real
    maximum_force: Real
    final_rate: Real
    total_load_impulse: Real
    accuracy = 1e-14  # rounding: the impulse is a closed form

    @classmethod
    def of(cls, law: NormalLaw, scene: Scene, course: Course, approach: Real) -> DashpotMotion:
        """Return the motion of ``scene``.

        Parameters
        ----------
        law : NormalLaw
        scene : Scene
        course : Course
        approach : float or array
            Greatest approach without damping, in m.
        """
        speed, e = scene.normal_speed, course.oscillator.restitution
        momentum = scene.pair.normal_mass * speed
        deepest = course.deepest * approach
        return cls(
            law=law,
            scene=scene,
            course=course,
            undamped_approach=approach,
            duration=course.duration * (approach / speed),
            maximum_radius=(scene.pair.radius * deepest) ** 0.5,
            maximum_approach=deepest,
            maximum_force=course.strongest * course.power * momentum * (speed / approach),
            final_rate=-e * speed,
            total_load_impulse=(1.0 + e) * momentum,
        )

    def take(self, part: object) -> DashpotMotion:
        """Return the motion of some impacts."""
        law: Any = self.law
        taken: DashpotMotion = law.motion(self.scene.take(part))
        return taken

    @property
    def scaled_mass(self) -> float:
        """V' = -q P^ in the units of the undamped impact, in those of this one."""
        return 1.0 / (self.course.deepest * self.course.power * self.course.strongest)

    def scaled(self, phase: Array) -> ScaledContact:
        """Return the motion over its own greatest values."""
        course = self.course
        here, deepest = course.at(phase), course.deepest
        approach = here.approach / deepest
        return ScaledContact(
            phase,
            approach,
            approach**0.5,
            here.rate,
            here.force / course.strongest,
            here.pace / (math.pi * deepest),
        )

    def scaled_at(self, phase: float) -> ScaledContact:
        """Return the same in plain floats."""
        return ScaledContact(*map(float, self.scaled(np.asarray(phase))))

    def phase_at_rate(self, rate: Real) -> Real:
        """Return the phase at which V = ``rate``, by Newton's method."""
        return self.course.phase_at_rate(rate)

    def phase(self, fraction: Real) -> Real:
        """Return the phase at ``fraction`` of the duration, by Newton's method."""
        asked = np.asarray(fraction, dtype=np.float64)
        return _phases(self.course, asked.tobytes()).reshape(asked.shape)

    @np.errstate(under="ignore")  # interpolation on a node leaves the others a share of 1e-290
    def at(self, phase: Real) -> NormalSample:
        """Return the motion at ``phase`` in [0, pi]."""
        speed, unit = self.scene.normal_speed, self.undamped_approach
        momentum = self.scene.pair.normal_mass * speed
        here = self.course.at(phase)
        approach = here.approach * unit
        force = here.force * (self.course.power * momentum * (speed / unit))
        contact = NormalContact(force, (self.scene.pair.radius * approach) ** 0.5, approach, force)
        return NormalSample(
            self.course.time(phase) * (unit / speed),
            approach,
            here.rate * speed,
            contact,
            momentum * (1.0 - here.rate),
        )
