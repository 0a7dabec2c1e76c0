"""The tractions at the end of a step: Coulomb's law and contact at every point, by splitting.

The tractions x solve: compliance x - target is a normal of the constraints at x. The constraints
are abs(q) <= p at every point, and p >= 0 where the pressure is part of x. Douglas-Rachford
splitting takes turns between the constraints and the compliance. Its iterates are mixed by
Anderson's method, which now and then stalls; then the splitting goes on plainly.

References
----------
Eckstein & Bertsekas, Math. Program. 55 (1992) 293-318; Walker & Ni, SIAM J. Numer.
Anal. 49 (2011) 1715-1735.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dposv

from contactlab.numeric.types import Array
from contactlab_halfspace.modes import Modes
from contactlab_halfspace.pressure import Contact

#: Residual, over the largest pressure, at which a step is solved.
TOLERANCE = 1e-7
#: Over-relaxation, and iterates that are mixed.
RELAXATION, DEPTH = 1.5, 8
#: Applications with mixing, and all applications of a step.
MIXED, MOST = 60, 1500
#: Ridge of the least squares of the mixing, over the trace.
RIDGE = 1e-13
#: Least divisor: a traction of length 0, or a contact without a limit.
TINY = 1e-300


class Settled(NamedTuple):
    """The answer of a step.

    Attributes
    ----------
    traction : array, shape (parts, angles, rings)
    memory : array, shape (parts, angles, rings)
        Start of the next step.
    share, force : float
        F over the friction load, and the friction load.
    residual : float
        Over the largest pressure.
    """

    traction: Array
    memory: Array
    share: float
    force: float
    residual: float


def settle(table: Modes, contact: Contact, target: Array, slowing: float, start: Array) -> Settled:
    """Return the tractions that obey Coulomb's law at the end of a step.

    Parameters
    ----------
    table : Modes
    contact : Contact
        Limit, load and yielding of the step.
    target : array, shape (parts, angles, rings)
        Displacement at which the surfaces stick, and at which they touch.
    slowing : float
        Displacement along x that a share of 1 takes away.
    start : array, shape (parts, angles, rings)
        Memory of the step before, 0 in new rings.
    """
    parts, angles, number = start.shape
    resolvent, metric = table.resolvent(number), table.metric(number)
    aim, along = metric * target, metric * table.along
    weights, normal = table.force(number), table.basis.force[:number] / angles
    to, back, size = table.to, table.back, angles + 1
    now, mixing = start, _Mixing(start.size)
    joint, limit = contact.limit is None, contact.limit
    residual, applied = np.inf, 0
    x = np.empty(start.shape)
    share = force = 0.0
    while True:
        if joint:
            limit = np.maximum(now[2], 0.0, out=x[2])
        assert limit is not None
        length = np.sqrt(now[0] * now[0] + now[1] * now[1])
        np.multiply(now[:2], np.minimum(1.0, limit / np.maximum(length, TINY)), out=x[:2])
        pull = float(np.vdot(weights, x[:2]))
        force = float((x[2] @ normal).sum()) if joint else contact.load
        share = pull / force if force > 0.0 else 0.0
        wanted = 2.0 * x - now + aim
        wanted[:2] -= (slowing * share) * along
        if joint:
            wanted[2] -= (contact.yielding * force) * metric
        columns = (to @ wanted).transpose(1, 0, 2).reshape(size, parts * number, 1)
        resolved = (resolvent @ columns).reshape(size, parts, number).transpose(1, 0, 2)
        change = back @ resolved
        change -= x
        applied += 1
        largest = float(np.abs(change).max())
        if largest == 0.0:
            residual = 0.0
            break
        residual = largest / max(float(limit.max()), TINY)
        if residual < TOLERANCE or applied >= MOST or not np.isfinite(residual):
            break
        change *= RELAXATION
        now = mixing.next(now, change) if applied <= MIXED else now + change
    return Settled(x.copy(), now, share, force, residual)


class _Mixing:
    """Anderson's mixing of the iterates of one step."""

    def __init__(self, size: int) -> None:
        self._changes, self._moves = np.empty((DEPTH, size)), np.empty((DEPTH, size))
        self._products = np.zeros((DEPTH, DEPTH))
        self._filled = 0
        self._last: tuple[Array, Array] | None = None

    def next(self, now: Array, change: Array) -> Array:
        """Return the next iterate after ``now``, whose plain successor is now + change."""
        flat = change.ravel()
        plain = now + change
        if self._last is not None:
            place, last = self._filled % DEPTH, self._last
            self._filled += 1
            self._changes[place] = flat - last[1]
            self._moves[place] = plain.ravel() - last[0]
            known = min(self._filled, DEPTH)
            row = self._changes[:known] @ self._changes[place]
            self._products[place, :known] = self._products[:known, place] = row
        self._last = plain.ravel(), flat
        if not self._filled:
            return plain
        known = min(self._filled, DEPTH)
        matrix = self._products[:known, :known].copy()
        matrix.flat[:: known + 1] += RIDGE * np.trace(matrix)
        _, shares, failed = dposv(matrix, self._changes[:known] @ flat)
        if failed:
            return plain
        return np.asarray(plain - (shares @ self._moves[:known]).reshape(now.shape))
