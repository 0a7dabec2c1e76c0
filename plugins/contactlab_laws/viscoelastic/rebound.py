"""psi2 with one loss for pressure and shear: by the table, and by springs beyond it."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.numeric.types import Array, Real
from contactlab_laws.compiled import library
from contactlab_laws.tables import restituted
from contactlab_laws.tables.restituted_regions import RESTITUTED_CHI

#: Springs and steps up to the largest chi of the table; beyond it as its fourth and square root.
SPRINGS, STEPS = 100, 800
#: Below this e psi2 is linear in e to 1e-4: a slower rebound takes more steps than it is worth.
LEAST = 1e-3
#: Springs that are moved in a call of the compiled march, half a second; numbers of a sample; rows
#: of springs of the work space, each as long as the next multiple of 8.
AT_A_TIME, SAMPLE, ROWS, LANES = 10_000_000, 7, 16, 8


def rebound(psi1: Any, chi: Any, restitution: Any, *, derivatives: bool = False) -> Any:
    """Return psi2, odd in psi1 to the last bit, abs(psi2) <= abs(psi1).

    Parameters
    ----------
    psi1, chi, restitution : float, or array of shape (impacts,)
        Any psi1, chi > 0, and e from 0 to 1, 1 excluded; psi1 and chi both floats or both arrays.
    derivatives : bool
        As of ``restituted.rebound``, for arrays in the table.
    """
    low, high = RESTITUTED_CHI
    if isinstance(psi1, float):
        if low <= chi <= high:
            return restituted.single(psi1, chi, restitution)
        return rebound(np.array([psi1]), np.array([chi]), restitution).item()
    known = (chi >= low) & (chi <= high)
    if known.all():
        return restituted.rebound(psi1, chi, restitution, derivatives=derivatives)
    e = np.broadcast_to(restitution, psi1.shape)
    psi2 = np.empty_like(psi1)
    if known.any():
        own = restitution if isinstance(restitution, float) else e[known]
        psi2[known] = restituted.rebound(psi1[known], chi[known], own)
    far = ~known
    found = beyond(np.abs(psi1[far]), chi[far], e[far])
    psi2[far] = np.where(psi1[far] < 0.0, -found, found)
    return psi2


@np.errstate(under="ignore")  # small numbers may vanish
def beyond(speed: Array, chi: Array, e: Array) -> Array:
    """Return psi2 of psi1 = speed >= 0 without the table, shape (impacts,)."""
    psi2 = restituted.full_slip(speed, chi, e)
    who = np.flatnonzero(restituted.sticks(speed, chi, e))
    p, x, own = speed[who], chi[who], e[who]
    found, share = restituted.without_rebound(p, x), np.minimum(own / LEAST, 1.0)
    where = np.flatnonzero(own > 0.0)
    by_springs = _follow_springs(p[where], x[where], np.maximum(own[where], LEAST))
    found[where] += share[where] * (by_springs - found[where])
    psi2[who] = np.clip(np.maximum(found, psi2[who]), -p, p)
    return np.asarray(psi2)


def _follow_springs(speed: Array, chi: Array, e: Array) -> Array:
    """Return psi2 by springs; impacts with chi within a factor of two run together."""
    from contactlab_laws.viscoelastic import batch  # a table needs none of this
    from contactlab_laws.viscoelastic.relaxation import number_of

    psi2 = np.empty_like(speed)
    octave = np.ceil(np.log2(np.maximum(chi / RESTITUTED_CHI[1], 1.0)))
    for level in np.unique(octave).tolist():
        part = octave == level
        grid = {
            "springs": round(SPRINGS * 2.0 ** (level / 4)),
            "steps": 2 * round(STEPS * 2.0 ** (level / 2 - 1)),
        }
        follow = batch.rebound if library() is None else _follow_in_c
        psi2[part] = follow(speed[part], chi[part], number_of(e[part]), **grid)
    return psi2


def _follow_in_c(psi1: Array, chi: Array, number: Real, *, springs: int, steps: int) -> Array:
    """Return psi2 of psi1 >= 0 by the compiled march, as ``batch.rebound`` does."""
    found, psi2 = library(), np.empty_like(psi1)
    assert found is not None
    rows = [np.ascontiguousarray(each) for each in (psi1, chi, number)]
    samples, work = np.empty((steps, SAMPLE)), np.empty(ROWS * (springs + LANES))
    width = max(AT_A_TIME // (springs * steps), 1)  # Ctrl-C is heard between two calls
    for first in range(0, psi1.size, width):
        count = min(width, psi1.size - first)
        found.contactlab_march_rebounds(
            count, *(each[first:].ctypes.data for each in rows), springs, steps,
            samples.ctypes.data, work.ctypes.data, psi2[first:].ctypes.data,
        )  # fmt: skip
    return np.clip(psi2, -psi1, psi1)
