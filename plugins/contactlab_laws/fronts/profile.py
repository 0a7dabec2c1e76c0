"""Pieces of a locked profile, and the front of slip in each.

The contact is a bundle of springs s in [0, 1] (theory §4), known here by q = s². A spring is in
contact while q < zeta, its displacement w is limited to zeta - q, and while it sticks w = f(q) + D.
A piece is a range of q over which f was laid down in one way. Its force seen from radius c is
I(c) = 1.5 · integral over s in [0, c] of (f(s) - f(c)), kept from piece to piece. With the front
at c and slip of sign s outside it,

    F = I(c) + 1.5 c (f(c) + D) + 1.5 s · (integral of zeta - s² over the slip zone),

which is stationary in c: a front known to 1e-8 gives the force to rounding.

One impact is written in floats, and arrays of shape (nodes,) along its panel; many impacts in
arrays of shape (impacts,), and of shape (nodes, impacts) along their panels.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import ScaledContact
from contactlab.numeric.checks import Real
from contactlab.numeric.lobatto import Array

Memo = tuple[Array, ...]


class Front(NamedTuple):
    """The front of slip at many contacts: its radius c, the whole force, and a memo.

    The memo begins with the depth of the slip zone, zeta - q at the front: of the front itself
    only the force is known to rounding.
    """

    radius: Array
    force: Array
    memo: Memo


class ProfilePiece(ABC):
    """A piece of the locked profile, or one of each of many impacts.

    Attributes
    ----------
    sign : float or array
        Of the slip out of which it locked; 0 if it was laid down while all stuck. Slip of the
        same sign takes the whole piece at once.
    inner_q, inner_f : float or array
        Of its inner end.
    """

    sign: Real
    inner_q: Real
    inner_f: Real

    @abstractmethod
    def front(self, sign: Any, contact: ScaledContact, slip: Array, memo: Memo) -> Front:
        """Return the front of slip, where s (f(q) + D) = zeta - q.

        Parameters
        ----------
        sign : int or ndarray
            s, the sign of the slip outside the front.
        contact : ScaledContact
        slip : ndarray
            D.
        memo : tuple of ndarray
            Of the last front found, or empty.
        """

    @abstractmethod
    def singular_inner_end(self, sign: Any) -> Any:
        """Return whether a front of this sign reaches the inner end like a square root of x."""

    def inner_margin(self, sign: Any, contact: ScaledContact, slip: Any) -> Any:
        """Return zeta - s D less its value at the inner end: the front leaves the piece at zero."""
        return contact.approach - sign * slip - (self.inner_q + sign * self.inner_f)

    def length_guess(self, sign: int) -> float | None:
        """Return a guess of how long (in x) a front of this sign needs to cross the piece."""
        return None


@attrs.frozen(eq=False)
class Locked(ProfilePiece):
    """Locked out of slip of one sign: f = inner_f - sign (q - inner_q), I(c) = base + sign c³."""

    sign: Real
    inner_q: Real
    inner_f: Real
    base: Real

    @classmethod
    def between(
        cls, front: Any, sign: Any, contact: ScaledContact, slip: Any, force: Any
    ) -> Locked:
        """Return what locks between a front and the edge of contact.

        Parameters
        ----------
        front, sign : float or ndarray
            q at the front, and the sign of the slip outside it.
        contact : ScaledContact
        slip, force : float or ndarray
            D and F/(mu P_max).
        """
        inner_f = sign * (contact.approach - front) - slip
        return cls(sign, front, inner_f, force - sign * contact.force)

    def front(self, sign: Any, contact: ScaledContact, slip: Array, memo: Memo) -> Front:
        """Return the front in closed form: slip has the other sign, and s w - l falls as 2 q."""
        q = contact.approach - sign * slip
        q += self.inner_q - sign * self.inner_f
        q *= 0.5
        np.maximum(q, 0.0, out=q)
        c = np.sqrt(q)
        force = contact.force - 2.0 * (q * c)  # F = I(c) + s (P - c³), and I(c) = base - s c³
        force *= sign
        force += self.base
        return Front(c, force, (contact.approach - q,))

    def singular_inner_end(self, sign: Any) -> Any:
        """Return whether the inner end is the centre."""
        return self.inner_q == 0.0
