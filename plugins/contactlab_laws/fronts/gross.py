"""Gross slip, in closed form."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts import ClosedFormMotion, ClosedPhase, PhaseState, ScaledContact
from contactlab.numeric.arrays import chosen
from contactlab.numeric.lobatto import Array

#: Step in x from which the rate of force at the end is guessed.
RATE_STEP = 1e-5


class Slide(NamedTuple):
    """Gross slip of one or many impacts: whether it stops, x there, and what it changed.

    Change of velocity = share · inertia · mass · (V - V_0), theory §1; slip of sign s ends
    where s psi falls to V, both linear in V, so that the end is known too. Work is the integral
    of (s psi - V) P over T, and P dT = -mass dV.
    """

    stops: Any
    end: Any
    gained: Any
    work: Any

    @classmethod
    def along(
        cls, motion: ClosedFormMotion, inertia: Any, share: Any, first: ScaledContact, velocity: Any
    ) -> Slide:
        """Return slip with the force ``share`` · P.

        Parameters
        ----------
        motion : ClosedFormMotion
        inertia, share : float or ndarray
        first : ScaledContact
            Where slip begins.
        velocity : float or ndarray
            psi there.
        """
        last = motion.scaled_at(np.pi).rate
        ratio = inertia * motion.scaled_mass
        # below 1 the margin only grows
        spread = chosen(ratio > 1.0, ratio - 1.0, np.inf)
        stop = (ratio * first.rate - share * velocity) / spread
        stop = chosen(first.rate < stop, first.rate, stop)
        stops = (ratio > 1.0) & (stop > last)
        rate = chosen(stops, stop, last)
        # to the end, V = -1: from the energy 1 - V², as the difference would cancel
        late = (rate == last) & (first.rate < 0.0)
        rest = first.approach * first.force / (1.0 - chosen(first.rate < 0.0, first.rate, 0.0))
        fall = chosen(late, rest, first.rate - rate)
        gained = -share * ratio * fall
        mean = share * (velocity + 0.5 * gained) - 0.5 * (first.rate + rate)
        end = chosen(stops, np.maximum(motion.phase_at_rate(rate), first.phase), np.pi)
        return cls(stops, end, gained, motion.scaled_mass * fall * mean)


class GrossMotion(ClosedPhase):
    """Force = share · P, to the end of slip or of contact: psi falls in proportion to V.

    Parameters
    ----------
    share : float
    state : PhaseState
        Where it begins.
    motion : ClosedFormMotion
    inertia : float
    """

    def __init__(
        self, share: float, state: PhaseState, motion: ClosedFormMotion, inertia: float
    ) -> None:
        first = motion.scaled_at(state.x)
        slide = Slide.along(motion, inertia, share, first, state.velocity)
        self.share, self.first, self.start = share, first.rate, state
        self.ratio = inertia * motion.scaled_mass
        self.event = 0 if slide.stops else None
        x = float(slide.end)
        normal, before = motion.scaled_at(x), motion.scaled_at(x - RATE_STEP)
        rate = (normal.force - before.force) / (RATE_STEP * before.time_rate)
        gained = float(slide.gained)
        self.end = PhaseState(
            x=x,
            slip=state.slip,
            change=state.change + gained,
            velocity=state.velocity + gained,
            force=share * normal.force,
            force_rate=share * rate,
            work=state.work + float(slide.work),
        )

    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return (change of velocity, force)."""
        gained = self.share * self.ratio * (contact.rate - self.first)
        return self.start.change + gained, self.share * contact.force
