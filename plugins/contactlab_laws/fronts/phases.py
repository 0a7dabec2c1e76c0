"""The phases of the spring bundle: stuck, edge slip, gross slip (theory §5)."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    ClosedPhase,
    DenseOutput,
    Phase,
    PhaseResponse,
    PhaseSample,
    PhaseState,
    ScaledContact,
)
from contactlab.numeric.lobatto import Array
from contactlab_laws.fronts.gross import GrossMotion
from contactlab_laws.fronts.laid import Laid
from contactlab_laws.fronts.profile import Front, Locked, Memo, ProfilePiece

Profile = tuple[ProfilePiece, ...]


class FrontPhase(Phase):
    """A phase of the spring bundle: stuck within a radius, slipping one way outside."""

    def division(self, contact: ScaledContact, slip: float) -> tuple[float, int]:
        """Return radius of the front and sign of slip outside it: here all sticks."""
        return contact.radius, 0


@attrs.frozen(eq=False)
class Stuck(FrontPhase):
    """All springs stick while the contact grows; new ones are laid down unstressed.

    ``began`` is the sign of the slip that stopped where it starts, 0 for none.
    """

    profile: Profile
    start: float
    force: float
    began: int

    singular_events = (False, False)
    linear = True
    dissipates = False

    def respond(self, contact: ScaledContact, slip: Array, memo: Memo) -> PhaseResponse:
        """Return a force that gathers as dF = 1.5 c dD."""
        return PhaseResponse(np.full_like(slip, self.force), None, 1.5 * contact.radius, ())

    def margin(self, event: int, sample: PhaseSample) -> Array:
        """Return V -+ psi: the edge sticks while |psi| < V."""
        rate, velocity = sample.contact.rate, sample.velocity
        return np.asarray(rate + velocity if event else rate - velocity)

    def after_event(
        self, event: int, state: PhaseState, contact: ScaledContact, output: DenseOutput | None
    ) -> Phase:
        """Return slip at the edge."""
        sign = -1 if event else 1
        return slipping(sign, self._grown(state, output, sign))

    def after_panel(self, state: PhaseState, contact: ScaledContact, output: DenseOutput) -> Phase:
        """Return the same phase, with what the panel laid down."""
        return Stuck(self._grown(state, output, 0), state.x, state.force, 0)

    def _grown(self, state: PhaseState, output: DenseOutput | None, ended: int) -> Profile:
        if output is None or state.x <= self.start:
            return self.profile
        return (*self.profile, Laid.along(output, self.start, state.x, self.began, ended))


@attrs.frozen(eq=False)
class SlipPhase(FrontPhase):
    """Slip of one sign at the edge; of many impacts ``sign`` is an array."""

    sign: Any

    def _stopped(self, profile: Profile, state: PhaseState, contact: ScaledContact) -> Phase:
        """Return what follows when slip stops: in unloading the edge slips back at once."""
        if contact.rate > 0.0:
            return Stuck(profile, state.x, state.force, self.sign)
        return slipping(-self.sign, profile)


@attrs.frozen(eq=False)
class EdgeSlip(SlipPhase):
    """Springs outside the front slip; the front works through the outermost piece.

    Of many impacts the profile is their outermost pieces as one.
    """

    profile: Profile
    singular_events: tuple[bool, ...] = ()
    length_guess: float | None = None

    @classmethod
    def through(cls, sign: int, profile: Profile) -> EdgeSlip:
        """Return edge slip of this sign on a profile with at least one piece."""
        piece = profile[-1]
        singular = False, bool(piece.singular_inner_end(sign)), False
        return cls(sign, profile, singular, piece.length_guess(sign))

    def respond(self, contact: ScaledContact, slip: Array, memo: Memo) -> PhaseResponse:
        """Return the force of profile and slip zone; dF/dD = 1.5 c."""
        radius, force, memo = self.profile[-1].front(self.sign, contact, slip, memo)
        return PhaseResponse(force, 1.5 * radius, None, memo)

    def margin(self, event: int, sample: PhaseSample) -> Array:
        """Return s psi - V; the front's margin to its piece's inner end; zeta - q there."""
        contact, slip, velocity, response = sample
        if event == 0:
            return np.asarray(self.sign * velocity - contact.rate)
        if event == 1:
            return np.asarray(self.profile[-1].inner_margin(self.sign, contact, slip))
        return response.memo[0]

    def after_event(
        self, event: int, state: PhaseState, contact: ScaledContact, output: DenseOutput | None
    ) -> Phase:
        """Return what follows: stick (0), slip through the next piece (1), or the other way (2)."""
        sign = self.sign
        if event == 1:
            return slipping(sign, self.profile[:-1])
        if event == 2:
            return slipping(-sign, self.profile)
        front = contact.approach - max(self._front(contact, state.slip).memo[0].item(), 0.0)
        locked = Locked.between(front, sign, contact, state.slip, state.force)
        return self._stopped((*self.profile, locked), state, contact)

    def division(self, contact: ScaledContact, slip: float) -> tuple[float, int]:
        """Return radius of the front and sign of slip."""
        return self._front(contact, slip).radius.item(), self.sign

    def _front(self, contact: ScaledContact, slip: float) -> Front:
        """Return the front at one instant."""
        here = ScaledContact(*(np.array([value]) for value in contact))
        return self.profile[-1].front(self.sign, here, np.array([slip]), ())

    def friction_power(self, sample: PhaseSample) -> Array:
        """Return 1.5 (s psi - V) times the integral of zeta - s² over the slip zone.

        The zone comes from how deep it is: of the front itself only the force is known to rounding.
        """
        contact, depth = sample.contact, sample.response.memo[0]
        b = contact.radius
        c = np.sqrt(np.maximum(contact.approach - depth, 0.0))
        width = depth / (b + c)
        zone = 0.5 * width * width * (2.0 * b + c)
        return np.asarray((self.sign * sample.velocity - contact.rate) * zone)


@attrs.frozen(eq=False)
class GrossSlip(SlipPhase):
    """The whole contact slips; Coulomb's force, while s psi > V."""

    def division(self, contact: ScaledContact, slip: float) -> tuple[float, int]:
        """Return a front at the centre."""
        return 0.0, self.sign

    def after_event(
        self, event: int, state: PhaseState, contact: ScaledContact, output: DenseOutput | None
    ) -> Phase:
        """Return stick, of all the contact at once."""
        force = self.sign * contact.force
        locked = Locked.between(0.0, self.sign, contact, state.slip, force)
        return self._stopped((locked,), state, contact)

    def closed_form(
        self, state: PhaseState, motion: ClosedFormMotion, inertia: float
    ) -> ClosedPhase:
        """Return psi in proportion to V."""
        return GrossMotion(self.sign, state, motion, inertia)


@attrs.frozen(eq=False)
class Balanced(FrontPhase):
    """chi = 1/2: psi = psi1 V and F = psi1 P, and no spring ever slips.

    ``share`` is F/P: psi1, or at the limit of slip 2 chi.
    """

    share: float

    def closed_form(
        self, state: PhaseState, motion: ClosedFormMotion, inertia: float
    ) -> ClosedPhase:
        """Return gross slip's motion with psi1 for the sign, and no work."""
        closed = GrossMotion(self.share, state, motion, 1.0 / motion.scaled_mass)
        closed.end = closed.end._replace(work=state.work)
        return closed


def slipping(sign: int, profile: Profile) -> Phase:
    """Return the slip phase of this sign; pieces locked out of slip of the same sign go at once."""
    while profile and profile[-1].sign == sign:
        profile = profile[:-1]
    return EdgeSlip.through(sign, profile) if profile else GrossSlip(sign)
