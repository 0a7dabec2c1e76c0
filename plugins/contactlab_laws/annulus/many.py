"""The contact problem of many impacts at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.checks import Real
from contactlab_laws.annulus.one import TIE
from contactlab_laws.annulus.tables import Array, Tables, hertz_pressure

#: Passes of the division into stick and slip; measured never above 14 (theory §6).
MOST_PASSES = 200


class Memory(NamedTuple):
    """As ``one.Memory``; the leading shape is the batch's."""

    total: Array  # (..., 1)
    lag: Array  # (..., n)
    traction: Array  # (..., n)
    signs: Array  # (..., n): of slip, 0 where stuck or outside
    contact: NDArray[np.bool_]  # (..., n)

    def division(self) -> tuple[NDArray[np.bool_], NDArray[np.int8]]:
        """Return which annuli are stuck, and the sign of those that slip."""
        return (self.signs == 0.0) & self.contact, self.signs.astype(np.int8)


def start(annuli: int, shape: tuple[int, ...]) -> Memory:
    """Return contacts without traction."""
    nothing = np.zeros((*shape, annuli))
    return Memory(nothing[..., :1], nothing, nothing, nothing, nothing > 0.0)


def advance(
    table: Tables, memory: Memory, displacement: Real, radius: Real, pressure: Real
) -> tuple[Array, Array, NDArray[np.bool_], Memory]:
    """Return forces, friction works, whether divisions were found, and the new memory.

    Parameters
    ----------
    table : Tables
    memory : Memory
    displacement, radius, pressure : float or array
        As of ``one.advance``, of the batch shape or broadcasting to it.
    """
    shape, size = memory.lag.shape[:-1], memory.lag.shape[-1]
    lag, old = memory.lag.reshape(-1, size), memory.traction.reshape(-1, size)
    moved = np.broadcast_to(displacement, shape)[..., None]
    total = (memory.total + moved).reshape(-1, 1)
    limit = np.asarray(pressure)[..., None] * hertz_pressure(table, radius)
    limit = np.broadcast_to(limit, (*shape, size)).reshape(-1, size)
    contact = limit > 0.0
    signs = np.where(contact, memory.signs.reshape(-1, size), 0.0)
    traction, new_lag = np.full_like(lag, np.nan), np.full_like(lag, np.nan)
    # NaN would pass every test as "not wrong": such items are left out and answer NaN.
    left = np.flatnonzero(np.isfinite(limit.sum(axis=1) + total[:, 0]))
    for _ in range(MOST_PASSES):
        sign, most, before = signs[left], limit[left], lag[left]
        sticks = (sign == 0.0) & contact[left]
        found = _tractions(table, sticks, total[left] + before, sign * most)
        lags = np.where(sticks, before, found @ table.compliance.T - total[left])
        traction[left], new_lag[left] = found, lags
        over = sticks & (np.abs(found) > TIE * most)
        wrong = over | ((sign != 0.0) & (sign * (before - lags) <= 0.0))
        signs[left] = np.where(wrong, np.where(over, np.sign(found), 0.0), sign)
        left = left[wrong.any(axis=1)]
        if not len(left):
            break
    settled = np.ones(len(lag), dtype=bool)
    settled[left] = False
    force = traction @ table.weight
    work = np.einsum("ij,ij->i", 0.5 * table.weight * (traction + old), lag - new_lag)
    whole = (*shape, size)
    after = Memory(
        total=total.reshape(*shape, 1),
        lag=new_lag.reshape(whole),
        traction=traction.reshape(whole),
        signs=signs.reshape(whole),
        contact=contact.reshape(whole),
    )
    return force.reshape(shape), work.reshape(shape), settled.reshape(shape), after


def _tractions(table: Tables, sticks: NDArray[np.bool_], moved: Array, given: Array) -> Array:
    """Return the tractions: ``given`` where not stuck, from displacements ``moved`` where stuck.

    Where the stuck annuli are the leading ones, masks pick the leading blocks of the
    triangular factors, whatever their number; the rest is solved item by item.

    Parameters
    ----------
    table : Tables
    sticks : array of bool, shape (items, n)
    moved, given : array, shape (items, n)
    """
    rest = sticks * (moved - given @ table.compliance.T)
    inner = sticks * (rest @ table.lower_inverse.T)
    tractions = given + sticks * (inner @ table.upper_inverse.T)
    leading = (sticks[:, 1:] <= sticks[:, :-1]).all(axis=1)
    for item in np.flatnonzero(~leading):
        at = np.flatnonzero(sticks[item])
        block = table.compliance[np.ix_(at, at)]
        tractions[item, at] = np.linalg.solve(block, rest[item, at])
    return np.asarray(tractions)
