"""Laws that fail on purpose: what an integrator does with them is what is tried."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any, ClassVar

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose.registry import REGISTRY
from contactlab.contracts import (
    ClosedFormMotion,
    ClosedFormNormalLaw,
    Increment,
    NormalContact,
    NormalMotion,
    NormalSample,
    Phase,
    PhasedTangentialLaw,
    PhaseResponse,
    PhaseSample,
    ScaledContact,
    SteppedTangentialLaw,
    TangentialResponse,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real

#: What a law may be asked for in one impact before it calls a halt.
MOST_CALLS = 3_000_000
#: Phase of the normal motion from which a spoiled one is NaN.
SPOILED_FROM = 1.0


class TooManyCallsError(RuntimeError):
    """An integrator asked without end."""


def _count(calls: Counter[str]) -> None:
    calls["asked"] += 1
    if calls["asked"] > MOST_CALLS:
        raise TooManyCallsError(f"The law was asked {MOST_CALLS} times.")


@attrs.frozen(kw_only=True)
class FailingSpring(SteppedTangentialLaw):
    """A spring that answers NaN, or raises, at one step; the state counts the steps.

    At the step 0, which is the start, it can only raise.
    """

    api_version: ClassVar[int] = 2
    at: int = 7
    raises: bool = False

    def start(self, scene: Scene, normal: NormalMotion) -> int:
        """Return that no step was taken."""
        if self.raises and self.at == 0:
            raise ArithmeticError("as it was asked to")
        return 0

    def advance(
        self,
        state: int,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, int]:
        """Answer with no force, until it fails."""
        nothing = 0.0 * increment.displacement
        if state + 1 >= self.at:
            if self.raises:
                raise ArithmeticError("as it was asked to")
            nothing = nothing + math.nan
        return TangentialResponse(nothing, nothing), state + 1


@attrs.frozen(kw_only=True)
class UnsettledSpring(FailingSpring):
    """A law without force that finds no answer from the seventh step on."""

    def advance(
        self,
        state: int,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, int]:
        """Answer with no force, and say that it is none."""
        nothing = 0.0 * increment.displacement
        return TangentialResponse(nothing, nothing, state + 1 < self.at), state + 1


@attrs.frozen(kw_only=True)
class Unyielding(SteppedTangentialLaw):
    """A law without force that says it is stiffer than any number of steps resolves."""

    api_version: ClassVar[int] = 2
    calls: Counter[str] = attrs.field(factory=Counter, eq=False, repr=False)

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return next to infinity."""
        return 1e300

    def start(self, scene: Scene, normal: NormalMotion) -> None:
        """Return nothing."""

    def advance(
        self,
        state: None,
        increment: Increment,
        before: NormalContact,
        after: NormalContact,
    ) -> tuple[TangentialResponse, None]:
        """Answer with no force, so many times."""
        _count(self.calls)
        nothing = 0.0 * increment.displacement
        return TangentialResponse(nothing, nothing), state


@attrs.frozen(kw_only=True)
class Recurring(Phase):
    """A phase that ends as it begins, and is followed by itself."""

    calls: Counter[str] = attrs.field(factory=Counter, eq=False, repr=False)
    begun: float = 0.0
    singular_events: tuple[bool, ...] = (False,)

    def respond(self, contact: ScaledContact, slip: Any, memo: Any) -> PhaseResponse:
        """Return no force."""
        _count(self.calls)
        return PhaseResponse(0.0 * contact.force, None, None, ())

    def margin(self, event: int, sample: PhaseSample) -> Any:
        """Return zero where the phase began, and less from there on."""
        return self.begun - sample.contact.phase + 0.0 * sample.slip

    def after_event(self, event: int, state: Any, contact: Any, output: Any) -> Phase:
        """Return the same phase, from here on."""
        _count(self.calls)
        return attrs.evolve(self, begun=state.x)


@attrs.frozen(kw_only=True)
class Endless(PhasedTangentialLaw):
    """Events without end, at first touch."""

    api_version: ClassVar[int] = 2

    def begin(self, velocity: float, inertia: float, motion: ClosedFormMotion) -> Phase:
        """Begin."""
        return Recurring()


class SpoiledMotion(ClosedFormMotion):
    """Another motion in closed form, NaN from ``SPOILED_FROM`` on."""

    def __init__(self, motion: ClosedFormMotion, law: ClosedFormNormalLaw) -> None:
        self.motion, self.law, self.scene = motion, law, motion.scene
        self.duration, self.final_rate = motion.duration, motion.final_rate
        self.maximum_radius, self.maximum_force = motion.maximum_radius, motion.maximum_force
        self.maximum_approach = motion.maximum_approach
        self.total_load_impulse = motion.total_load_impulse

    def at(self, phase: Real) -> NormalSample:
        """Return the motion, or NaN."""
        factor: Any = np.where(np.asarray(phase) < SPOILED_FROM, 1.0, math.nan)
        time, approach, rate, contact, impulse = self.motion.at(phase)
        contact = NormalContact(*(factor * entry for entry in contact))
        return NormalSample(time, factor * approach, factor * rate, contact, factor * impulse)

    def phase(self, fraction: Real) -> Real:
        """Return that of the other motion."""
        return self.motion.phase(fraction)

    def take(self, part: Any) -> NormalMotion:
        """Return the same of some impacts."""
        taken = self.motion.take(part)
        assert isinstance(taken, ClosedFormMotion)
        assert isinstance(self.law, ClosedFormNormalLaw)
        return SpoiledMotion(taken, self.law)

    @property
    def scaled_mass(self) -> float:
        """That of the other motion."""
        return self.motion.scaled_mass

    def scaled(self, phase: NDArray[np.float64]) -> ScaledContact:
        """Return the scaled motion, or NaN."""
        factor = np.where(phase < SPOILED_FROM, 1.0, math.nan)
        phases, *others = self.motion.scaled(phase)
        return ScaledContact(phases, *(factor * other for other in others))

    def scaled_at(self, phase: float) -> ScaledContact:
        """Return the same in plain floats."""
        factor = 1.0 if phase < SPOILED_FROM else math.nan
        at, *others = self.motion.scaled_at(phase)
        return ScaledContact(at, *(factor * other for other in others))

    def phase_at_rate(self, rate: Real) -> Real:
        """Return that of the other motion."""
        return self.motion.phase_at_rate(rate)


@attrs.frozen(kw_only=True)
class SpoiledHertz(ClosedFormNormalLaw):
    """Hertz's law with a motion that is NaN from ``SPOILED_FROM`` on."""

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "hertzian_pressure", "elastic_hertz"})

    law: Any = attrs.field(factory=lambda: REGISTRY.create("normal.hertz"))

    def start(self, scene: Scene) -> Any:
        """Return the state of Hertz's law."""
        return self.law.start(scene)

    def respond(self, state: Any, approach: Real, rate: Real) -> tuple[NormalContact, Any]:
        """Return the contact."""
        contact, new = self.law.respond(state, approach, rate)
        return contact, new

    def motion(self, scene: Scene) -> ClosedFormMotion:
        """Return the spoiled motion."""
        return SpoiledMotion(self.law.motion(scene), self)
