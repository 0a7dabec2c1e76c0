"""Rigid-body friction as phases: sliding, then rolling."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    ClosedFormMotion,
    ClosedPhase,
    Course,
    Path,
    Phase,
    PhaseResponse,
    PhaseState,
)

Array = NDArray[np.float64]
Memo = tuple[Array, ...]


class SlidingMotion(ClosedPhase):
    """Force = P: the change of velocity is that of V, times inertia and mass (theory §1).

    Where friction stops the slip it takes all of the velocity, to the last bit: the rate at
    which that happens, a small difference from V_0 where the slip is slow, only tells when.
    """

    def __init__(self, state: PhaseState, motion: ClosedFormMotion, inertia: float) -> None:
        first, last = motion.instant(state.x).rate, motion.instant(np.pi).rate
        self.ratio, self.first, self.start = inertia * motion.scaled_mass, first, state
        available = self.ratio * (first - last)
        stops = state.velocity < available
        self.event = 0 if stops else None
        lost = state.velocity if stops else available
        x = float(np.pi)
        if stops:
            x = max(motion.phase_at_rate(first - lost / self.ratio), state.x)
        left = state.velocity - lost
        self.end = PhaseState(
            x=x,
            slip=state.slip,
            change=state.change - lost,
            velocity=left,
            force=0.0,
            force_rate=0.0,
            # Impulse times mean velocity.
            work=state.work + (lost / inertia) * (left + 0.5 * lost),
        )

    def states(self, contact: Course) -> tuple[Array, Array]:
        """Return (change of velocity, force)."""
        lost = self.ratio * (self.first - contact.rate)
        return self.start.change - np.minimum(lost, self.start.velocity), contact.force


@attrs.frozen
class Rolling(Phase):
    """No slip and no force, to the end of contact."""

    dissipates = False

    def respond(self, contact: Course, slip: Array, memo: Memo) -> PhaseResponse:  # noqa: ARG002
        """F = 0."""
        return PhaseResponse(np.zeros_like(slip), None, None, ())


@attrs.frozen
class Sliding(Phase):
    """Slip in the positive sense: F = P, until the velocity is zero."""

    rough = (False,)

    def respond(self, contact: Course, slip: Array, memo: Memo) -> PhaseResponse:  # noqa: ARG002
        """F = P, whatever the slip."""
        return PhaseResponse(contact.force, None, None, ())

    def margin(
        self,
        event: int,  # noqa: ARG002
        contact: Course,  # noqa: ARG002
        slip: Array,  # noqa: ARG002
        velocity: Array,
        response: PhaseResponse,  # noqa: ARG002
    ) -> Array:
        """Slip goes on while psi > 0."""
        return velocity

    def follow(self, event: int, state: PhaseState, contact: Course, path: Path | None) -> Phase:  # noqa: ARG002
        """Roll."""
        return Rolling()

    def friction_power(
        self,
        contact: Course,
        slip: Array,  # noqa: ARG002
        velocity: Array,
        response: PhaseResponse,  # noqa: ARG002
    ) -> Array:
        """Force times velocity."""
        return np.asarray(contact.force * velocity)

    def closed_form(
        self, state: PhaseState, motion: ClosedFormMotion, inertia: float
    ) -> ClosedPhase:
        """Return psi in proportion to V."""
        return SlidingMotion(state, motion, inertia)
