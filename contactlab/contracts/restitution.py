"""The coefficient of restitution as an option of laws."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.contracts.law import Law
from contactlab.numeric.checks import Rule, quantity
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Real

#: Default restitution of laws, where the user gives none.
TAKEN_RESTITUTION = Taken(0.9)
#: Least coefficient of restitution of a law of dissipation.
LEAST_RESTITUTION = 0.01
#: The rule of a coefficient that no law narrows.
RESTITUTIONS = Rule(
    lambda value: (value >= 0.0) & (value <= 1.0),
    "must be from 0 to 1: rebound over approach velocity",
)


def restitution_of(law: Law) -> Real | None:
    """Return the option ``restitution`` of a law, one number or one an impact; None without it."""
    e: Real | None = getattr(law, "restitution", None)
    return e


def _from(least: float, per_impact: bool) -> Rule:
    """Return the rule of coefficients from ``least`` to 1."""
    if per_impact:
        sentence = f"must be from {least:g} to 1: rebound over approach velocity"
        return Rule(lambda value: (value >= least) & (value <= 1.0), sentence)
    below = "; nearer to 0 no step can follow this law" if least > 0.0 else ""
    return Rule(
        lambda value: np.ndim(value) == 0 and least <= value <= 1.0,
        f"must be one number from {least:g} to 1: rebound over approach velocity{below}",
    )


def restitution(
    *, default: float | None, least: float = LEAST_RESTITUTION, per_impact: bool = False
) -> Any:
    """Return an attrs field for a coefficient of normal restitution, from ``least`` to 1.

    Parameters
    ----------
    default : float or None
        Value if none is given; None makes the option optional.
    least : float
        The least that the law answers.
    per_impact : bool
        Whether each impact may have its own.
    """
    return quantity("1", rule=_from(least, per_impact), default=default, per_impact=per_impact)
