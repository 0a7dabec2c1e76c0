"""The phases of the spring bundle: stuck, edge slip, gross slip (theory §5)."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    ClosedFormMotion,
    ClosedPhase,
    Path,
    Phase,
    PhaseResponse,
    PhaseState,
    ScaledContact,
)
from contactlab_fronts.gross import GrossMotion
from contactlab_fronts.laid import Laid
from contactlab_fronts.locked import Locked
from contactlab_fronts.profile import Front, Memo, Piece

Array = NDArray[np.float64]
Profile = tuple[Piece, ...]


class FrontPhase(Phase):
    """A phase of the spring bundle: stuck within a radius, slipping one way outside."""

    def division(self, contact: ScaledContact, slip: float) -> tuple[float, int]:
        """Return radius of the front and sense of slip outside it: here all sticks."""
        return contact.radius, 0


@attrs.frozen(eq=False)
class Stuck(FrontPhase):
    """All springs stick while the contact grows; new ones are laid down unstressed."""

    profile: Profile
    start: float
    force: float
    began: int

    rough = (False, False)
    linear = True
    dissipates = False

    def respond(self, contact: ScaledContact, slip: Array, memo: Memo) -> PhaseResponse:
        """Gather dF = 1.5 c dD."""
        return PhaseResponse(np.full_like(slip, self.force), None, 1.5 * contact.radius, ())

    def margin(
        self,
        event: int,
        contact: ScaledContact,
        slip: Array,
        velocity: Array,
        response: PhaseResponse,
    ) -> Array:
        """Return V -+ psi: the edge sticks while |psi| < V."""
        return np.asarray(contact.rate + velocity if event else contact.rate - velocity)

    def follow(
        self, event: int, state: PhaseState, contact: ScaledContact, path: Path | None
    ) -> Phase:
        """Begin to slip at the edge."""
        sign = -1 if event else 1
        return slipping(sign, self._grown(state, path, sign))

    def carry_on(self, state: PhaseState, contact: ScaledContact, path: Path) -> Phase:
        """Keep what the panel laid down."""
        return Stuck(self._grown(state, path, 0), state.x, state.force, 0)

    def _grown(self, state: PhaseState, path: Path | None, ended: int) -> Profile:
        if path is None or state.x <= self.start:
            return self.profile
        return (*self.profile, Laid.along(path, self.start, state.x, self.began, ended))


@attrs.frozen(eq=False)
class EdgeSlip(FrontPhase):
    """Springs outside the front slip; the front works through the outermost piece.

    Of many impacts ``sign`` is an array, and the profile their outermost pieces as one.
    """

    sign: Any
    profile: Profile
    rough: tuple[bool, ...]
    span: float | None

    @classmethod
    def through(cls, sign: int, profile: Profile) -> EdgeSlip:
        """Return edge slip of this sign on a profile with at least one piece."""
        piece = profile[-1]
        return cls(sign, profile, (False, bool(piece.flat(sign)), False), piece.span(sign))

    def respond(self, contact: ScaledContact, slip: Array, memo: Memo) -> PhaseResponse:
        """Return the force of profile and slip zone; dF/dD = 1.5 c."""
        radius, force, memo = self.profile[-1].front(self.sign, contact, slip, memo)
        return PhaseResponse(force, 1.5 * radius, None, memo)

    def margin(
        self,
        event: int,
        contact: ScaledContact,
        slip: Array,
        velocity: Array,
        response: PhaseResponse,
    ) -> Array:
        """Return s psi - V; what the front has left to its piece's inner end; zeta - q there."""
        sign, piece = self.sign, self.profile[-1]
        if event == 0:
            return np.asarray(sign * velocity - contact.rate)
        return piece.left(sign, contact, slip) if event == 1 else response.memo[0]

    def follow(
        self, event: int, state: PhaseState, contact: ScaledContact, path: Path | None
    ) -> Phase:
        """Re-stick (0), go on to the next piece (1), or slip the other way (2)."""
        sign = self.sign
        if event == 1:
            return slipping(sign, self.profile[:-1])
        if event == 2:
            return slipping(-sign, self.profile)
        front = contact.approach - max(self._front(contact, state.slip).memo[0].item(), 0.0)
        locked = Locked.between(front, sign, contact, state.slip, state.force)
        return sticking(sign, (*self.profile, locked), state, contact)

    def division(self, contact: ScaledContact, slip: float) -> tuple[float, int]:
        """Return radius of the front and sense of slip."""
        return self._front(contact, slip).radius.item(), self.sign

    def _front(self, contact: ScaledContact, slip: float) -> Front:
        """Return the front at one instant."""
        here = ScaledContact(*(np.array([value]) for value in contact))
        return self.profile[-1].front(self.sign, here, np.array([slip]), ())

    def friction_power(
        self, contact: ScaledContact, slip: Array, velocity: Array, response: PhaseResponse
    ) -> Array:
        """1.5 (s psi - V) times the integral of zeta - s² over the slip zone.

        The zone comes from how deep it is: of the front itself only the force is known to rounding.
        """
        depth = response.memo[0]
        b = contact.radius
        c = np.sqrt(np.maximum(contact.approach - depth, 0.0))
        width = depth / (b + c)
        zone = 0.5 * width * width * (2.0 * b + c)
        return np.asarray((self.sign * velocity - contact.rate) * zone)


@attrs.frozen(eq=False)
class GrossSlip(FrontPhase):
    """The whole contact slips; Coulomb's force, while s psi > V."""

    sign: int

    rough = (False,)

    def respond(self, contact: ScaledContact, slip: Array, memo: Memo) -> PhaseResponse:
        """F = s P."""
        return PhaseResponse(self.sign * contact.force, None, None, ())

    def division(self, contact: ScaledContact, slip: float) -> tuple[float, int]:
        """Return a front at the centre."""
        return 0.0, self.sign

    def follow(
        self, event: int, state: PhaseState, contact: ScaledContact, path: Path | None
    ) -> Phase:
        """Re-stick, all at once."""
        force = self.sign * contact.force
        locked = Locked.between(0.0, self.sign, contact, state.slip, force)
        return sticking(self.sign, (locked,), state, contact)

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

    def respond(self, contact: ScaledContact, slip: Array, memo: Memo) -> PhaseResponse:
        """F = share P."""
        return PhaseResponse(self.share * contact.force, None, None, ())

    def closed_form(
        self,
        state: PhaseState,
        motion: ClosedFormMotion,
        inertia: float,
    ) -> ClosedPhase:
        """Gross slip's formula with psi1 for the sign, and no work."""
        path = GrossMotion(self.share, state, motion, 1.0 / motion.scaled_mass)
        path.end = path.end._replace(work=state.work)
        return path


def slipping(sign: int, profile: Profile) -> Phase:
    """Return the slip phase of this sign: pieces of the same sign are swept at once."""
    while profile and profile[-1].sign == sign:
        profile = profile[:-1]
    return EdgeSlip.through(sign, profile) if profile else GrossSlip(sign)


def sticking(sign: int, profile: Profile, state: PhaseState, contact: ScaledContact) -> Phase:
    """Return what follows when slip of this sign stops: in unloading the edge slips back."""
    if contact.rate > 0.0:
        return Stuck(profile, state.x, state.force, sign)
    return slipping(-sign, profile)
