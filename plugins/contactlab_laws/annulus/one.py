"""The contact problem of one impact, one step at a time."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab_laws.annulus.tables import Array, Tables, hertz_pressure, response

#: Passes of the division into stick and slip; measured never above 14 (theory §6).
MOST_PASSES = 200
#: Back at a turning point the traction is at its limit to rounding, and would be found now
#: above it, now below, without end: a tie is stick.
TIE = 1.0 + 1e-12


class Memory(NamedTuple):
    """What the contact remembers, and the last division into stick and slip.

    Attributes
    ----------
    total : float
        D, slip displacement so far.
    lag : array, shape (n,)
        g_j = xi_j - D: constant while an annulus sticks.
    traction : array, shape (n,)
        q_j, zero outside the contact.
    signs : array, shape (n,)
        Of the traction of annuli that slip, 0 for those that stick.
    touching : int
        Annuli in contact.
    """

    total: float
    lag: Array
    traction: Array
    signs: Array
    touching: int

    def division(self) -> tuple[NDArray[np.bool_], NDArray[np.int8]]:
        """Return which annuli are stuck, and the sign of those that slip."""
        inside = np.arange(len(self.lag)) < self.touching
        return inside & (self.signs == 0.0), (inside * self.signs).astype(np.int8)


def start(annuli: int) -> Memory:
    """Return a contact without traction."""
    return Memory(0.0, np.zeros(annuli), np.zeros(annuli), np.zeros(annuli), 0)


def advance(
    table: Tables, memory: Memory, displacement: float, radius: float, pressure: float
) -> tuple[float, float, bool, Memory]:
    """Return force, friction work, whether a division was found, and the new memory.

    Parameters
    ----------
    table : Tables
    memory : Memory
    displacement : float
        Slip displacement of the step, 2.9432 psi dtau of eq. (33).
    radius : float
        beta at the end of the step.
    pressure : float
        Ratio of the pressure to that of a Hertz contact of this radius.
    """
    total = memory.total + displacement
    if not math.isfinite(total * (radius * radius) * pressure):
        return math.nan, math.nan, True, memory
    limit = pressure * hertz_pressure(table, radius)
    inside = limit > 0.0
    touching, lag = int(np.count_nonzero(inside)), memory.lag
    signs = extended(memory.signs, memory.touching, touching)
    seen: set[bytes] = set()
    for _ in range(MOST_PASSES):
        sticks = inside & (signs == 0.0)
        given = np.where(sticks, lag, signs * limit)
        force, found = respond(table, sticks, total, given)
        over = sticks & (np.abs(found) > TIE * limit)  # (36) fails
        back = inside & ~sticks & (signs * (lag - found) <= 0.0)  # (37) fails
        key = signs.tobytes()
        if not (over | back).any():
            traction, new_lag = np.where(sticks, found, given), np.where(sticks, lag, found)
            mean = 0.5 * table.weight * (traction + memory.traction)
            work = float(mean.dot(lag - new_lag))
            return force, work, True, Memory(total, new_lag, traction, signs, touching)
        if key in seen:
            break
        seen.add(key)
        signs = np.where(over, np.sign(found), np.where(back, 0.0, signs))
    return math.nan, math.nan, False, memory


def extended(signs: Array, touching_before: int, touching: int) -> Array:
    """Return a first guess of the division: as before, newcomers as the outermost annulus."""
    if touching <= touching_before or touching_before == 0:
        return signs
    guess = signs.copy()
    guess[touching_before:touching] = signs[touching_before - 1]
    return guess


def respond(
    table: Tables, sticks: NDArray[np.bool_], total: float, given: Array
) -> tuple[float, Array]:
    """Return the force, and tractions where it sticks, lags where not.

    Parameters
    ----------
    table : Tables
    sticks : array of bool, shape (n,)
    total : float
        D, slip displacement so far.
    given : array, shape (n,)
        Lags where it sticks and tractions where not; see ``tables.exchange``.
    """
    if table.responses:
        drive = np.concatenate(([total], given))
        found = drive.dot(response(len(sticks), table.mean, sticks.tobytes()))
        return found.item(0), found[1:]
    traction = np.where(sticks, 0.0, given)
    rest = total + given[sticks] - table.compliance[sticks] @ traction
    c = len(rest)
    if sticks[:c].all():
        traction[:c] = table.upper_inverse[:c, :c] @ (table.lower_inverse[:c, :c] @ rest)
    else:
        traction[sticks] = np.linalg.solve(table.compliance[np.ix_(sticks, sticks)], rest)
    lags = table.compliance @ traction - total
    return float(table.weight @ traction), np.where(sticks, traction, lags)
