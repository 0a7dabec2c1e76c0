"""Numbers that follow from a speed before the impact: a restitution, a friction coefficient.

The user gives a function of the speed, or a table that is linear between speeds.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias, overload

import attrs
import numpy as np

from contactlab.numeric.arrays import spread
from contactlab.numeric.checks import NON_NEGATIVE, check_place, quantity, real, refuse
from contactlab.numeric.types import AnyArray, Array, Numbers, Real

#: A friction coefficient as a function of the slip speed in m/s, or as a table by it.
LawOfSlip: TypeAlias = (
    "Callable[[float], Numbers] | Callable[[Array], Numbers] | Mapping[float, float]"
)


#: Slip speeds that differ by rounding are one: those of an encounter and of its scene.
SAME_SLIP = 1e-12


def numbers_at(
    argument: str, function: Callable[..., Numbers], speed: Real, shape: tuple[int, ...]
) -> AnyArray:
    """Return the unchecked numbers of a function at speeds in m/s, as an array of ``shape``.

    The function takes one float, or an array of ``shape``.
    """
    try:
        found = function(spread(speed, shape))
    except Exception as error:
        rule = f"raised {type(error).__name__} at speeds before the impact: {error}"
        raise refuse(argument, function, rule, "it takes a float, or an array") from error
    check_place(argument, found)
    return spread_over(argument, found, shape)


@overload
def spread_over(argument: str, numbers: Real, shape: tuple[int, ...]) -> Array: ...
@overload
def spread_over(argument: str, numbers: Numbers, shape: tuple[int, ...]) -> AnyArray: ...
def spread_over(argument: str, numbers: Numbers, shape: tuple[int, ...]) -> AnyArray:
    """Return read-only numbers of the shape of the impacts; refuse another shape."""
    try:
        return np.broadcast_to(np.asarray(numbers), shape)
    except ValueError:
        rule = f"must be one number, or of the shape {shape} of the impacts"
        raise refuse(argument, numbers, rule, "give one number for each impact") from None


def speed_pairs(argument: str, table: object, what: str) -> Array:
    """Return a table of speeds and numbers, shape (2, n), or refuse one that is no table.

    Parameters
    ----------
    argument : str
    table : list of pairs
    what : str
        Symbol of the number, for messages.
    """
    remedy = f"write [[speed, {what}], [speed, {what}]], speeds in m/s"
    try:
        pairs = np.array(table, dtype=float)
    except (TypeError, ValueError):
        pairs = np.empty(0)
    if pairs.ndim != 2 or pairs.shape[0] < 2 or pairs.shape[1] != 2:
        raise refuse(argument, table, f"must be two or more pairs of speed and {what}", remedy)
    speeds = pairs[:, 0]
    if not (np.all(np.diff(speeds) > 0.0) and speeds[0] >= 0.0 and np.isfinite(speeds[-1])):
        raise refuse(argument, table, "must have speeds that increase, from 0 on", remedy)
    return pairs.T


def interpolate(argument: str, pairs: Array, speed: Real, what: str) -> Real:
    """Return the numbers of a table at speeds, linear between its own, or refuse one outside."""
    known, values = pairs
    wrong = (np.asarray(speed) < known[0]) | (np.asarray(speed) > known[-1])
    if np.any(wrong):
        rule = f"has speeds from {known[0]:g} to {known[-1]:g} m/s, and an impact has "
        rule += f"{np.asarray(speed)[wrong].flat[0]:.4g} m/s"
        raise refuse(argument, pairs.T.tolist(), rule, f"add its {what} to the table")
    found: Real = np.interp(speed, known, values)
    return found


@attrs.frozen(eq=False)
class OfSlip:
    """A friction coefficient that follows from the slip speed before the impact.

    Attributes
    ----------
    law : callable or array, shape (2, n)
        The function, or speeds and coefficients of the table. None once only the numbers are kept.
    numbers : float or array
        The coefficients, by which it is known whether others were put in their place.
    slip : float or array
        The slip speeds in m/s for which they hold.
    """

    law: Callable[..., Numbers] | Array | None = attrs.field(
        metadata={"marks": False}
    )  # a sweep is known by its numbers
    numbers: Real
    slip: Real

    def __getstate__(self) -> dict[str, Any]:
        """Return the numbers: a function stays in its process."""
        return {"law": None, "numbers": self.numbers, "slip": self.slip}

    def __setstate__(self, state: Mapping[str, object]) -> None:
        for name, value in state.items():
            object.__setattr__(self, name, value)

    @classmethod
    def of(cls, law: Callable[..., Numbers] | Array, slip: Real, shape: tuple[int, ...]) -> OfSlip:
        """Return the friction coefficients at slip speeds, checked, one of each impact."""
        name = "friction_coefficient"
        if callable(law):
            found: AnyArray | Real = numbers_at(name, law, slip, shape)
        else:
            found = interpolate(name, law, spread(slip, shape), "mu")
        numbers = real(name, found, rule=NON_NEGATIVE, remedy="it has no unit", empty=True)
        return cls(law, numbers, spread(slip, shape))

    def at(self, friction: Real, slip: Real, shape: tuple[int, ...]) -> OfSlip | None:
        """Return the law at other slip speeds; None if numbers replaced the friction."""
        if np.shape(friction) != np.shape(self.numbers) or not np.all(friction == self.numbers):
            return None
        alike = np.shape(self.slip) == shape and np.allclose(slip, self.slip, SAME_SLIP, 0.0)
        if self.law is None or alike:
            return self
        return OfSlip.of(self.law, slip, shape)


def friction(*, empty: bool = False) -> Any:
    """Return the attrs field of a friction coefficient: numbers, or a function or table of slip."""
    return quantity("1", rule=NON_NEGATIVE, empty=empty, instead=is_law_of_slip)


def is_law_of_slip(friction: object) -> bool:
    """Return whether a friction coefficient is a function, or a table by slip speed."""
    return callable(friction) or isinstance(friction, Mapping)


def law_of_slip(friction: object) -> Callable[..., Numbers] | Array:
    """Return the function, or the speeds and coefficients of a table {slip speed: mu}, sorted."""
    if callable(friction):
        return friction
    assert isinstance(friction, Mapping)
    name, pairs = "friction_coefficient", list(friction.items())
    with contextlib.suppress(TypeError):  # a speed that is no number is refused with the table
        pairs.sort(key=lambda pair: pair[0])
    return speed_pairs(name, pairs, "mu")
