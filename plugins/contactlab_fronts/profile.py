"""Pieces of a locked profile, and the front of slip in each.

The contact is a bundle of springs s in [0, 1] (theory §4), known here by q = s². A spring is in
contact while q < zeta, its displacement w is limited to zeta - q, and while it sticks w = f(q) + D.
A piece is a range of q over which f was laid down in one way. Its force seen from radius c is
I(c) = 1.5 · integral over s in [0, c] of (f(s) - f(c)), kept from piece to piece. With the front
at c and slip of sign s outside it,

    F = I(c) + 1.5 c (f(c) + D) + 1.5 s · (integral of zeta - s² over the slip zone),

which is stationary in c: a front known to 1e-8 gives the force to rounding.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import ScaledContact

Array = NDArray[np.float64]


class Front(NamedTuple):
    """The front of slip at many contacts: its radius c, the whole force, and a memo."""

    radius: Array
    force: Array
    memo: tuple[Array, ...]


class Piece(ABC):
    """A piece of the locked profile; ``inner_q`` and ``inner_f`` belong to its inner end."""

    inner_q: float
    inner_f: float

    @abstractmethod
    def front(
        self, sign: int, contact: ScaledContact, slip: Array, memo: tuple[Array, ...]
    ) -> Front:
        """Return the front of slip with this sign, where s (f(q) + D) = zeta - q."""

    @abstractmethod
    def depth(
        self, sign: int, contact: ScaledContact, slip: Array, memo: tuple[Array, ...]
    ) -> Array:
        """Return zeta - q at the front: zero as the slip zone vanishes."""

    @abstractmethod
    def swept(self, sign: int) -> bool:
        """Say whether slip of this sign takes the whole piece at once."""

    @abstractmethod
    def flat(self, sign: int) -> bool:
        """Say whether a front of this sign rushes to the inner end like a square root."""

    @abstractmethod
    def span(self, sign: int) -> float | None:
        """Guess how long (in x) a front of this sign needs to cross the piece."""
