"""The motion of an impact under a spring and dashpot, in closed form."""

from __future__ import annotations

import math
from functools import cache, lru_cache
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    NormalContact,
    NormalLaw,
    NormalMotion,
    NormalSample,
    ScaledContact,
    Units,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.lobatto import lobatto, rows
from contactlab.numeric.types import Array, Index, Kind, Real
from contactlab_laws.dashpot.oscillator import Oscillator

#: Edges of the panels over which time is summed, and nodes in each panel. Panels are even, then
#: halved towards the end, where x^-0.2 is nearly singular under little damping.
EDGES = np.concatenate((np.arange(8) / 8.0, 1.0 - 0.125 * 0.5 ** np.arange(1, 41), [1.0]))
NODES = 16
#: Points of the table from which Newton's method begins an inverse, and its steps.
POINTS, NEWTON = 2000, 4
#: Time goes as the fourth power of the phase at first touch, approach as the fifth: the fifth root
#: of either makes a table of the inverse even.
ROOT = 0.2


def stretch_time(share: Kind) -> Kind:
    """Return tau = t⁵/(t⁵ + (1 - t)/16): oscillator time over duration, t the phase over pi."""
    # tau = ½ at t = ½, greatest compression; x^0.2 and so zeta^¼ is analytic at first touch.
    fifth = share**5
    return fifth / (fifth + (1.0 - share) / 16.0)


def stretching(share: Kind) -> Kind:
    """Return d tau/dt over t⁴."""
    return (5.0 - 4.0 * share) / 16.0 / (share**5 + (1.0 - share) / 16.0) ** 2


class ScaledSample(NamedTuple):
    """zeta, V, force and dT/dt in units of the undamped impact; t is the phase over pi."""

    approach: Real
    rate: Real
    force: Real
    pace: Real


@attrs.frozen
class ScaledMotion:
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
        """The motion in the oscillator's own time."""
        return Oscillator(self.damping)

    @property
    def deepest(self) -> float:
        """Greatest zeta: x_max = sqrt e."""
        return math.pow(self.oscillator.restitution, 0.5 / self.power)

    @property
    def strongest(self) -> float:
        """Greatest P^, from the zero of its derivative."""
        # It is zero where y = V/x solves 2 beta p y² + (1 + p - 4 beta²) y - 2 beta = 0,
        # p = 1 - 1/q, that is at tan(w sigma) = w/(y + beta), w² = 1 - beta². A linear dashpot of
        # beta >= ½ has no such y: its force is greatest at first touch.
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

    def at(self, phase: Real) -> ScaledSample:
        """Return the scaled motion at ``phase`` in [0, pi]."""
        share = np.asarray(phase) / math.pi
        duration = self.oscillator.duration
        x, rate, pull = self.oscillator.at(duration * stretch_time(share))
        p = 1.0 - 1.0 / self.power
        factor = x**p  # zeta^(q-1)
        pace = duration * stretching(share) * share**4 / (self.power * factor + (factor == 0.0))
        return ScaledSample(x ** (1.0 / self.power), rate, factor * pull, pace)

    def time(self, phase: Real) -> Array:
        """Return T at ``phase``, of its shape."""
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
        wanted, points = np.asarray(fraction, dtype=np.float64), _points()
        fractions = np.maximum(self.time(points), 0.0) / self.duration
        phase = np.interp(np.clip(wanted, 0.0, 1.0) ** ROOT, fractions**ROOT, points)
        for _ in range(NEWTON):
            slope = self.at(phase).pace / (math.pi * self.duration)
            error = (self.time(phase) / self.duration - wanted) / (slope + (slope == 0.0))
            phase = np.clip(phase - error, 0.0, math.pi)
        return np.where(wanted >= 1.0, math.pi, np.where(wanted <= 0.0, 0.0, phase))

    def phase_at_rate(self, rate: Real) -> Real:
        """Return the phase at which V = ``rate``."""
        wanted, points = np.asarray(rate, dtype=np.float64), _points()
        losses = np.maximum(1.0 - self.at(points).rate, 0.0)
        phase = np.interp(np.maximum(1.0 - wanted, 0.0) ** ROOT, losses**ROOT, points)
        for _ in range(NEWTON):
            sample = self.at(phase)
            slope = -self.power * sample.force * sample.pace / math.pi
            error = (sample.rate - wanted) / (slope - (slope == 0.0))
            phase = np.clip(phase - error, 0.0, math.pi)
        return phase


@lru_cache(maxsize=64)
def _times(motion: ScaledMotion) -> Array:
    """Return T at the nodes of each panel, shape (panels, NODES)."""
    width = np.diff(EDGES)[:, None]
    pace = motion.at(math.pi * (EDGES[:-1, None] + width * lobatto(NODES).points)).pace
    within = width * (pace @ lobatto(NODES).integral.T)
    before = np.concatenate(([0.0], np.cumsum(within[:-1, -1])))
    return np.asarray(before[:, None] + within)


def _points() -> Array:
    """Return phases close to both ends."""
    return 0.5 * math.pi * (1.0 - np.cos(np.linspace(0.0, math.pi, POINTS)))


@lru_cache(maxsize=64)
def _phases(motion: ScaledMotion, fractions: bytes) -> Array:
    phases = motion.phase_at(np.frombuffer(fractions))
    phases.flags.writeable = False
    return phases


@lru_cache(maxsize=16)
def _share(*_: object) -> dict[Any, Any]:
    """Return the dict that motions with the same scaled motion and numbers share."""
    return {}


@cache
def _first() -> Scene:
    """Return the impact from which motions in other units are made."""
    return Scene.nondimensional(psi1=0.0, chi=1.0)


@attrs.frozen(kw_only=True, eq=False, repr=False)
class DashpotMotion(ClosedFormMotion):
    """Motion under spring and dashpot: a scaled motion in units of the undamped impact."""

    law: NormalLaw
    scene: Scene
    motion: ScaledMotion
    undamped_approach: Real
    duration: Real
    maximum_radius: Real
    maximum_approach: Real
    maximum_force: Real
    final_rate: Real
    total_load_impulse: Real
    accuracy = 1e-14  # rounding: the impulse is a closed form

    @classmethod
    def of(
        cls, law: NormalLaw, scene: Scene, motion: ScaledMotion, approach: Real
    ) -> DashpotMotion:
        """Return the motion of ``scene``; ``approach`` is the largest without damping, in m."""
        speed, e = scene.normal_speed, motion.oscillator.restitution
        momentum = scene.pair.normal_mass * speed
        deepest = motion.deepest * approach
        return cls(
            law=law,
            scene=scene,
            motion=motion,
            undamped_approach=approach,
            duration=motion.duration * (approach / speed),
            maximum_radius=(scene.pair.radius * deepest) ** 0.5,
            maximum_approach=deepest,
            maximum_force=motion.strongest * motion.power * momentum * (speed / approach),
            final_rate=-e * speed,
            total_load_impulse=(1.0 + e) * momentum,
        )

    @property
    def shared(self) -> dict[Any, Any] | None:
        """Values that the pattern keeps from run to run."""
        return _share(self.motion) if self.scene is _first() else None

    @property
    def pattern(self) -> tuple[NormalMotion, Units] | None:
        """An undamped approach of 1 m in the first impact of all."""
        one, first, pair = self.scene, _first(), self.scene.pair
        time = self.undamped_approach / one.normal_speed * first.normal_speed
        rate = one.normal_speed / first.normal_speed
        units = Units(
            time=time,
            approach=self.undamped_approach,
            rate=rate,
            force=pair.normal_mass / first.pair.normal_mass * rate / time,
            radius=(pair.radius * self.undamped_approach / first.pair.radius) ** 0.5,
        )
        return DashpotMotion.of(self.law, first, self.motion, 1.0), units

    def take(self, part: Index) -> DashpotMotion:
        """Return the motion of some impacts."""
        law: Any = self.law
        taken: DashpotMotion = law.motion(self.scene.take(part))
        return taken

    @property
    def scaled_mass(self) -> float:
        """Return M of V' = -P^/M, with zeta and P^ over their own greatest values."""
        return 1.0 / (self.motion.deepest * self.motion.power * self.motion.strongest)

    def scaled(self, phase: Array) -> ScaledContact:
        """Return the motion over its own greatest values."""
        motion = self.motion
        sample, deepest = motion.at(phase), motion.deepest
        approach = sample.approach / deepest
        return ScaledContact(
            phase,
            approach,
            approach**0.5,
            sample.rate,
            sample.force / motion.strongest,
            sample.pace / (math.pi * deepest),
        )

    def scaled_at(self, phase: float) -> ScaledContact:
        """Return the scaled motion at one phase, in plain floats."""
        return ScaledContact(*map(float, self.scaled(np.asarray(phase))))

    def phase_at_rate(self, rate: Real) -> Real:
        """Return the phase at which V = ``rate``, by Newton's method."""
        return self.motion.phase_at_rate(rate)

    def phase(self, fraction: Real) -> Real:
        """Return the phase at ``fraction`` of the duration, by Newton's method."""
        wanted = np.asarray(fraction, dtype=np.float64)
        return _phases(self.motion, wanted.tobytes()).reshape(wanted.shape)

    @np.errstate(under="ignore")  # on a node the other nodes have weights near 1e-290
    def at(self, phase: Real) -> NormalSample:
        """Return the motion at ``phase`` in [0, pi]."""
        speed, unit = self.scene.normal_speed, self.undamped_approach
        momentum = self.scene.pair.normal_mass * speed
        sample = self.motion.at(phase)
        approach = sample.approach * unit
        force = sample.force * (self.motion.power * momentum * (speed / unit))
        contact = NormalContact(force, (self.scene.pair.radius * approach) ** 0.5, approach, force)
        return NormalSample(
            self.motion.time(phase) * (unit / speed),
            approach,
            sample.rate * speed,
            contact,
            momentum * (1.0 - sample.rate),
        )
