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


class ContactStates(NamedTuple):
    """Contacts of a batch: entries as in ``one.ContactState``, with the batch's shape first."""

    total: Array  # (..., 1)
    lag: Array  # (..., n)
    traction: Array  # (..., n)
    signs: Array  # (..., n): of slip, 0 where stuck or outside
    contact: NDArray[np.bool_]  # (..., n)

    def division(self) -> tuple[NDArray[np.bool_], NDArray[np.int8]]:
        """Return which annuli are stuck, and the sign of slip of each annulus."""
        return (self.signs == 0.0) & self.contact, self.signs.astype(np.int8)


def start(annuli: int, shape: tuple[int, ...]) -> ContactStates:
    """Return contacts without traction."""
    nothing = np.zeros((*shape, annuli))
    return ContactStates(nothing[..., :1], nothing, nothing, nothing, nothing > 0.0)


def advance(
    table: Tables, states: ContactStates, displacement: Real, radius: Real, pressure: Real
) -> tuple[Array, Array, NDArray[np.bool_], ContactStates]:
    """Return forces, works, whether divisions pass the tests (batch shape), and new states."""
    shape, size = states.lag.shape[:-1], states.lag.shape[-1]
    lag, old = states.lag.reshape(-1, size), states.traction.reshape(-1, size)
    moved = np.broadcast_to(displacement, shape)[..., None]
    total = (states.total + moved).reshape(-1, 1)
    limit = np.asarray(pressure)[..., None] * hertz_pressure(table, radius)
    limit = np.broadcast_to(limit, (*shape, size)).reshape(-1, size)
    contact, touched = limit > 0.0, states.contact.reshape(-1, size)
    # First guess of the division: annuli new in contact do as the outermost annulus did.
    signs = states.signs.reshape(-1, size)
    outermost = signs[np.arange(len(signs)), touched.sum(axis=1) - 1]
    signs = np.where(contact, np.where(touched, signs, outermost[:, None]), 0.0)
    traction, new_lag = np.full_like(lag, np.nan), np.full_like(lag, np.nan)
    # NaN would pass every test as "not wrong": items with NaN are left out and answer NaN.
    left = np.flatnonzero(np.isfinite(limit.sum(axis=1) + total[:, 0]))
    for _ in range(MOST_PASSES):
        sign, most, before = signs[left], limit[left], lag[left]
        sticks = (sign == 0.0) & contact[left]
        pulls = _tractions(table, sticks, total[left] + before, sign * most)
        lags = np.where(sticks, before, pulls @ table.compliance.T - total[left])
        traction[left], new_lag[left] = pulls, lags
        over = sticks & (np.abs(pulls) > TIE * most)
        wrong = over | ((sign != 0.0) & (sign * (before - lags) <= 0.0))
        signs[left] = np.where(wrong, np.where(over, np.sign(pulls), 0.0), sign)
        left = left[wrong.any(axis=1)]
        if not len(left):
            break
    settled = np.ones(len(lag), dtype=bool)
    settled[left] = False
    force = traction @ table.weight
    work = np.einsum("ij,ij->i", 0.5 * table.weight * (traction + old), lag - new_lag)
    whole = (*shape, size)
    after = ContactStates(
        total=total.reshape(*shape, 1),
        lag=new_lag.reshape(whole),
        traction=traction.reshape(whole),
        signs=signs.reshape(whole),
        contact=contact.reshape(whole),
    )
    return force.reshape(shape), work.reshape(shape), settled.reshape(shape), after


def _tractions(table: Tables, sticks: NDArray[np.bool_], moved: Array, limits: Array) -> Array:
    """Return the tractions: from displacements ``moved`` where stuck, else ``limits``."""
    # Where the stuck annuli are the leading ones, masks pick the leading blocks of the triangular
    # factors, whatever their number; other items are solved one by one.
    rest = sticks * (moved - limits @ table.compliance.T)
    inner = sticks * (rest @ table.lower_inverse.T)
    tractions = limits + sticks * (inner @ table.upper_inverse.T)
    leading = (sticks[:, 1:] <= sticks[:, :-1]).all(axis=1)
    for item in np.flatnonzero(~leading):
        at = np.flatnonzero(sticks[item])
        block = table.compliance[np.ix_(at, at)]
        tractions[item, at] = np.linalg.solve(block, rest[item, at])
    return np.asarray(tractions)
