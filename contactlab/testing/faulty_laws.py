"""Laws that fail on purpose, on which integrators are checked."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from typing import ClassVar

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    ClosedFormMotion,
    ClosedFormNormalLaw,
    Increment,
    NormalContact,
    NormalMotion,
    NormalSample,
    PathTangentialLaw,
    ScaledContact,
    SteppedTangentialLaw,
    Stretch,
    TangentialResponse,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Index, Real
from contactlab.registry.registry import REGISTRY

#: Calls of a law after which it raises ``TooManyCallsError``.
MOST_CALLS = 3_000_000
#: Phase of the normal motion from which a spoiled motion is NaN.
SPOILED_FROM = 1.0


class TooManyCallsError(RuntimeError):
    """An integrator called a law without end."""


def _count(calls: Counter[str]) -> None:
    calls["asked"] += 1
    if calls["asked"] > MOST_CALLS:
        raise TooManyCallsError(f"The law was asked {MOST_CALLS} times.")


@attrs.frozen(kw_only=True)
class FailingSpring(SteppedTangentialLaw):
    """A law without force that answers NaN, or raises, from step ``at`` on.

    The state counts the steps. With ``at=0`` and ``raises`` the start raises.
    """

    api_version: ClassVar[int] = 2
    settles: ClassVar[bool] = True
    at: int = 7
    raises: bool = False

    def start(self, scene: Scene, normal: NormalMotion) -> int:
        """Return 0, the number of steps so far."""
        if self.raises and self.at == 0:
            raise ArithmeticError("as it was asked to")
        return 0

    def advance(
        self, state: int, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, int]:
        """Return no force; the fault from step ``at`` on."""
        failed = state + 1 >= self.at
        if failed and self.raises:
            raise ArithmeticError("as it was asked to")
        nothing = 0.0 * increment.displacement + (math.nan if failed and self.settles else 0.0)
        return TangentialResponse(nothing, nothing, self.settles or not failed), state + 1


class UnsettledSpring(FailingSpring):
    """A law without force that does not settle from step ``at`` on."""

    settles: ClassVar[bool] = False


@attrs.frozen(kw_only=True)
class Unyielding(SteppedTangentialLaw):
    """A law without force that states a stiffness beyond what any number of steps resolves."""

    api_version: ClassVar[int] = 2
    calls: Counter[str] = attrs.field(factory=Counter, eq=False, repr=False)

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return 1e300 N/m."""
        return 1e300

    def start(self, scene: Scene, normal: NormalMotion) -> None:
        """Return None; the law has no state."""

    def advance(
        self, state: None, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, None]:
        """Return no force, and count the call."""
        _count(self.calls)
        nothing = 0.0 * increment.displacement
        return TangentialResponse(nothing, nothing), state


@attrs.frozen
class Nowhere(Stretch):
    """A stretch that ends where it begins."""

    start: float = 0.0
    stop: float = 0.0
    change: float = 0.0
    work: float = 0.0

    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return no change and no force."""
        return 0.0 * contact.force, 0.0 * contact.force


@attrs.frozen(kw_only=True)
class Endless(PathTangentialLaw):
    """A law with endless events at first touch."""

    api_version: ClassVar[int] = 2
    calls: Counter[str] = attrs.field(factory=Counter, eq=False, repr=False)

    def path(
        self, velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
    ) -> Iterator[Stretch]:
        """Yield stretches of no length."""
        while True:
            _count(self.calls)
            yield Nowhere()


class SpoiledMotion(ClosedFormMotion):
    """A motion in closed form that is NaN from the phase ``SPOILED_FROM`` on."""

    def __init__(self, motion: ClosedFormMotion, law: ClosedFormNormalLaw) -> None:
        self.motion, self.law, self.scene = motion, law, motion.scene
        self.duration, self.final_rate = motion.duration, motion.final_rate
        self.maximum_radius, self.maximum_force = motion.maximum_radius, motion.maximum_force
        self.maximum_approach = motion.maximum_approach
        self.total_load_impulse = motion.total_load_impulse

    def at(self, phase: Real) -> NormalSample:
        """Return the sample of the motion, or NaN."""
        factor = np.where(np.asarray(phase) < SPOILED_FROM, 1.0, math.nan)
        time, approach, rate, contact, impulse = self.motion.at(phase)
        contact = NormalContact(*(factor * entry for entry in contact))
        return NormalSample(time, factor * approach, factor * rate, contact, factor * impulse)

    def phase(self, fraction: Real) -> Real:
        """Return the phase of the sound motion."""
        return self.motion.phase(fraction)

    def take(self, part: Index) -> NormalMotion:
        """Return the spoiled motion of a part of the impacts."""
        taken = self.motion.take(part)
        assert isinstance(taken, ClosedFormMotion)
        assert isinstance(self.law, ClosedFormNormalLaw)
        return SpoiledMotion(taken, self.law)

    @property
    def scaled_mass(self) -> float:
        """Scaled mass of the sound motion."""
        return self.motion.scaled_mass

    def scaled(self, phase: NDArray[np.float64]) -> ScaledContact:
        """Return the scaled contact, or NaN."""
        factor = np.where(phase < SPOILED_FROM, 1.0, math.nan)
        phases, *others = self.motion.scaled(phase)
        return ScaledContact(phases, *(factor * other for other in others))

    def scaled_at(self, phase: float) -> ScaledContact:
        """Return the scaled contact in floats, or NaN."""
        at, *others = self.motion.scaled_at(phase)
        return ScaledContact(
            at, *((1.0 if phase < SPOILED_FROM else math.nan) * other for other in others)
        )

    def phase_at_rate(self, rate: Real) -> Real:
        """Return the phase of the sound motion at a rate."""
        return self.motion.phase_at_rate(rate)


@attrs.frozen(kw_only=True)
class SpoiledHertz(ClosedFormNormalLaw):
    """Hertz's law with a motion that is NaN from the phase ``SPOILED_FROM`` on."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "hertzian_pressure", "elastic_hertz"})

    law: ClosedFormNormalLaw = attrs.field(  # type: ignore[assignment]  # Hertz's law is one
        factory=lambda: REGISTRY.create("normal.hertz")
    )

    def start(self, scene: Scene) -> object:
        """Return the state of Hertz's law."""
        return self.law.start(scene)

    def respond(self, state: object, approach: Real, rate: Real) -> tuple[NormalContact, object]:
        """Return the contact of Hertz's law."""
        contact, new = self.law.respond(state, approach, rate)
        return contact, new

    def motion(self, scene: Scene) -> ClosedFormMotion:
        """Return the spoiled motion."""
        return SpoiledMotion(self.law.motion(scene), self)
