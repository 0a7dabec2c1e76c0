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

import math
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dposv

from contactlab.numeric.types import Array, Mask
from contactlab_halfspace.modes import Modes
from contactlab_halfspace.pressure import Contact

#: Residual, over the largest pressure, at which a step is solved.
TOLERANCE = 1e-7
#: Over-relaxation, and iterates that are mixed.
RELAXATION, DEPTH = 1.5, 8
#: Applications with mixing, and all applications of a step.
MIXED, MOST = 60, 1500
#: Ridge of the least squares of the mixing, over the diagonal.
RIDGE = 1e-13
#: Least divisor: a traction of length 0, or a contact without a limit.
TINY = 1e-300


class Settled(NamedTuple):
    """The answer of a step, the first axis that of the impacts.

    Attributes
    ----------
    traction : array, shape (impacts, parts, angles, rings)
    memory : array, shape (impacts, parts, angles, rings)
        Start of the next step.
    share, force : array, shape (impacts,)
        F over the friction load, and the friction load.
    residual : array, shape (impacts,)
        Over the largest pressure.
    """

    traction: Array
    memory: Array
    share: Array
    force: Array
    residual: Array


def settle(table: Modes, contact: Contact, target: Array, slowing: Array, start: Array) -> Settled:
    """Return the tractions that obey Coulomb's law at the end of a step.

    Parameters
    ----------
    table : Modes
    contact : Contact
        Limit, load and yielding of the step.
    target : array, shape (impacts, parts, angles, rings)
        Displacement at which the surfaces stick, and at which they touch.
    slowing : array, shape (impacts,)
        Displacement along x that a share of 1 takes away.
    start : array, shape (impacts, parts, angles, rings)
        Memory of the step before, 0 in new rings.
    """
    impacts, _, angles, number = start.shape
    resolvent, metric = table.resolvent(number), table.metric(number)
    weights, normal = table.force(number).ravel(), table.basis.force[:number] / angles
    along, aim, joint = metric * table.along, metric * target, contact.limit is None
    answer = Settled(*np.empty((2, *start.shape)), *np.empty((3, impacts)))
    left, now, mixing, applied = np.arange(impacts), start, _Mixing(start.shape), 0
    # A divisor of infinity leaves no share where a contact has no load.
    limit = np.zeros((impacts, 1)) if contact.limit is None else contact.limit
    load, yielding, slows = (
        each + np.zeros(impacts) for each in (contact.load, contact.yielding, slowing)
    )
    limits, limit = np.maximum(limit.max(axis=1), TINY), limit[:, None]
    divisor = np.where(load > 0.0, load, np.inf)
    while True:
        x = np.empty(now.shape)
        if joint:
            limit = np.maximum(now[:, 2], 0.0, out=x[:, 2])
            load = limit.sum(axis=1) @ normal
            limits = np.maximum(limit.reshape(len(x), -1).max(axis=1), TINY)
            divisor = np.where(load > 0.0, load, np.inf)
        length = np.sqrt(now[:, 0] * now[:, 0] + now[:, 1] * now[:, 1])
        short = np.minimum(1.0, limit / np.maximum(length, TINY))
        np.multiply(now[:, :2], short[:, None], out=x[:, :2])
        share = (x[:, :2].reshape(len(x), 1, -1) @ weights)[:, 0] / divisor
        wanted = 2.0 * x - now + aim
        wanted[:, :2] -= (slows * share)[:, None, None, None] * along
        if joint:
            wanted[:, 2] -= (yielding * load)[:, None, None] * metric
        change = table.through(resolvent, wanted)
        change -= x
        applied += 1
        residual = np.abs(change).reshape(len(x), -1).max(axis=1) / limits
        stays = residual >= TOLERANCE
        if applied >= MOST:
            stays[:] = False
        if not stays.all():
            ends = ~stays
            for column, values in zip(answer, (x, now, share, load, residual), strict=True):
                column[left[ends]] = values[ends]
            if not stays.any():
                return answer
            left, now, change, aim = left[stays], now[stays], change[stays], aim[stays]
            each = limit, limits, load, divisor, yielding, slows
            limit, limits, load, divisor, yielding, slows = (column[stays] for column in each)
            mixing.keep(stays)
        change *= RELAXATION
        now = mixing.next(now, change) if applied <= MIXED else now + change


class _Mixing:
    """Anderson's mixing of the iterates of one step, each impact by itself.

    Parameters
    ----------
    shape : tuple of int
        Shape of the iterates, the first axis that of the impacts.
    """

    def __init__(self, shape: tuple[int, ...]) -> None:
        #: Differences of changes and of plain successors from one iterate to the next.
        self._past = np.empty((2, shape[0], DEPTH, math.prod(shape[1:])))
        self._products = np.zeros((shape[0], DEPTH, DEPTH))
        self._filled = 0
        self._last: Array | None = None

    def keep(self, which: Mask) -> None:
        """Go on with some of the impacts."""
        self._past, self._products = self._past[:, which], self._products[which]
        if self._last is not None:
            self._last = self._last[:, which]

    def next(self, now: Array, change: Array) -> Array:
        """Return the next iterates after ``now``, whose plain successors are now + change."""
        both = np.empty((2, *now.shape))
        plain: Array = np.add(now, change, out=both[1])
        both[0] = change
        rows = both.reshape(2, len(now), -1)
        last, self._last = self._last, rows
        if last is None:
            return plain
        place = self._filled % DEPTH
        self._filled += 1
        known = min(self._filled, DEPTH)
        np.subtract(rows, last, out=self._past[:, :, place])
        changes, moves = self._past[:, :, :known]
        row = (changes @ changes[:, place, :, None])[..., 0]
        self._products[:, place, :known] = self._products[:, :known, place] = row
        self._products[:, place, place] *= 1.0 + RIDGE
        shares = np.zeros((len(now), 1, known))
        for item, right in enumerate(changes @ rows[0, :, :, None]):
            _, solved, failed = dposv(self._products[item, :known, :known], right)
            if not failed:
                shares[item] = solved.T
        return np.asarray(plain - (shares @ moves).reshape(now.shape))
