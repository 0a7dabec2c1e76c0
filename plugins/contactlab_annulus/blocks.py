"""A whole run of fixed steps, several at a time.

Between changes of the division into stick and slip the contact is linear: the force is
a multiple of the slip displacement D plus what the known limits give. So a block of steps is
taken with the division as it stands, by a recurrence of two numbers; all its tests (36), (37)
are made at once; and the steps before the first failure are kept. The division changes in
about every fifth step, so this gives what step by step gives at a fraction of the calls.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab_annulus import one
from contactlab_annulus.tables import Array, Tables, response

#: Steps in a block: it grows while no test fails.
SHORTEST, LONGEST = 12, 64
#: Divisions tried on one step before it is left to ``one.advance``, which knows when to give up.
MOST_TRIES = 8


class Course(NamedTuple):
    """The steps of a run in the paper's variables, shape (K,).

    ``drift`` takes the slip velocity to displacement, ``kick`` takes F^ to its change.
    """

    radius: Array
    pressure: Array
    drift: Array
    kick: Array


class Runner:
    """One run. The rows of its tables are the steps; row 0 is the state at first touch."""

    def __init__(self, table: Tables, course: Course, velocity: float) -> None:
        count, size = len(course.radius), len(table.weight)
        square = np.square(course.radius)[:, None] - table.radius_squared
        self.table, self.course, self.velocity = table, course, velocity
        self.limits = course.pressure[:, None] * np.sqrt(np.maximum(square, 0.0))
        self.outside = self.limits == 0.0
        self.reaches = np.count_nonzero(~self.outside, axis=1)
        self.drifts, self.kicks = course.drift.tolist(), course.kick.tolist()
        self.lags, self.tractions = np.zeros((count + 1, size)), np.zeros((count + 1, size))
        self.forces = np.zeros(count)
        self.signs = np.zeros(size)
        self.at, self.total, self.change = 0, 0.0, 0.0

    def run(self) -> bool:
        """Take all steps; return whether every division was found."""
        count, length, tries = len(self.forces), SHORTEST, 0
        while self.at < count:
            if tries > MOST_TRIES or not self.table.responses:
                if not self._step():
                    return False
                tries = 0
                continue
            reach = int(self.reaches[self.at])
            # A contact that has shrunk slips at its edge.
            if self.signs[:reach].any() or (self.at and reach < self.reaches[self.at - 1]):
                kept, length = self._block(min(self.at + length, count), reach)
            else:
                kept, length = self._grip(min(self.at + length, count))
            tries = 0 if kept else tries + 1
        return True

    def friction_work(self) -> float:
        """Return the work of the mean tractions on the slips of all steps taken."""
        slips = self.lags[: self.at] - self.lags[1 : self.at + 1]
        means = 0.5 * (self.tractions[: self.at] + self.tractions[1 : self.at + 1])
        return float(np.vdot(means * self.table.weight, slips))

    def _grip(self, until: int) -> tuple[int, int]:
        """Take steps in which the whole contact sticks, newcomers without traction."""
        at, table = self.at, self.table
        grip = table.grip[self.reaches[at:until]]
        totals, changes = [self.total], [self.change]
        force = float(table.weight.dot(self.tractions[at]))
        for k, stiffness in enumerate(grip.dot(table.weight).tolist(), at):
            move = (self.velocity + changes[-1]) * self.drifts[k]
            force += stiffness * move
            totals.append(totals[-1] + move)
            changes.append(changes[-1] - self.kicks[k] * force)
        steps = np.diff(totals)
        found = self.tractions[at] + np.cumsum(steps[:, None] * grip, axis=0)
        good = np.abs(found) <= self.limits[at:until]
        kept, wrong = _first_failure(good)
        here = slice(at + 1, at + 1 + kept)
        self.tractions[here] = found[:kept]
        self.lags[here] = (
            found[:kept] @ table.compliance.T - np.array(totals[1 : kept + 1])[:, None]
        )
        self.forces[at : at + kept] = found[:kept] @ table.weight
        self.at, self.total, self.change = at + kept, totals[kept], changes[kept]
        if kept < len(good):
            self.signs = np.where(wrong, np.sign(found[kept]), 0.0)
        return kept, min(2 * len(good), LONGEST) if kept == len(good) else SHORTEST

    def _block(self, until: int, reach: int) -> tuple[int, int]:
        """Take steps up to ``until`` with the division as it stands; return how many were kept."""
        at, signs = self.at, self.signs
        signs[reach:] = signs[reach - 1] if reach else 0.0
        sticks = signs == 0.0
        sticks[reach:] = False
        matrix = response(len(signs), sticks.tobytes())
        rows = np.empty((until - at, len(signs) + 1))
        rows[:, 0] = 0.0
        given = rows[:, 1:]
        np.multiply(self.limits[at:until], signs, out=given)
        np.copyto(given, self.lags[at], where=sticks)
        slope, total, change = matrix.item(0), self.total, self.change
        totals, changes = [], []
        knowns = rows.dot(matrix[:, 0]).tolist()
        for known, drift, kick in zip(
            knowns, self.drifts[at:until], self.kicks[at:until], strict=True
        ):
            total += (self.velocity + change) * drift
            change -= kick * (slope * total + known)
            totals.append(total)
            changes.append(change)
        rows[:, 0] = totals
        found = rows.dot(matrix)
        answer, here = found[:, 1:], slice(at + 1, until + 1)
        lags, tractions = self.lags[here], self.tractions[here]
        lags[...] = answer
        np.copyto(lags, given, where=sticks)
        tractions[...] = given
        np.copyto(tractions, answer, where=sticks)
        good = signs * (self.lags[at:until] - lags) > 0.0  # (37)
        good |= self.outside[at:until]
        np.copyto(good, np.abs(answer) <= self.limits[at:until], where=sticks)  # (36)
        kept, wrong = _first_failure(good)
        self.forces[at : at + kept] = found[:kept, 0]
        if kept:
            self.at, self.total, self.change = at + kept, totals[kept - 1], changes[kept - 1]
        if kept == len(good):
            return kept, min(2 * kept, LONGEST)
        begins = np.where(sticks, np.sign(answer[kept]), 0.0)
        self.signs = np.where(wrong, begins, signs)
        return kept, SHORTEST

    def _step(self) -> bool:
        """Take one step by itself."""
        at, course = self.at, self.course
        reach = int(self.reaches[at - 1]) if at else 0
        memory = one.Memory(self.total, self.lags[at], self.tractions[at], self.signs, reach)
        move = (self.velocity + self.change) * self.drifts[at]
        radius, pressure = float(course.radius[at]), float(course.pressure[at])
        force, _, settled, memory = one.advance(self.table, memory, move, radius, pressure)
        if settled:
            self.total, self.lags[at + 1], self.tractions[at + 1], self.signs, _ = memory
            self.forces[at] = force
            self.change -= self.kicks[at] * force
            self.at += 1
        return settled


def _first_failure(good: NDArray[np.bool_]) -> tuple[int, NDArray[np.bool_]]:
    """Return the number of rows before the first that fails, and where that one fails."""
    index = int(good.argmin())
    row = index // good.shape[1]
    return (len(good), good[0]) if good.flat[index] else (row, ~good[row])
