"""The first zero of a smooth function, none missed."""

from __future__ import annotations

from collections.abc import Callable

#: Zeros closer to each other than this over the root of the second derivative's bound are one, or
#: none: the function is a straight line there, to 1e-15.
NARROWEST = 1e-7
#: What is not below this is rounding.
ROUNDING = 1e-14


def first_zero(
    function: Callable[[float], float], bend: float, start: float, stop: float
) -> float | None:
    """Return the first point of (start, stop] at which a function falls below zero, or None.

    An interval is passed over only where its ends and the bound of the second derivative leave
    no room for a zero; else it is halved, its left half first.

    Parameters
    ----------
    function : callable
        Not negative at ``start``.
    bend : float
        Bound of the absolute second derivative.
    start, stop : float
    """
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
