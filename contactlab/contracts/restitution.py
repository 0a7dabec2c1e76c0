"""The coefficient of restitution as an option of laws."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.numeric.checks import Rule, quantity
from contactlab.numeric.taken import Taken

#: What laws of a restitution take where nobody gave one.
TAKEN_RESTITUTION = Taken(0.9)
#: Least coefficient of restitution of a law of dissipation.
LEAST_RESTITUTION = 0.01
#: The rule of a coefficient for each impact, without a law.
RESTITUTIONS = Rule(
    lambda value: (value >= 0.0) & (value <= 1.0),
    "must be from 0 to 1: rebound over approach velocity",
)


def _from(least: float) -> Rule:
    """Return the rule of one coefficient from ``least`` to 1."""
    below = "; nearer to 0 no step can follow this law" if least > 0.0 else ""
    return Rule(
        lambda value: np.ndim(value) == 0 and least <= value <= 1.0,
        f"must be one number from {least:g} to 1: rebound over approach velocity{below}",
    )


def restitution(*, default: float | None, least: float = LEAST_RESTITUTION) -> Any:
    """Return an attrs field for a coefficient of normal restitution, from ``least`` to 1.

    Parameters
    ----------
    default : float or None
        Value if none is given; None makes the option optional.
    least : float
        The least that the law answers.
    """
    return quantity("1", rule=_from(least), default=default)
