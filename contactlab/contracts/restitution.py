"""Parameters of laws from what is known of an impact: a restitution, and the root that gives it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from contactlab.numeric.checks import Rule, quantity, refuse

#: Below this coefficient of restitution hardly a law of dissipation means anything.
LEAST_RESTITUTION = 0.01
RESTITUTION = Rule(
    lambda value: np.ndim(value) == 0 and LEAST_RESTITUTION <= value <= 1.0,
    f"must be one number from {LEAST_RESTITUTION} to 1: rebound over approach velocity",
)


def restitution(*, default: Any) -> Any:
    """Return an attrs field for a coefficient of normal restitution; optional if None.

    Parameters
    ----------
    default : float or None
        From 0.01 to 1.
    """
    return quantity("1", rule=RESTITUTION, default=default)


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Return where ``function``, below 0 at ``low`` and not at ``high``, changes its sign.

    To the last bit, by halving.
    """
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if function(middle) < 0.0 else (low, middle)
    return high


def one_of_two(law: Any, one: str, other: str, *, default: float) -> None:
    """Refuse a law that is given two options which decide the same; of neither, fill in ``one``.

    To be called when a law is made, of options whose default is None.

    Parameters
    ----------
    law : object
        The attrs instance that is being made.
    one, other : str
        Names of the two options.
    default : float
        Of ``one``, in its unit.

    Raises
    ------
    ValueError
        If neither is None.
    """
    values = getattr(law, one), getattr(law, other)
    given = [value is not None for value in values]  # a value may be an array, to be refused
    if all(given):
        rule = "only one of the two may be given"
        raise refuse(f"{one}, {other}", values, rule, "each follows from the other: leave one out")
    if not any(given):
        object.__setattr__(law, one, default)  # the object is frozen, and not made yet
