"""All steps of one impact: step by step at the edge of stick, with the tests in blocks.

Almost always the inner annuli stick and the outer annuli slip in one direction. Then a step is one
small product, and two scalar tests at the edge give the number of annuli that stick: of the
outermost annulus that sticks (36) and of the innermost that slips (37). After a block of such steps
all annuli are tested together. The steps before the first failure are kept. The division of the
step that failed is searched by flips of all its violators, as in ``step.advance``. The result is
that of step by step, at a fraction of the calls.
"""

from __future__ import annotations

import numpy as np

from contactlab.numeric.types import Array
from contactlab_laws.annulus.step import MOST_PASSES, TIE
from contactlab_laws.annulus.tables import Tables, hertz_pressure, response
from contactlab_laws.jaeger.all_steps import ScaledSteps

#: Least and most steps in a block, which grows while no test fails.
SHORTEST, LONGEST = 4, 128
#: Moves of the edge in one step; more are left to the search.
MOST_MOVES = 12
#: Divisions tried on a block before its first step is tried alone.
MOST_TRIES = 2


class BlockMarch:
    """The march of one impact. Row k of an array is step k; row 0 of lags and tractions is touch.

    ``velocity`` is the slip velocity at first touch, in m/s (``steps`` are scaled).
    """

    def __init__(self, table: Tables, steps: ScaledSteps, velocity: float) -> None:
        count, size = len(steps.radius), len(table.weight)
        limits = hertz_pressure(table, steps.radius)
        limits *= steps.pressure[:, None]
        self.table, self.steps, self.velocity, self.limits = table, steps, velocity, limits
        self.touching_at = np.count_nonzero(limits, axis=1).tolist()
        self.drifts, self.kicks = steps.drift.tolist(), steps.kick.tolist()
        self.lags, self.tractions = np.zeros((count + 1, size)), np.zeros((count + 1, size))
        self.answers = np.zeros((count, size + 1))
        self.signs, self.touching = np.zeros(size), 0  # the division, as in ``step.ContactStates``
        self.at, self.total, self.change = 0, 0.0, 0.0

    @property
    def forces(self) -> Array:
        """F^ of the steps taken."""
        return self.answers[: self.at, 0]

    def march(self) -> bool:
        """Take all steps; return whether each has a division that passes the tests."""
        count, length, tries = len(self.answers), SHORTEST, 0
        while self.at < count:
            if tries > MOST_PASSES:
                return False
            edge, until = self._edge(), min(self.at + length, count)
            if tries > MOST_TRIES:
                edge, until = None, self.at + 1
            kept = self._by_division(until) if edge is None else self._by_edge(until, *edge)
            length = min(2 * length, LONGEST) if self.at == until else SHORTEST
            tries = 0 if kept else tries + 1
        return True

    def friction_work(self) -> float:
        """Return the work of the mean tractions on the slips of all steps taken."""
        slips = self.lags[: self.at] - self.lags[1 : self.at + 1]
        means = self.tractions[: self.at] + self.tractions[1 : self.at + 1]
        return 0.5 * float(np.einsum("ij,ij,j->", means, slips, self.table.weight))

    def _edge(self) -> tuple[int, float] | None:
        """Return the number of leading annuli that stick and the sign of slip, or None."""
        touching = self.touching
        signs = self.signs[:touching]
        slipping = signs.nonzero()[0]
        if not len(slipping):
            return touching, 1.0
        first, sign = slipping.item(0), signs.item(-1)
        return (
            (first, sign)
            if len(slipping) == touching - first and (signs[first:] == sign).all()
            else None
        )

    def _by_edge(self, until: int, stuck: int, sign: float) -> int:
        """Take steps up to ``until`` by the tests at the edge; return how many were kept."""
        at, answers, responses = self.at, self.answers, self.table.responses
        touching = self.touching
        before, lag = self.lags[at], self.lags[at].copy()
        rows = np.empty((until - at, answers.shape[1]))
        np.multiply(self.limits[at:until], sign, out=rows[:, 1:])
        totals, changes, edges, slip_signs = [self.total], [self.change], [], []
        for k, now, row, limit, answer in zip(
            range(at, until),
            self.touching_at[at:until],
            rows,
            self.limits[at:until],
            answers[at:until],
            strict=True,
        ):
            total = totals[-1] + (self.velocity + changes[-1]) * self.drifts[k]
            filled = stuck  # annuli whose lag is in ``lag``
            stuck = now if stuck == touching else min(stuck, now)
            if filled < stuck:
                lag[filled:stuck] = before[filled:stuck]
                filled = stuck
            row[0], row[1 : stuck + 1] = total, lag[:stuck]
            for _ in range(MOST_MOVES):
                row.dot(responses[stuck], out=answer)
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
                lag_before = (lag if stuck < filled else before).item(stuck)
                if sign * (lag_before - answer.item(stuck + 1)) > 0.0:
                    break
                lag[stuck] = row[stuck + 1] = lag_before
                stuck += 1
                filled = max(filled, stuck)
            else:
                break  # not a matter of the edge alone
            before, touching = answer[1:], now
            totals.append(total)
            changes.append(changes[-1] - self.kicks[k] * answer.item(0))
            edges.append(stuck)
            slip_signs.append(sign)
        if not edges:
            self.signs[: self.touching] = 0.0  # the next try begins with stick all over
            return 0
        rows = rows[: len(edges)]
        inner = np.arange(len(lag)) < np.array(edges)[:, None]
        return self._test(
            rows, np.where(inner, 0.0, np.array(slip_signs)[:, None]), totals, changes
        )

    def _by_division(self, until: int) -> int:
        """Take steps up to ``until`` with the present division; return how many were kept."""
        at, signs, touching = self.at, self.signs, self.touching
        signs[touching:] = signs[touching - 1]
        if not signs[-1]:  # new annuli stick where they are: the block ends before them
            until = next((k for k in range(at, until) if self.touching_at[k] > touching), until)
            signs[touching:] = 1.0
        if until == at:
            self.touching = self.touching_at[at]
            signs[touching : self.touching] = 0.0
            until = at + 1
        sticks = signs == 0.0
        matrix = response(len(signs), self.table.mean, sticks.tobytes())
        rows = np.zeros((until - at, self.answers.shape[1]))
        np.multiply(self.limits[at:until], signs, out=rows[:, 1:])
        np.copyto(rows[:, 1:], self.lags[at], where=sticks)
        totals, changes = [self.total], [self.change]
        for k, rest in enumerate(rows.dot(matrix[:, 0]).tolist(), at):
            totals.append(totals[-1] + (self.velocity + changes[-1]) * self.drifts[k])
            force = matrix.item(0) * totals[-1] + rest
            changes.append(changes[-1] - self.kicks[k] * force)
        rows[:, 0] = totals[1:]
        self.answers[at:until] = rows.dot(matrix)
        return self._test(rows, np.tile(signs, (len(rows), 1)), totals, changes)

    def _test(self, rows: Array, signs: Array, totals: list[float], changes: list[float]) -> int:
        """Enter a block of steps, whose ``rows`` hold D and the drives; return how many pass."""
        at, until = self.at, self.at + len(rows)
        drive, answer, limits = rows[:, 1:], self.answers[at:until, 1:], self.limits[at:until]
        sticks, ends = signs == 0.0, slice(at + 1, until + 1)
        self.lags[ends] = np.where(sticks, drive, answer)
        self.tractions[ends] = np.where(sticks, answer, drive)
        good = signs * (self.lags[at:until] - self.lags[ends]) > 0.0
        good |= limits == 0.0
        np.copyto(good, np.abs(answer) <= TIE * limits, where=sticks)
        first = int(good.argmin())
        kept = len(good) if good.flat[first] else first // good.shape[1]
        self.at, self.total, self.change = at + kept, totals[kept], changes[kept]
        if kept == len(good):
            self.signs, self.touching = signs[-1].copy(), self.touching_at[self.at - 1]
        else:  # for the next try, all violators of the step that failed are flipped
            begins = np.where(sticks[kept], np.sign(answer[kept]), 0.0)
            self.signs = np.where(good[kept], signs[kept], begins)
            self.touching = self.touching_at[self.at]
        return kept
