"""The normal contact at one instant: normal laws return it, tangential laws read it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.numeric.types import Real

#: Overlap in m of a contact that presses at first touch; only the sign of an overlap matters.
TOUCH = 1e-300


class NormalContact(NamedTuple):
    """The normal contact at one instant; every entry broadcasts to the batch shape.

    Attributes
    ----------
    force : float or array
        P in N, positive in compression, negative where the surfaces pull; 0 out of contact.
    radius : float or array
        b in m, the contact radius; 0 out of contact, and 0 from a law without contact radius.
    overlap : float or array
        A length in m, not a plain number: positive in contact, zero or negative out of contact.
        The impact ends where its sign changes.
    friction_load : float or array, optional
        The normal force in N that Coulomb's limit is taken of, never negative. A normal law
        may omit the friction load, which is then max(P, 0). Tangential laws always receive it.
    """

    force: Real
    radius: Real
    overlap: Real
    friction_load: Any = None

    @property
    def complete(self) -> NormalContact:
        """The same contact; a missing friction load becomes max(P, 0)."""
        force: Real = self.force
        load = self.friction_load
        if load is not None:
            return self
        if isinstance(force, np.ndarray):
            load = force * (force > 0.0) + 0.0  # keeps NaN
        else:
            load = 0.0 if force <= 0.0 else force
        return NormalContact(force, self.radius, self.overlap, load)


def without_tension(force: Real, radius: Real, approach: Real) -> NormalContact:
    """Return the contact of a law without tension, which ends where ``force`` is not positive.

    Where the contact has ended, force and radius are 0 and the overlap is negative. NaN stays NaN.

    Parameters
    ----------
    force : float or array, shape (...,)
        Normal force in N, positive in compression.
    radius : float or array, shape (...,)
        Contact radius in m.
    approach : float or array, shape (...,)
        Approach in m, positive in compression.
    """
    pushing: Real
    size: Real
    if isinstance(force, float) and isinstance(approach, float):  # many times faster
        pushing, size = not force <= 0.0, abs(approach)
    else:
        pushing, size = np.logical_not(force <= 0.0), np.abs(approach)
    return NormalContact(
        force=force * pushing,
        radius=radius * pushing,
        overlap=(size + TOUCH) * (2.0 * pushing - 1.0),
    )
