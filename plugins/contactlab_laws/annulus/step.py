"""One step of the contact problem, for any number of contacts at once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Real
from contactlab_laws.annulus.tables import Tables, hertz_pressure

#: Passes of the division into stick and slip; measured never above 14 (theory §6).
MOST_PASSES = 200
#: Traction over its limit up to which an annulus sticks. Back at a turning point the traction
#: equals its limit to rounding, and would be above it and below it by turns, without end.
TIE = 1.0 + 1e-12


class ContactStates(NamedTuple):
    """The memory of contacts, with their last division into stick and slip.

    Attributes
    ----------
    total : array, shape (..., 1)
        D, slip displacement so far.
    lag : array, shape (..., n)
        g_j = xi_j - D: constant while an annulus sticks.
    traction : array, shape (..., n)
        q_j, zero outside the contact.
    signs : array, shape (..., n)
        Sign of the traction of annuli that slip, 0 for annuli that stick or are outside.
    contact : array of bool, shape (..., n)
        Whether an annulus is in contact.
    """

    total: Array
    lag: Array
    traction: Array
    signs: Array
    contact: NDArray[np.bool_]

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
    # Scaled: ``displacement`` is 2.9432 psi dtau of eq. (33), ``radius`` is beta at the end of the
    # step, ``pressure`` the ratio to the pressure of a Hertz contact of this radius.
    shape, size = states.lag.shape[:-1], states.lag.shape[-1]
    lag, old = states.lag.reshape(-1, size), states.traction.reshape(-1, size)
    moved = np.asarray(displacement)[..., None] if shape else displacement
    total = (states.total + moved).reshape(-1, 1)
    limit = np.asarray(pressure)[..., None] * hertz_pressure(table, radius)
    if limit.shape != states.lag.shape:
        limit = np.broadcast_to(limit, states.lag.shape)
    limit = limit.reshape(-1, size)
    contact, touched = limit > 0.0, states.contact.reshape(-1, size)
    # First guess of the division: annuli new in contact do as the outermost annulus did.
    signs = states.signs.reshape(-1, size)
    outermost = signs[np.arange(len(signs)), touched.sum(axis=1) - 1]
    signs = np.where(contact, np.where(touched, signs, outermost[:, None]), 0.0)
    traction, new_lag = np.full_like(lag, np.nan), np.full_like(lag, np.nan)
    # NaN would pass every test as "not wrong": items with NaN are left out and answer NaN.
    finite = np.isfinite(limit.sum(axis=1) + total[:, 0])
    left = slice(None) if finite.all() else np.flatnonzero(finite)
    every, settled = np.arange(len(lag)), np.ones(len(lag), dtype=bool)
    for _ in range(MOST_PASSES):
        sign, most, before = signs[left], limit[left], lag[left]
        sticks = (sign == 0.0) & contact[left]
        pulls = _tractions(table, sticks, total[left] + before, sign * most)
        lags = np.where(sticks, before, pulls @ table.compliance.T - total[left])
        traction[left], new_lag[left] = pulls, lags
        over = sticks & (np.abs(pulls) > TIE * most)  # (36) fails
        wrong = over | ((sign != 0.0) & (sign * (before - lags) <= 0.0))  # or (37)
        fails = wrong.any(axis=1)
        if not fails.any():
            break
        signs[left] = np.where(wrong, np.where(over, np.sign(pulls), 0.0), sign)
        left = every[left][fails]
    else:
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
    # No annulus beyond ``reach`` sticks: no larger blocks are needed.
    reach = int(np.flatnonzero(sticks.any(axis=0)).max(initial=-1)) + 1
    inner, held = slice(reach), sticks[:, :reach]
    rest = held * (moved[:, inner] - limits @ table.compliance[inner].T)
    halfway = held * (rest @ table.lower_inverse[inner, inner].T)
    tractions = limits.copy()
    tractions[:, inner] += held * (halfway @ table.upper_inverse[inner, inner].T)
    leading = (held[:, 1:] <= held[:, :-1]).all(axis=1)
    for item in np.flatnonzero(~leading).tolist():
        at = held[item].nonzero()[0]
        block = table.compliance[np.ix_(at, at)]
        tractions[item, at] = np.linalg.solve(block, rest[item, at])
    return tractions
