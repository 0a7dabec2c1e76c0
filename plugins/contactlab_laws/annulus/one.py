"""The contact problem of one impact, one step at a time."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab_laws.annulus.tables import Array, Tables, hertz_pressure, response

#: Passes of the division into stick and slip; measured never above 14 (theory §6).
MOST_PASSES = 200
#: Traction over its limit up to which an annulus sticks. Back at a turning point the traction
#: equals its limit to rounding, and would be above it and below it by turns, without end.
TIE = 1.0 + 1e-12


class ContactState(NamedTuple):
    """The memory of one contact, and its last division into stick and slip.

    Attributes
    ----------
    total : float
        D, slip displacement so far.
    lag : array, shape (n,)
        g_j = xi_j - D: constant while an annulus sticks.
    traction : array, shape (n,)
        q_j, zero outside the contact.
    signs : array, shape (n,)
        Sign of the traction of annuli that slip, 0 for annuli that stick.
    touching : int
        Annuli in contact.
    """

    total: float
    lag: Array
    traction: Array
    signs: Array
    touching: int

    def division(self) -> tuple[NDArray[np.bool_], NDArray[np.int8]]:
        """Return which annuli are stuck, and the sign of slip of each annulus."""
        inside = np.arange(len(self.lag)) < self.touching
        return inside & (self.signs == 0.0), (inside * self.signs).astype(np.int8)


def start(annuli: int) -> ContactState:
    """Return a contact without traction."""
    return ContactState(0.0, np.zeros(annuli), np.zeros(annuli), np.zeros(annuli), 0)


def advance(
    table: Tables, state: ContactState, displacement: float, radius: float, pressure: float
) -> tuple[float, float, bool, ContactState]:
    """Return force, friction work, whether a division passes the tests, and the new state."""
    # Scaled: ``displacement`` is 2.9432 psi dtau of eq. (33), ``radius`` is beta at the end of the
    # step, ``pressure`` the ratio to the pressure of a Hertz contact of this radius.
    total = state.total + displacement
    if not math.isfinite(total * (radius * radius) * pressure):
        return math.nan, math.nan, True, state
    limit = pressure * hertz_pressure(table, radius)
    inside = limit > 0.0
    touching, lag = int(np.count_nonzero(inside)), state.lag
    signs = extended(state.signs, state.touching, touching)
    seen: set[bytes] = set()
    for _ in range(MOST_PASSES):
        sticks = inside & (signs == 0.0)
        drive = np.where(sticks, lag, signs * limit)
        force, answer = respond(table, sticks, total, drive)
        over = sticks & (np.abs(answer) > TIE * limit)  # (36) fails
        back = inside & ~sticks & (signs * (lag - answer) <= 0.0)  # (37) fails
        key = signs.tobytes()
        if not (over | back).any():
            traction, new_lag = np.where(sticks, answer, drive), np.where(sticks, lag, answer)
            mean = 0.5 * table.weight * (traction + state.traction)
            work = float(mean.dot(lag - new_lag))
            return force, work, True, ContactState(total, new_lag, traction, signs, touching)
        if key in seen:
            break
        seen.add(key)
        signs = np.where(over, np.sign(answer), np.where(back, 0.0, signs))
    return math.nan, math.nan, False, state


def extended(signs: Array, touching_before: int, touching: int) -> Array:
    """Return a first guess of the division: new annuli do as the outermost annulus did."""
    if touching <= touching_before or touching_before == 0:
        return signs
    guess = signs.copy()
    guess[touching_before:touching] = signs[touching_before - 1]
    return guess


def respond(
    table: Tables, sticks: NDArray[np.bool_], total: float, drive: Array
) -> tuple[float, Array]:
    """Return the force, and tractions of annuli that stick, lags of annuli that slip."""
    # ``drive`` holds lags of annuli that stick and tractions of annuli that slip.
    if table.responses:
        row = np.concatenate(([total], drive))
        answer = row.dot(response(len(sticks), table.mean, sticks.tobytes()))
        return answer.item(0), answer[1:]
    traction = np.where(sticks, 0.0, drive)
    rest = total + drive[sticks] - table.compliance[sticks] @ traction
    c = len(rest)
    if sticks[:c].all():
        traction[:c] = table.upper_inverse[:c, :c] @ (table.lower_inverse[:c, :c] @ rest)
    else:
        traction[sticks] = np.linalg.solve(table.compliance[np.ix_(sticks, sticks)], rest)
    lags = table.compliance @ traction - total
    return float(table.weight @ traction), np.where(sticks, traction, lags)
