"""Exact impacts to build and to judge the table from."""

from __future__ import annotations

import numpy as np

from contactlab.numeric.types import Array
from contactlab_laws.fronts.compiled import LOST, MOST_STEPS
from contactlab_laws.fronts.coupled import solve_impacts
from contactlab_laws.fronts.phases import LOCKED
from contactlab_laws.fronts.steps import Steps, follow_one

#: Error of a step. Answers then come to 3e-15 (to 4e-14 at 1e-8 from psi1 = 1, chi = 1/2): what is
#: left of 5e-13, some 3e-14, is seen in second derivatives of a patch.
STEP = 1e-14


def exact(psi1: Array, chi: Array) -> Array:
    """Return psi2 for psi1 >= 0, shape (impacts,): 25 us each compiled, some ms by Python."""
    numbers = np.zeros((4, psi1.size))
    numbers[0], numbers[1] = psi1, chi
    found, status = solve_impacts(numbers, STEP)
    for row in status.nonzero()[0].tolist():
        _refuse_lost(float(psi1[row]), float(chi[row]), int(status[row]))
    return np.asarray(psi1 + found[1])


def last_slip(psi1: float, chi: float) -> int:
    """Return the sign of the slip with which one impact ends."""
    return int(_steps(psi1, chi).sign[-1])


def reaches_disk(psi1: float, chi: float) -> bool:
    """Return whether slip runs over what slipped the other way, and locked, before."""
    return bool((_steps(psi1, chi).phase == LOCKED).any())


def _steps(psi1: float, chi: float) -> Steps:
    """Return the steps of one impact."""
    _, status, steps = follow_one((psi1, chi, 0.0, 0.0), STEP, MOST_STEPS)
    if status:
        _refuse_lost(psi1, chi, status)
    return steps


def _refuse_lost(psi1: float, chi: float, status: int) -> None:
    """Refuse an impact without an answer."""
    raise ArithmeticError(f"psi1 = {psi1!r}, chi = {chi!r}: {LOST[status]}")
