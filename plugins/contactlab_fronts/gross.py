"""Gross slip, in closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import ClosedFormMotion, ClosedPhase, PhaseState, ScaledContact

Array = NDArray[np.float64]

#: Step in x from which the rate of force at the end is guessed.
RATE_STEP = 1e-5


class GrossMotion(ClosedPhase):
    """Force = share · P, to the end of slip or of contact: psi falls in proportion to V.

    Change of velocity = share · inertia · mass · (V - V_0), theory §1; slip of sign s ends
    where s psi falls to V, both linear in V, so that the end is known too.
    """

    def __init__(
        self, share: float, state: PhaseState, motion: ClosedFormMotion, inertia: float
    ) -> None:
        first = motion.scaled_at(state.x)
        last = motion.scaled_at(np.pi).rate
        ratio = inertia * motion.scaled_mass
        self.share, self.ratio, self.first, self.start = share, ratio, first.rate, state
        self.event = None
        x = np.pi
        if ratio > 1.0:  # below, the margin only grows
            stop = min((ratio * first.rate - share * state.velocity) / (ratio - 1.0), first.rate)
            if stop > last:
                last, self.event = stop, 0
                x = max(motion.phase_at_rate(last), state.x)
        fall = first.rate - last
        if self.event is None and first.rate < 0.0:
            # to the end, V = -1: from the energy 1 - V², as the difference would cancel
            fall = first.approach * first.force / (1.0 - first.rate)
        gained = -share * ratio * fall
        normal, before = motion.scaled_at(x), motion.scaled_at(x - RATE_STEP)
        rate = (normal.force - before.force) / (RATE_STEP * before.time_rate)
        # Work is the integral of (s psi - V) P over T, and P dT = -mass dV.
        mean = share * (state.velocity + 0.5 * gained) - 0.5 * (first.rate + last)
        self.end = PhaseState(
            x=x,
            slip=state.slip,
            change=state.change + gained,
            velocity=state.velocity + gained,
            force=share * normal.force,
            force_rate=share * rate,
            work=state.work + motion.scaled_mass * fall * mean,
        )

    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return (change of velocity, force)."""
        gained = self.share * self.ratio * (contact.rate - self.first)
        return self.start.change + gained, self.share * contact.force
