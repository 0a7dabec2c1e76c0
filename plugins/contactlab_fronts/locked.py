"""A piece of profile that locked when slip stopped."""

from __future__ import annotations

import math

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import ScaledContact
from contactlab_fronts.profile import Front, Piece

Array = NDArray[np.float64]


@attrs.frozen(eq=False)
class Locked(Piece):
    """Locked out of slip of one sign: f = inner_f - sign (q - inner_q).

    ``inner_force`` is I at the inner end.
    """

    sign: int
    inner_q: float
    inner_f: float
    inner_force: float

    @property
    def base(self) -> float:
        """I(c) = base + sign c³."""
        return self.inner_force - self.sign * self.inner_q * math.sqrt(self.inner_q)

    def front(
        self, sign: int, contact: ScaledContact, slip: Array, memo: tuple[Array, ...]
    ) -> Front:
        """Solve in closed form: only the other sign comes here, and s w - l then falls as 2 q."""
        q = contact.approach - sign * slip
        q += self.inner_q - sign * self.inner_f
        q *= 0.5
        np.maximum(q, 0.0, out=q)
        c = np.sqrt(q)
        force = contact.force - 2.0 * (q * c)  # F = I(c) + s (P - c³), and I(c) = base - s c³
        if sign < 0:
            force = self.base - force
        else:
            force += self.base
        return Front(c, force, (q,))

    def depth(
        self, sign: int, contact: ScaledContact, slip: Array, memo: tuple[Array, ...]
    ) -> Array:
        """Return zeta - q."""
        return np.asarray(contact.approach - memo[0])

    def swept(self, sign: int) -> bool:
        """Slip of the same sign finds s w - l constant here."""
        return sign == self.sign

    def flat(self, sign: int) -> bool:
        """Only the centre is reached like a square root."""
        return self.inner_q == 0.0

    def span(self, sign: int) -> float | None:
        """Nothing is known."""
        return None
