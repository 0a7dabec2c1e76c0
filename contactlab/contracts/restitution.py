"""The coefficient of restitution as an option of laws."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.numeric.checks import Rule, quantity

#: Least coefficient of restitution of a law of dissipation.
LEAST_RESTITUTION = 0.01
RESTITUTION = Rule(
    lambda value: np.ndim(value) == 0 and LEAST_RESTITUTION <= value <= 1.0,
    f"must be one number from {LEAST_RESTITUTION} to 1: rebound over approach velocity",
)
#: The rule of a coefficient for each impact, without a law.
RESTITUTIONS = Rule(
    lambda value: (value >= 0.0) & (value <= 1.0),
    "must be from 0 to 1: rebound over approach velocity",
)


def restitution(*, default: float | None) -> Any:
    """Return an attrs field for a coefficient of normal restitution, from 0.01 to 1.

    Parameters
    ----------
    default : float or None
        Value if none is given; None makes the option optional.
    """
    return quantity("1", rule=RESTITUTION, default=default)
