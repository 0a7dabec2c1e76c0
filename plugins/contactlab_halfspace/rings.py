"""Tractions along one direction, functions of the radius: matrices of rings, stick and slip.

The traction is q(r) = sum a_i sqrt(e_i² - r²) over the edges e_i of rings, theory §9 "Basis". The
displacement that it makes is known in closed form inside and outside of e_i. On the inner edge of
every ring Coulomb's law holds: abs(q) <= p. Where abs(q) < p the ring sticks, where abs(q) = p the
ring slips along q.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Places
from contactlab_laws.annulus.tables import factors

Mask = NDArray[np.bool_]

#: Tolerance of a traction above its limit, and of a slip against its traction, over the largest.
ROUNDING = 1e-11
#: Most divisions tried in a step; beyond ``GENTLE`` one ring at a time is changed.
MOST_TRIES, GENTLE = 400, 20


class Rings(NamedTuple):
    """Matrices of rings. Leading blocks are the matrices of smaller contacts.

    Attributes
    ----------
    points : array, shape (rings,)
        The inner edge of every ring.
    compliance : array, shape (rings, rings)
        Displacement at the points for a unit of traction at each point.
    lower, upper : array, shape (rings, rings)
        Inverses of the triangular factors of ``compliance``: contacts whose stuck part is a disc
        need no solve.
    weights : array, shape (rings,)
        The force for a unit of traction at each point.
    """

    points: Array
    compliance: Array
    lower: Array
    upper: Array
    weights: Array

    def within(self, number: int) -> Rings:
        """Return the matrices of the first ``number`` rings."""
        block = slice(number), slice(number)
        return Rings(
            points=self.points[:number],
            compliance=self.compliance[block],
            lower=self.lower[block],
            upper=self.upper[block],
            weights=self.weights[:number],
        )


def rings(edges: Array) -> Rings:
    """Return the matrices of the rings between ``edges``, shape (rings + 1,), the first 0."""
    points, ends = edges[:-1, None], edges[None, 1:]
    within = ends > points
    traction = np.sqrt(np.where(within, ends**2 - points**2, 0.0))
    share = np.where(within, points, ends) / np.where(within, ends, points)
    angle = np.where(within, 0.5 * np.pi, np.arcsin(share))
    rest = np.where(within, 0.0, np.sqrt(1.0 - share**2))
    displaced = (2.0 / np.pi) * ((ends**2 - 0.5 * points**2) * angle + 0.5 * ends * points * rest)
    inverse = np.linalg.inv(traction)
    compliance = displaced @ inverse
    lower, upper = (np.asarray(np.linalg.inv(each), float) for each in factors(compliance))
    return Rings(edges[:-1], compliance, lower, upper, edges[1:] ** 3 @ inverse)


def settle(table: Rings, aim: Array, limit: Array, stuck: Mask, sense: Array) -> Array:
    """Return tractions that obey Coulomb's law at every point, shape (impacts, rings)."""
    # A ring that sticks is displaced by ``aim``. A ring that slips has the traction ``limit`` along
    # its slip, aim less displacement. ``stuck`` and ``sense`` hold a first guess of the division,
    # and then the division of the answer.
    traction, every = np.empty(aim.shape), np.arange(len(aim))
    left: slice | Places = slice(None)  # views are cheaper than copies, and most steps need one try
    slack = ROUNDING * (float(limit.max()) + float(np.abs(aim).max()))
    largest = limit + slack
    for tried in range(MOST_TRIES):
        still, sign, wanted = stuck[left], sense[left], aim[left]
        pulls = _divide(table, wanted, limit, still, sign)
        slip = wanted - pulls @ table.compliance.T
        wrong = np.where(still, np.abs(pulls) > largest, slip * sign < -slack)
        if tried >= GENTLE:  # one at a time, the outermost first
            last = wrong.shape[1] - 1 - wrong[:, ::-1].argmax(axis=1)
            wrong &= np.arange(wrong.shape[1]) == last[:, None]
        sense[left] = np.where(wrong & still, np.sign(pulls), sign)
        stuck[left] = still ^ wrong
        traction[left] = pulls
        if not wrong.any():
            return traction
        left = every[left][wrong.any(axis=1)]
    raise RuntimeError(f"{every[left].size} impacts: no division into stick and slip was found")


def _divide(table: Rings, aim: Array, limit: Array, stuck: Mask, sense: Array) -> Array:
    """Return the tractions of prescribed divisions, shape (impacts, rings)."""
    traction = np.where(stuck, 0.0, sense * limit)
    rest = aim - traction @ table.compliance.T
    discs = np.logical_and.reduce(stuck[:, :-1] >= stuck[:, 1:], axis=1)
    held = np.where(stuck, (np.where(stuck, rest, 0.0) @ table.lower.T), 0.0) @ table.upper.T
    if discs.all():
        return np.where(stuck, held, traction)
    traction = np.where(stuck & discs[:, None], held, traction)
    others = np.flatnonzero(~discs)
    patterns, which = np.unique(np.packbits(stuck[others], axis=1), axis=0, return_inverse=True)
    for k in range(len(patterns)):
        rows = others[which.ravel() == k]
        ours = np.flatnonzero(stuck[rows[0]])
        block = table.compliance[np.ix_(ours, ours)]
        traction[np.ix_(rows, ours)] = np.linalg.solve(block, rest[np.ix_(rows, ours)].T).T
    return traction
