"""The first zero of a smooth function: an interval is skipped only if it can hold none."""

from __future__ import annotations

from collections.abc import Callable

#: Narrowest interval that is halved, times the root of the second derivative's bound: the function
#: is a straight line there, to 1e-15, and two zeros count as one or none.
NARROWEST = 1e-7
#: A function value above minus this is no zero: rounding.
ROUNDING = 1e-14


def first_zero(
    function: Callable[[float], float], bend: float, start: float, stop: float
) -> float | None:
    """Return the first point of (start, stop] where ``function`` falls below 0, or None."""
    # ``bend`` bounds the absolute second derivative. An interval is passed over only where its ends
    # and this bound leave no room for a zero; else it is halved, its left half first.
    narrowest = NARROWEST / max(bend, 1.0) ** 0.5
    pending = [(start, function(start), stop, function(stop))]
    while pending:
        left, before, right, after = pending.pop()
        width = right - left
        if min(before, after) > 0.125 * bend * width * width:
            continue
        if width <= narrowest:
            if after < -ROUNDING:
                return left + width * max(before, 0.0) / (max(before, 0.0) - after)
            continue
        middle = 0.5 * (left + right)
        value = function(middle)
        pending += [(middle, value, right, after), (left, before, middle, value)]
    return None
