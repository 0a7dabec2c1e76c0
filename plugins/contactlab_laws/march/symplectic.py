"""A symplectic scheme of second order: velocities at the steps, forces between them."""

from __future__ import annotations

from typing import ClassVar

import attrs

from contactlab.contracts import NormalMotion, Steps
from contactlab_laws.march.division import midpoints
from contactlab_laws.march.fixed import FixedSteps


@attrs.frozen(kw_only=True)
class Symplectic(FixedSteps):
    """Leapfrog: the contact is sampled in the middle of each step.

    Steps are even in time: with steps even in the phase the error is about 1.6 times as
    large. A law gets the exact mean friction load of each step.

    Parameters
    ----------
    steps : int
        Steps from first touch to separation.
    refine : bool
        Where ``steps`` are too few for the stiffness of the law: take more (the default),
        or refuse with the status ``TOO_FEW_STEPS`` and the number needed.
    """

    api_version: ClassVar[int] = 2

    def divide(self, normal: NormalMotion, count: int) -> Steps:
        """Return steps sampled in their middles."""
        return midpoints(normal, count)
