"""Exact impacts to build and to judge the table from."""

from __future__ import annotations

import numpy as np

from contactlab.numeric.types import Array
from contactlab_laws.fronts import compiled
from contactlab_laws.fronts.phases import LOCKED
from contactlab_laws.fronts.steps import Steps, kept

#: Error of a step. Answers then come to 3e-15 (to 4e-14 at 1e-8 from psi1 = 1, chi = 1/2): what is
#: left of 5e-13, some 3e-14, is seen in second derivatives of a patch.
STEP = 1e-14


def exact(psi1: Array, chi: Array) -> Array:
    """Return psi2 for psi1 >= 0, shape (impacts,): 25 us each compiled, some ms by Python."""
    numbers = np.zeros((4, psi1.size))
    numbers[0], numbers[1] = psi1, chi
    found, status = compiled.follow(numbers, STEP)
    change = found[1]
    for row in status.nonzero()[0].tolist():
        change[row] = _steps(float(psi1[row]), float(chi[row]))[0]
    return np.asarray(psi1 + change)


def last_slip(psi1: float, chi: float) -> int:
    """Return the sign of the slip with which one impact ends."""
    return int(_steps(psi1, chi)[1].sign[-1])


def reaches_disk(psi1: float, chi: float) -> bool:
    """Return whether slip runs over what slipped the other way, and locked, before."""
    return bool((_steps(psi1, chi)[1].phase == LOCKED).any())


def _steps(psi1: float, chi: float) -> tuple[float, Steps]:
    """Return psi2 - psi1 and the steps of one impact."""
    ends, status, steps = kept((psi1, chi, 0.0, 0.0), STEP, compiled.MOST_STEPS)
    if status:
        raise ArithmeticError(f"psi1 = {psi1!r}, chi = {chi!r}: {compiled.LOST[status]}")
    return float(ends[1]), steps
