"""The normal contact at one instant, which normal laws answer and tangential laws read."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.numeric.checks import Real

#: Overlap in m of a contact that presses at first touch: only its sign means something.
TOUCH = 1e-300


class NormalContact(NamedTuple):
    """The normal contact at one instant; every entry broadcasts to the batch shape.

    Attributes
    ----------
    force : float or array
        P in N, positive in compression, negative where the surfaces pull; 0 out of contact.
    radius : float or array
        b in m, the contact radius; 0 out of contact, and 0 from a law that has none.
    overlap : float or array
        Positive in contact, zero or negative out of contact: its sign tells where the impact
        ends. Any measure in m.
    friction_load : float or array, optional
        The normal force in N that Coulomb's limit is taken of, never negative. A normal law
        may leave it out: it is max(P, 0) then. A tangential law always finds it.
    """

    force: Real
    radius: Real
    overlap: Real
    friction_load: Any = None

    @property
    def complete(self) -> NormalContact:
        """The same contact with its friction load."""
        if self.friction_load is not None:
            return self
        force: Any = self.force
        # A product with the comparison keeps NaN a NaN, for floats and arrays alike.
        return self._replace(friction_load=force * (force > 0.0) + 0.0 if np.ndim(force) else (
            0.0 if force <= 0.0 else force
        ))  # fmt: skip


def without_tension(force: Real, radius: Real, approach: Real) -> NormalContact:
    """Return the contact of a law that does not pull: it has ended where ``force`` is not positive.

    Force and radius are 0 there, and the overlap is negative. NaN stays NaN.

    Parameters
    ----------
    force : float or array, shape (...,)
        In N, positive in compression.
    radius : float or array, shape (...,)
        Of the contact, in m.
    approach : float or array, shape (...,)
        In m, positive in compression.
    """
    pushing = np.logical_not(force <= 0.0)
    return NormalContact(
        force=force * pushing,
        radius=radius * pushing,
        overlap=(np.abs(approach) + TOUCH) * (2.0 * pushing - 1.0),
    )
