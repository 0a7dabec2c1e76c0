"""A whole run of fixed steps at once: step by step at the edge of stick, all tests in blocks.

Almost always the inner annuli stick and the outer ones slip in one direction. Then a step is one
small product, and what changes is the number that stick: it is followed by two scalar tests at
the edge, of the outermost annulus that sticks (36) and the innermost that slips (37). After
a block of such steps the tests of all annuli are made together. The steps before the first
failure are kept; the one that failed is searched in earnest, as are divisions of other
kinds. So the result is that of step by step, at a fraction of the calls.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab_annulus import one
from contactlab_annulus.tables import Array, Tables, response

#: Steps in a block: it grows while no test fails.
SHORTEST, LONGEST = 4, 128
#: Moves of the edge in one step; more are left to the search.
MOST_MOVES = 4
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
    """One run. Row k of its tables is step k; row 0 of lags and tractions is first touch."""

    def __init__(self, table: Tables, course: Course, velocity: float) -> None:
        count, size = len(course.radius), len(table.weight)
        limits = np.square(course.radius)[:, None] - table.radius_squared
        np.sqrt(np.maximum(limits, 0.0, out=limits), out=limits)
        limits *= course.pressure[:, None]
        self.table, self.course, self.velocity, self.limits = table, course, velocity, limits
        self.reaches = np.count_nonzero(limits, axis=1).tolist()
        self.drifts, self.kicks = course.drift.tolist(), course.kick.tolist()
        self.lags, self.tractions = np.zeros((count + 1, size)), np.zeros((count + 1, size))
        self.found = np.zeros((count, size + 1))
        self.signs, self.reach = np.zeros(size), 0  # the division, as in ``one.Memory``
        self.at, self.total, self.change = 0, 0.0, 0.0

    @property
    def forces(self) -> Array:
        """F^ of the steps taken."""
        return self.found[: self.at, 0]

    def run(self) -> bool:
        """Take all steps; return whether every division was found."""
        count, length, tries = len(self.found), SHORTEST, 0
        while self.at < count:
            if tries > MOST_TRIES or not self.table.responses:
                if not self._step():
                    return False
                tries = 0
                continue
            edge, until = self._edge(), min(self.at + length, count)
            kept = self._fixed(until) if edge is None else self._follow(until, *edge)
            length = min(2 * length, LONGEST) if self.at == until else SHORTEST
            tries = 0 if kept else tries + 1
        return True

    def friction_work(self) -> float:
        """Return the work of the mean tractions on the slips of all steps taken."""
        slips = self.lags[: self.at] - self.lags[1 : self.at + 1]
        means = self.tractions[: self.at] + self.tractions[1 : self.at + 1]
        return 0.5 * float(np.einsum("ij,ij,j->", means, slips, self.table.weight))

    def _edge(self) -> tuple[int, float] | None:
        """Return how many leading annuli stick and the sign of the rest, if that says it all."""
        reach = self.reach
        signs = self.signs[:reach]
        slipping = signs.nonzero()[0]
        if not len(slipping):
            return reach, 1.0
        first, sign = slipping.item(0), signs.item(-1)
        return (
            (first, sign)
            if len(slipping) == reach - first and (signs[first:] == sign).all()
            else None
        )

    def _follow(self, until: int, stuck: int, sign: float) -> int:
        """Take steps up to ``until`` by the tests at the edge; return how many were kept."""
        at, found, responses, reach = self.at, self.found, self.table.responses, self.reach
        before, lag = self.lags[at], self.lags[at].copy()
        rows = np.empty((until - at, found.shape[1]))
        np.multiply(self.limits[at:until], sign, out=rows[:, 1:])
        totals, changes, edges, senses = [self.total], [self.change], [], []
        for k, now, row, limit, answer in zip(
            range(at, until),
            self.reaches[at:until],
            rows,
            self.limits[at:until],
            found[at:until],
            strict=True,
        ):
            total = totals[-1] + (self.velocity + changes[-1]) * self.drifts[k]
            known = stuck  # annuli whose lag is in ``lag``
            stuck = now if stuck == reach else min(stuck, now)
            if known < stuck:
                lag[known:stuck] = before[known:stuck]
                known = stuck
            row[0], row[1 : stuck + 1] = total, lag[:stuck]
            for _ in range(MOST_MOVES):
                np.dot(row, responses[stuck], out=answer)
                if stuck and abs(answer.item(stuck)) > limit.item(stuck - 1):
                    if stuck == now and answer.item(stuck) * sign < 0.0:
                        sign = -sign
                        rows[k - at, stuck:] *= -1.0
                        rows[k - at + 1 :, 1:] *= -1.0
                    row[stuck] = sign * limit.item(stuck - 1)
                    stuck -= 1
                    continue
                if stuck == now:
                    break
                lag_before = (lag if stuck < known else before).item(stuck)
                if sign * (lag_before - answer.item(stuck + 1)) > 0.0:
                    break
                lag[stuck] = row[stuck + 1] = lag_before
                stuck += 1
                known = max(known, stuck)
            else:
                break  # not a matter of the edge alone
            before, reach = answer[1:], now
            totals.append(total)
            changes.append(changes[-1] - self.kicks[k] * answer.item(0))
            edges.append(stuck)
            senses.append(sign)
        if not edges:
            self.signs[: self.reach] = 0.0  # start the tries anew, from stick all over
            return 0
        rows = rows[: len(edges)]
        inner = np.arange(len(lag)) < np.array(edges)[:, None]
        return self._tested(rows, np.where(inner, 0.0, np.array(senses)[:, None]), totals, changes)

    def _fixed(self, until: int) -> int:
        """Take steps up to ``until`` with any division as it stands; return how many were kept."""
        at, signs, reach = self.at, self.signs, self.reach
        signs[reach:] = signs[reach - 1]
        if not signs[-1]:  # newcomers stick, from where they then are: not beyond this block
            until = next((k for k in range(at, until) if self.reaches[k] > reach), until)
            signs[reach:] = 1.0
        if until == at:
            self.reach = self.reaches[at]
            signs[reach : self.reach] = 0.0
            until = at + 1
        sticks = signs == 0.0
        matrix = response(len(signs), self.table.mean, sticks.tobytes())
        rows = np.zeros((until - at, self.found.shape[1]))
        np.multiply(self.limits[at:until], signs, out=rows[:, 1:])
        np.copyto(rows[:, 1:], self.lags[at], where=sticks)
        totals, changes = [self.total], [self.change]
        for k, known in enumerate(rows.dot(matrix[:, 0]).tolist(), at):
            totals.append(totals[-1] + (self.velocity + changes[-1]) * self.drifts[k])
            force = matrix.item(0) * totals[-1] + known
            changes.append(changes[-1] - self.kicks[k] * force)
        rows[:, 0] = totals[1:]
        self.found[at:until] = rows.dot(matrix)
        return self._tested(rows, np.tile(signs, (len(rows), 1)), totals, changes)

    def _tested(self, rows: Array, signs: Array, totals: list[float], changes: list[float]) -> int:
        """Enter a block of steps in the tables; keep and count those that pass (36) and (37)."""
        at, until = self.at, self.at + len(rows)
        given, answer, limits = rows[:, 1:], self.found[at:until, 1:], self.limits[at:until]
        sticks, here = signs == 0.0, slice(at + 1, until + 1)
        self.lags[here] = np.where(sticks, given, answer)
        self.tractions[here] = np.where(sticks, answer, given)
        good = signs * (self.lags[at:until] - self.lags[here]) > 0.0
        good |= limits == 0.0
        np.copyto(good, np.abs(answer) <= limits, where=sticks)
        first = int(good.argmin())
        kept = len(good) if good.flat[first] else first // good.shape[1]
        self.at, self.total, self.change = at + kept, totals[kept], changes[kept]
        if kept == len(good):
            self.signs, self.reach = signs[-1].copy(), self.reaches[self.at - 1]
        else:  # for the next try, all violators of the step that failed are flipped
            begins = np.where(sticks[kept], np.sign(answer[kept]), 0.0)
            self.signs = np.where(good[kept], signs[kept], begins)
            self.reach = self.reaches[self.at]
        return kept

    def _step(self) -> bool:
        """Take one step by the search for any division."""
        at, course = self.at, self.course
        memory = one.Memory(self.total, self.lags[at], self.tractions[at], self.signs, self.reach)
        move = (self.velocity + self.change) * self.drifts[at]
        radius, pressure = float(course.radius[at]), float(course.pressure[at])
        force, _, settled, memory = one.advance(self.table, memory, move, radius, pressure)
        if settled:
            self.total, self.lags[at + 1], self.tractions[at + 1], signs, self.reach = memory
            self.signs = signs.copy()
            self.found[at, 0] = force
            self.change -= self.kicks[at] * force
            self.at += 1
        return settled
