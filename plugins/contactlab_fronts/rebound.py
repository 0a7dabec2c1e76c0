"""Rebound of many unlike impacts, by the exact solution's fronts taken for all at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab_fronts.many.march import march

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Impacts of which the history is kept at one time: some 50 MB. Beyond this chi there is more of
#: it for each impact, about as sqrt(chi).
CHUNK, CHUNK_CHI = 10_000, 30.0
#: As psi1 vanishes psi2/psi1 tends to a limit: below this the difference is some LINEAR of it.
LINEAR = 1e-6
#: |2 chi - 1| below which the edge neither sticks nor slips but in rounding: psi2 = -psi1.
BALANCED = 1e-8


def rebound(psi1: Array, chi: Array, tolerance: float) -> tuple[Array, Flags]:
    """Return (psi2, solved) of elastic Hertz impacts with Coulomb friction, e = 1.

    Parameters
    ----------
    psi1, chi : ndarray, shape (impacts,)
        Scaled incidence, any sign, and chi > 0 (theory §1).
    tolerance : float
        Wanted error of psi2, of max(1, |psi1|); 1e-6 to 1e-4. Most errors are below a tenth of it.

    Returns
    -------
    psi2 : ndarray, shape (impacts,)
        Odd in psi1 to the last bit; never NaN. Depends on the other impacts of the call by
        less than a hundredth of ``tolerance``.
    solved : ndarray of bool, shape (impacts,)
        False where the impact was given up, and psi2 is nothing but psi1.
    """
    speed = np.abs(psi1)
    change = -4.0 * chi  # slips throughout, eq. (45)
    solved = np.ones(psi1.shape, dtype=bool)
    sticks = np.flatnonzero(speed < np.maximum(1.0, 4.0 * chi - 1.0))
    balanced = np.abs(2.0 * chi[sticks] - 1.0) < BALANCED
    change[sticks[balanced]] = -2.0 * speed[sticks[balanced]]
    sticks = sticks[~balanced]
    largest = float(chi[sticks].max(initial=CHUNK_CHI))
    chunk = int(CHUNK * np.sqrt(CHUNK_CHI / largest))
    for first in range(0, sticks.size, chunk):
        part = sticks[first : first + chunk]
        scaled = np.maximum(speed[part], LINEAR)
        change[part], solved[part] = march(scaled, chi[part], tolerance)
        change[part] *= speed[part] / scaled
    change[~solved] = 0.0
    # no impact gains energy, nor more impulse than full slip gives: not even by an error
    np.clip(change, np.maximum(-2.0 * speed, -4.0 * chi), 0.0, out=change)
    return np.copysign(1.0, psi1) * (speed + change), solved
