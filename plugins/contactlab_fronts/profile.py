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

import numpy as np
from numpy.typing import NDArray

from contactlab.checks import Real
from contactlab.contracts import ScaledContact

Array = NDArray[np.float64]
Memo = tuple[Array, ...]


class Front(NamedTuple):
    """The front of slip at many contacts: its radius c, the whole force, and a memo.

    The memo begins with the depth of the slip zone, zeta - q at the front: of the front itself
    only the force is known to rounding.
    """

    radius: Array
    force: Array
    memo: Memo


class Piece(ABC):
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
        """Return the front of slip with this sign, where s (f(q) + D) = zeta - q."""

    @abstractmethod
    def flat(self, sign: Any) -> Any:
        """Say whether a front of this sign rushes to the inner end like a square root."""

    def left(self, sign: Any, contact: ScaledContact, slip: Any) -> Any:
        """Return how far the front is from the inner end; it leaves the piece at zero."""
        return contact.approach - sign * slip - (self.inner_q + sign * self.inner_f)

    def span(self, sign: int) -> float | None:
        """Guess how long (in x) a front of this sign needs to cross the piece."""
        return None
