"""A piece of profile that locked when slip stopped."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.checks import Real
from contactlab.contracts import ScaledContact
from contactlab_fronts.profile import Front, Memo, Piece

Array = NDArray[np.float64]


@attrs.frozen(eq=False)
class Locked(Piece):
    """Locked out of slip of one sign: f = inner_f - sign (q - inner_q), I(c) = base + sign c³."""

    sign: Real
    inner_q: Real
    inner_f: Real
    base: Real

    @classmethod
    def between(
        cls, front: Any, sign: Any, contact: ScaledContact, slip: Any, force: Any
    ) -> Locked:
        """Return what locks between ``front``, a place q, and the edge of contact."""
        inner_f = sign * (contact.approach - front) - slip
        return cls(sign, front, inner_f, force - sign * contact.force)

    def front(self, sign: Any, contact: ScaledContact, slip: Array, memo: Memo) -> Front:
        """Solve in closed form: only the other sign comes here, and s w - l then falls as 2 q."""
        q = contact.approach - sign * slip
        q += self.inner_q - sign * self.inner_f
        q *= 0.5
        np.maximum(q, 0.0, out=q)
        c = np.sqrt(q)
        force = contact.force - 2.0 * (q * c)  # F = I(c) + s (P - c³), and I(c) = base - s c³
        force *= sign
        force += self.base
        return Front(c, force, (contact.approach - q,))

    def flat(self, sign: Any) -> Any:
        """Only the centre is reached like a square root."""
        return self.inner_q == 0.0
