"""Impacts beyond the table: the exact solution of many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Of max(1, |psi1|), asked of the solver of many impacts; within 1e-6 of psi1 = 1 it errs by
#: up to 6e-8.
TOLERANCE = 1e-9


def beyond(psi1: Array, chi: Array, where: Flags) -> Array:
    """Return psi2 of the impacts chosen by ``where``, and psi1 elsewhere; shape (impacts,)."""
    import contactlab  # no law before it is needed
    from contactlab_tabulated.exact import exact

    psi2 = psi1.copy()
    law = contactlab.create("tangential.fronts")
    found, solved = law.rebound(psi1[where], chi[where], TOLERANCE)
    if not solved.all():
        left = ~solved
        found[left] = exact(psi1[where][left], chi[where][left])
    psi2[where] = found
    return psi2
