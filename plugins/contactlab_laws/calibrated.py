"""Shared parts of laws that a restitution, or a measurement, calibrates."""

from __future__ import annotations

from collections.abc import Callable

from contactlab.numeric.checks import refuse
from contactlab.numeric.taken import Taken

#: Words of a law that loses energy, and of a law whose loss follows from a restitution.
OF_LOSS = frozenset({"viscous", "similar"})
#: Words to take away, by whether there is a loss, and one number e.
WAIVED = {
    (True, True): frozenset[str](),
    (True, False): frozenset({"similar"}),
    (False, True): frozenset({"viscous"}),
    (False, False): OF_LOSS,
}


def waives_of_loss(restitution: object, loses: bool) -> frozenset[str]:
    """Return the words of ``OF_LOSS`` that do not hold for these parameters."""
    return WAIVED[loses, isinstance(restitution, float)]


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the sign change of ``function``, negative at ``low``, by bisection to the last bit."""
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if function(middle) < 0.0 else (low, middle)
    return high


def one_of_two(law: object, first: str, second: str, *, default: Taken) -> None:
    """Refuse a law that sets both of two equivalent options; if it sets neither, set ``first``.

    A default of ``first`` yields to a ``second`` from the user.
    """
    values = getattr(law, first), getattr(law, second)
    given = [value is not None for value in values]  # no comparison: a value may be an array
    if all(given) and isinstance(values[0], Taken):
        object.__setattr__(law, first, None)
        return
    if all(given):
        rule = "only one of the two may be given"
        raise refuse(
            f"{first}, {second}", values, rule, "each follows from the other: leave one out"
        )
    if not any(given):
        object.__setattr__(law, first, default)  # the object is frozen
