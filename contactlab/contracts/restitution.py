"""The coefficient of restitution as an option of laws, and helpers of laws that are calibrated."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from contactlab.numeric.checks import Rule, quantity, refuse

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


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the sign change of ``function``, negative at ``low``, by bisection to the last bit."""
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if function(middle) < 0.0 else (low, middle)
    return high


def one_of_two(law: object, first: str, second: str, *, default: float) -> None:
    """Refuse a law that sets both of two equivalent options; if it sets neither, set ``first``."""
    values = getattr(law, first), getattr(law, second)
    given = [value is not None for value in values]  # no comparison: a value may be an array
    if all(given):
        rule = "only one of the two may be given"
        raise refuse(
            f"{first}, {second}", values, rule, "each follows from the other: leave one out"
        )
    if not any(given):
        object.__setattr__(law, first, default)  # the object is frozen
