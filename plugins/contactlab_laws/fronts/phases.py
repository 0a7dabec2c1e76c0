"""The phases of an impact: the series of each, and the events that end it.

An impact enters a phase with its numbers: the greatest u, how often the approach grew, steps, the
four ``Laws``, the state that the phase's series continue, and what stays constant. It leaves with
the numbers at the event.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

from contactlab_laws.fronts.series import (
    Laws,
    Rows,
    Series,
    along_drawn,
    along_gross,
    along_locked,
    along_stick,
    difference,
    negative,
)

#: A front whose square is below this part of its slope is followed to the centre.
INMOST = 0.1
#: An edge that is less beyond the front, or goes less beyond it, does so by rounding.
APART = 4e-15
#: Numbers before the laws and before the state.
HEAD, LAWS = 3, 7

Numbers: TypeAlias = tuple[float, ...]
#: Series whose fall below zero ends a phase. One marked True begins at zero: the fall of the series
#: over the variable is looked for.
Events: TypeAlias = list[tuple[Series, Any]]


class Phase(NamedTuple):
    """The length of a phase's state, its series and events, and the form in which they are found.

    ``course`` takes laws, state, constants and the form. ``power`` is the friction work over the
    variable, from the form and the values of the series ``slips``; where none slips these are none.
    """

    size: int
    form: Callable[[Any, Any], Any]
    course: Callable[[Laws, Any, Any, int], tuple[Rows, Events]]
    slips: tuple[int, ...] = ()
    power: Callable[..., Any] = float


def _stick(laws: Laws, state: Any, _constants: Any, _form: int) -> tuple[Rows, Events]:
    """All sticks until k, or its like of the other sign, is zero."""
    rows = along_stick(laws, state)
    other = difference(rows[1], difference(rows[2], rows[1]))
    return rows, [(rows[2], state[2] == 0.0), (other, False)]


def _drawn(laws: Laws, state: Any, _constants: Any, form: int) -> tuple[Rows, Events]:
    """Slip eats drawn memory until slip stops, the memory is spent, or the edge meets the front."""
    rows = along_drawn(laws, state, fresh=form == 2, back=form == 1)
    return rows, [_slip_stops(rows, state), (rows[7], False), _edge_meets(rows, state)]


def _drawn_form(state: Any, _constants: Any) -> Any:
    """Return 2 where slip begins, 1 where u k of the motion is larger than of the memory, or 0."""
    u, k, c, k1 = state[0], state[2], state[4], state[6]
    return (abs(u * k) > abs(c * k1)) + 2 * (k == 0.0 and k1 == 0.0)


def _drawn_power(form: int, u: Any, k: Any, c: Any, k1: Any) -> Any:
    """Return -u k x' (u - c)² (2u + c), where u k x' = c k_1 x_1'."""
    return (c * k1 if form == 1 else -u * k) * (u - c) ** 2 * (2.0 * u + c)


def _locked(laws: Laws, state: Any, constants: Any, form: int) -> tuple[Rows, Events]:
    """Slip eats a locked zone until slip stops, the zone is spent, or the edge meets the front."""
    rows = along_locked(laws, state, inmost=form == 1)
    rest = rows[4].copy()
    rest[0] = rest[0] - constants[0]
    return rows, [_slip_stops(rows, state), (rest, False), _edge_meets(rows, state)]


def _locked_form(state: Any, _constants: Any) -> Any:
    """Return 1 where the front is about to reach the centre."""
    return state[4] * state[4] < INMOST * abs(state[0] * state[2])


def _locked_power(form: int, u: Any, k: Any, c: Any) -> Any:
    """Return -u k x' (u - c)² (2u + c), where x' is 1 or, near the centre, 2c."""
    return -u * k * (u - c) ** 2 * (2.0 * u + c) * (2.0 * c if form == 1 else 1.0)


def _slip_stops(rows: Rows, state: Any) -> tuple[Series, Any]:
    return negative(rows[2]), state[2] == 0.0


def _edge_meets(rows: Rows, state: Any) -> tuple[Series, Any]:
    gap, meets = difference(rows[0], rows[4]), state[0] == state[4]
    # at chi = 1/2 the two go together; beside zero it is the slope that is looked at
    gap[0] = gap[0] + APART * (1 - meets)
    gap[1] = gap[1] + APART * meets
    return gap, meets


def _gross(laws: Laws, state: Any, _constants: Any, form: int) -> tuple[Rows, Events]:
    """All slips until slip stops or, where it does not, until u is zero."""
    rows = along_gross(laws, state)
    return rows, [_slip_stops(rows, state) if form else (rows[0], state[0] == 0.0)]


STICK = Phase(7, lambda state, _constants: 0 * state[0], _stick)
DRAWN = Phase(10, _drawn_form, _drawn, (0, 2, 4, 6), _drawn_power)
LOCKED = Phase(7, _locked_form, _locked, (0, 2, 4), _locked_power)
#: The constant is the form: whether slip stops.
GROSS = Phase(6, lambda _state, constants: constants[0], _gross)
