"""psi2 with Coulomb's law at every point, by rings of an axisymmetric contact.

The traction is q(r) = sum a_i sqrt(e_i² - r²) over the edges e_i of rings, theory §9 "Basis". The
displacement that it makes is known in closed form inside and outside of e_i. On the inner edge of
every ring Coulomb's law holds: abs(q) <= p. Where abs(q) < p the ring sticks, where abs(q) = p the
ring slips along q.

All quantities are dimensionless, with any unit of length r0. Slip displacements are in units of
mu r0²/(kappa R), time in units of r0²/(R v1), the friction load in units of what Hertz's contact of
radius r0 carries, (4/3) E* r0³/R, and the impulse of the friction load in units of M_n v1.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

#: Tolerance of a traction above its limit, and of a slip against its traction, over the largest.
ROUNDING = 1e-11
#: Most divisions tried in a step; beyond ``GENTLE`` one ring at a time is changed.
MOST_TRIES, GENTLE = 400, 20


class Course(NamedTuple):
    """A normal motion at instants at which the contact ends on an edge of a ring.

    Attributes
    ----------
    edges : array, shape (rings + 1,)
        Radii, from 0 to the largest contact.
    inside : array of int, shape (K + 1,)
        Rings within the contact at each instant, from first touch to separation. After first
        touch the number changes by at most one.
    time, load, impulse : array, shape (K + 1,)
        Since first touch; the friction load and its integral.
    """

    edges: Array
    inside: NDArray[np.int64]
    time: Array
    load: Array
    impulse: Array


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
    lower, upper = (np.asarray(np.linalg.inv(each), float) for each in _factors(compliance))
    return Rings(edges[:-1], compliance, lower, upper, edges[1:] ** 3 @ inverse)


def _factors(matrix: Array) -> tuple[Array, Array]:
    """Return the triangular factors of a matrix, without pivoting."""
    upper, lower = matrix.copy(), np.eye(len(matrix))
    for k in range(len(matrix) - 1):
        lower[k + 1 :, k] = upper[k + 1 :, k] / upper[k, k]
        upper[k + 1 :] -= np.outer(lower[k + 1 :, k], upper[k])
    return lower, np.triu(upper)


class History(NamedTuple):
    """Velocities, slips and shares of Coulomb's limit at the instants of a course.

    Attributes
    ----------
    psi : array, shape (K + 1, impacts)
        Tangential velocity.
    moved : array, shape (K, impacts)
        Slip displacement of each step.
    share, centre : array, shape (K + 1, impacts)
        Share of Coulomb's limit that acts, from -1 to 1: in the force, and in the traction at
        the centre.
    """

    psi: Array
    moved: Array
    share: Array
    centre: Array


def rebound(psi1: Array, chi: Array, course: Course) -> Array:
    """Return psi2 of impacts that share a normal motion, shape (impacts,)."""
    return np.asarray(march(psi1, chi, course).psi[-1])


def march(psi1: Array, chi: Array, course: Course) -> History:
    """Return the history of impacts that share a normal motion; RuntimeError without division."""
    # In every step the share of Coulomb's limit that acts, F/(mu P), is linear in the impulse of
    # the friction load, so that gross slip is exact. Each step is solved twice: first with the
    # share at its start, then with the shares at both ends.
    table, steps = rings(course.edges), np.diff(course.time)
    psi = np.empty((len(steps) + 1, len(psi1)))
    moved, shares, centre = (
        np.empty((len(steps), len(psi1))),
        np.zeros(psi.shape),
        np.zeros(psi.shape),
    )
    psi[0] = psi1
    displaced = np.zeros((len(psi1), len(table.points)))
    stuck, sense = np.ones(displaced.shape, dtype=bool), np.zeros(displaced.shape)
    share, begun = np.zeros(len(psi1)), False
    for k, duration in enumerate(steps):
        gain = 2.0 * chi * (course.impulse[k + 1] - course.impulse[k])
        number, load = int(course.inside[k + 1]), float(course.load[k + 1])
        after = share
        moved[k] = duration * (psi[k] - 0.5 * gain * share)
        if number and load > 0.0:
            ours, edge = table.within(number), course.edges[number]
            limit = load / edge**3 * np.sqrt(edge**2 - ours.points**2)
            part = slice(None), slice(number)
            for _ in range(2):
                if not begun:
                    share = after  # force and load begin in proportion
                moved[k] = duration * (psi[k] - gain * (share / 3.0 + after / 6.0))
                aim = displaced[part] + moved[k][:, None]
                traction = settle(ours, aim, limit, stuck[part], sense[part])
                after = traction @ ours.weights / load
            displaced = traction @ table.compliance[:, :number].T
            centre[k + 1] = traction[:, 0] / limit[0]
            share = share if begun else after
            begun = True
        psi[k + 1] = psi[k] - 0.5 * gain * (share + after)
        share = shares[k + 1] = after
    return History(psi, moved, shares, centre)


def settle(table: Rings, aim: Array, limit: Array, stuck: Mask, sense: Array) -> Array:
    """Return tractions that obey Coulomb's law at every point, shape (impacts, rings)."""
    # A ring that sticks is displaced by ``aim``. A ring that slips has the traction ``limit`` along
    # its slip, aim less displacement. ``stuck`` and ``sense`` hold a first guess of the division,
    # and then the division of the answer.
    traction, every = np.empty(aim.shape), np.arange(len(aim))
    left: Any = slice(None)  # views are cheaper than copies, and most steps need one try
    slack = ROUNDING * (float(limit.max()) + float(np.abs(aim).max()))
    largest = limit + slack
    for tried in range(MOST_TRIES):
        still, sign, wanted = stuck[left], sense[left], aim[left]
        pulls = _divided(table, wanted, limit, still, sign)
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
    raise RuntimeError(f"{left.size} impacts: no division into stick and slip was found")


def _divided(table: Rings, aim: Array, limit: Array, stuck: Mask, sense: Array) -> Array:
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
