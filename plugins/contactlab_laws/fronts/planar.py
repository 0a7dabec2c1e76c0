"""The planar eccentric impact, followed from event to event by Taylor series (theory §14).

The contact is the sphere's, its memory the same: a stack of pieces, the outermost last. A piece
was drawn while all stuck, or locked out of slip of one sign. Slip eats the pieces from outside.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from contactlab_laws.fronts.series import (
    ORDER,
    Laws,
    Series,
    along_drawn,
    along_locked,
    first_fall,
    stuck,
    value,
)

#: A series is followed as far as its last two terms stay below the tolerance, times this.
CAREFUL = 0.9
#: Longest step: beyond it forces turn more than events are looked for.
LONGEST = 1.0
#: Error of a step over its velocity that is rounding: a jam may multiply velocities by 1e8.
ROUNDING = 1e-14
#: Steps of an impact before it is given up; a hard one takes 40, one of kappa = 1e6 some 10,000.
MOST_STEPS = 20_000


class Drawn(NamedTuple):
    """Drawn while all stuck: u, V, k, J at its outer end, for slip of one sign; length in x."""

    sign: int
    outer: tuple[float, float, float, float]
    length: float


class Locked(NamedTuple):
    """Locked out of slip of one sign, from radius ``inner`` to ``outer``, at one J."""

    sign: int
    lack: float
    inner: float
    outer: float


class LostError(ArithmeticError):
    """The impact does not end."""


Phase = Callable[[], Any]
#: Called with T, u, V, psi and F/(mu P_max) at instants of the impact.
Watch = Callable[[float, float, float, float, float], object]


class Impact:
    """One planar impact: its state, its memory, and a method for each phase.

    Parameters
    ----------
    psi1, chi, lam, eta : float
        The parameters of theory §14.
    tolerance : float
        Error of the scaled velocities in a step.
    watch : callable, optional
        Sees the instants.

    Attributes
    ----------
    rate, change : float
        V, and the change of psi so far.
    work : float
        Friction work over 2.5 mu² v1²/(2 kappa W_nn).
    time, radius, deepest : float
        T, u and the greatest u so far.
    compressions : int
        How often the approach grew.
    """

    def __init__(
        self,
        psi1: float,
        chi: float,
        lam: float,
        eta: float,
        tolerance: float,
        watch: Watch | None = None,
    ) -> None:
        self.numbers, self.tolerance, self.watch = (chi, lam, eta), tolerance, watch
        self.psi1 = psi1
        self.radius, self.rate, self.lack = 0.0, 1.0, 0.0
        self.time = self.work = self.deepest = 0.0
        self.sign = 1 if psi1 >= 0.0 else -1
        self.laws = Laws.of(self.sign, *self.numbers)
        self.margin = 1.0 - abs(psi1)
        self.memory: list[Drawn | Locked] = []
        self.steps, self.compressions = 0, 1

    def follow(self) -> Impact:
        """Return this impact at separation.

        Raises
        ------
        LostError
            If it does not end in ``MOST_STEPS``.
        """
        slips = self.margin < 0.0 or (self.margin == 0.0 and self.laws.drive <= 0.0)
        phase: Phase | None = self._gross if slips else self._stuck
        while phase is not None:
            phase = phase()
        return self

    @property
    def change(self) -> float:
        """The change of psi so far."""
        return self.sign * (self.rate - self.margin) - self.psi1

    # ---------------------------------------------------------------------------- the phases

    def _stuck(self) -> Phase:
        """All sticks; the edge begins to slip where k, or its like of the other sign, is zero."""
        length, fresh = 0.0, self.margin == 0.0
        while True:
            rows = stuck(self.laws, self.radius, self.rate, self.margin, self.lack)
            other = [2.0 * V - k for V, k in zip(rows[1], rows[2], strict=True)]
            t, event = self._step(rows[:4], [(rows[2], fresh), (other, False)])
            self._arrive(rows[:3], t)
            self._look(rows, t)
            self.lack, self.time = value(rows[3], t), self.time + value(rows[4], t)
            length, fresh = length + t, False
            if event >= 0:
                break
        if event == 1:
            self._turn()
        self.margin = 0.0
        outer = (self.radius, self.rate, 0.0, self.lack)
        self.memory.append(Drawn(self.sign, outer, length))
        return self._slip

    def _drawn(self) -> Phase:
        """Let the front run back along a piece that was drawn while all stuck."""
        piece = self.memory[-1]
        assert isinstance(piece, Drawn)
        then, left = piece.outer, piece.length
        meets = then[0] == self.radius
        while True:
            fresh = self.margin == 0.0 and then[2] == 0.0
            now = (self.radius, self.rate, self.margin)
            rows = along_drawn(self.laws, now, then, fresh=fresh)
            rows[7][0] = left
            slip, gap = (
                [-k for k in rows[2]],
                [u - c for u, c in zip(rows[0], rows[3], strict=True)],
            )
            begins = self.margin == 0.0
            t, event = self._step(rows[:8], [(slip, begins), (rows[7], False), (gap, meets)])
            self._arrive(rows[:3], t)
            self._look([*rows[:3], rows[6], rows[8]], t)
            front, *others, left = (value(row, t) for row in rows[3:8])
            then = (front, others[0], others[1], others[2])
            self.lack = then[3]
            self.time, self.work = self.time + value(rows[8], t), self.work + value(rows[9], t)
            meets = False
            if event >= 0:
                break
        if event == 1:
            self.memory.pop()
            return self._slip
        self.memory[-1] = Drawn(piece.sign, then, left)
        return self._stopped(front) if event == 0 else self._caught(front)

    def _locked(self) -> Phase:
        """Let the front run back through a zone that locked out of slip of the other sign."""
        piece = self.memory[-1]
        assert isinstance(piece, Locked)
        front, base = piece.outer, -piece.lack
        meets = front == self.radius
        while True:
            now = (self.radius, self.rate, self.margin)
            rows = along_locked(self.laws, now, front, base)
            slip, gap = (
                [-k for k in rows[2]],
                [u - c for u, c in zip(rows[0], rows[3], strict=True)],
            )
            rest = [rows[3][0] - piece.inner, *rows[3][1:]]
            begins = self.margin == 0.0
            t, event = self._step(rows[:4], [(slip, begins), (rest, False), (gap, meets)])
            self._arrive(rows[:3], t)
            front = value(rows[3], t)
            self.lack = base + (4.0 / 3.0) * front**3
            self.time, self.work = self.time + value(rows[4], t), self.work + value(rows[5], t)
            if self.watch is not None:
                self._show(self.time, self.radius, self.rate, self.margin, self.lack)
            meets = False
            if event >= 0:
                break
        if event == 1:
            self.memory.pop()
            return self._slip
        self.memory[-1] = piece._replace(outer=front)
        return self._stopped(front) if event == 0 else self._caught(front)

    def _gross(self) -> Phase | None:
        """All slips, J = 0: V² + (1 + s lam) zeta^2.5 is constant, and k rises as V falls."""
        press, _, drive, _ = self.laws
        rate, margin, depth = self.rate, self.margin, self.radius**5
        self.lack = 0.0
        left = rate * rate + press * depth
        end = -math.sqrt(left) if left >= 0.0 else math.nan
        stop = math.inf
        if drive > 0.0:
            stop = rate + margin * press / drive
            # where press is negative V grows, through zero if it can
            turns = left < 0.0 or rate >= 0.0 or stop < end
            stops = stop > end if press > 0.0 else turns
        else:
            stops = False
        last = stop if stops else end
        after = depth - margin * (rate + stop) / drive if stops else 0.0
        if press > 0.0 and rate > 0.0 >= last:
            self.deepest = max(self.deepest, (left / press) ** 0.2)
        self.compressions += rate <= 0.0 < last
        fall = rate - last
        if stops:
            self.work += 0.4 * margin * margin / drive
        else:
            self.work += 0.8 * fall * (-margin - 0.5 * drive * fall / press) / press
            margin += drive * fall / press
        self._through(last, stops)
        self.rate, self.radius = last, max(after, 0.0) ** 0.2
        self.deepest = max(self.deepest, self.radius)
        self.margin = 0.0 if stops else margin
        return self._stopped(0.0) if stops else None

    def _through(self, last: float, stops: bool) -> None:
        """Add the time of gross slip until the rate is ``last``, and show the instants."""
        laws, k, event = self.laws, self.margin, -1
        excess = laws.drive / laws.press if laws.press else 0.0
        alone = laws._replace(drive=0.0, spring=0.0)  # then k and J stay zero
        falls = self.rate > last
        u, V, start = self.radius, self.rate, self.rate
        while event < 0 and last != V:
            rows = stuck(alone, u, V, 0.0, 0.0)
            ahead = [V - last, *rows[1][1:]] if falls else [last - V, *(-v for v in rows[1][1:])]
            t, event = self._step(rows[:2], [(ahead, False)] if stops else [(rows[0], u == 0.0)])
            for part in (0.25, 0.5, 0.75, 1.0) if self.watch is not None else ():
                u, V, time = (value(row, part * t) for row in (rows[0], rows[1], rows[4]))
                self._show(self.time + time, u, V, k + excess * (start - V), 0.0)
            u, V, time = (value(row, t) for row in (rows[0], rows[1], rows[4]))
            self.time += time

    # --------------------------------------------------------------------- what comes after

    def _slip(self) -> Phase:
        """Let the edge slip into the outermost piece; without any all slips."""
        memory = self.memory
        while memory and isinstance(memory[-1], Locked) and memory[-1].sign == self.sign:
            memory.pop()  # one zone, which slips as a whole
        if not memory:
            return self._gross
        piece = memory[-1]
        if isinstance(piece, Locked):
            return self._locked
        if piece.sign != self.sign:
            u, V, k, J = piece.outer
            outer = (u, V, 2.0 * V - k, (4.0 / 3.0) * u**3 - J)
            memory[-1] = Drawn(self.sign, outer, piece.length)
        return self._drawn

    def _stopped(self, front: float) -> Phase:
        """Slip has stopped: its zone locks. In unloading the edge slips on with the other sign."""
        self.margin = 0.0
        self.memory.append(Locked(self.sign, self.lack, front, self.radius))
        if self.rate > 0.0:
            return self._stuck
        self._turn()
        return self._slip

    def _caught(self, front: float) -> Phase:
        """Let the edge, which has met the front, slip with the other sign."""
        self.radius = front
        self._turn()
        return self._slip

    def _turn(self) -> None:
        """Look from the other sign of slip."""
        self.sign = -self.sign
        self.laws = Laws.of(self.sign, *self.numbers)
        self.margin = 2.0 * self.rate - self.margin
        self.lack = (4.0 / 3.0) * self.radius**3 - self.lack

    # ------------------------------------------------------------------------------ steps

    def _step(self, rows: list[Series], events: list[tuple[Series, bool]]) -> tuple[float, int]:
        """Return how far the series hold, or the first event within, and which."""
        length = LONGEST
        for row in rows:
            tolerance = max(self.tolerance, ROUNDING * abs(row[0]))
            for order in (ORDER, ORDER - 1):
                size = abs(row[order])
                if not size < math.inf:
                    raise LostError("The velocities of a jam outgrow the numbers")
                if size > 0.0:
                    length = min(length, (tolerance / size) ** (1.0 / order))
        self.steps += 1
        if self.steps > MOST_STEPS:
            raise LostError(f"The contact neither ends nor settles in {MOST_STEPS} steps")
        return first_fall(events, CAREFUL * length)

    def _arrive(self, rows: list[Series], t: float) -> None:
        """Take u, V and k at the end of a step."""
        before = self.rate
        self.radius, self.rate, self.margin = (value(row, t) for row in rows)
        if before > 0.0 >= self.rate:
            self.deepest = max(self.deepest, *(value(rows[0], t * j / 16) for j in range(17)))
        self.deepest = max(self.deepest, self.radius)
        self.compressions += before <= 0.0 < self.rate

    def _look(self, rows: list[Series], t: float) -> None:
        """Show u, V, k, J and T within a step."""
        if self.watch is not None:
            for part in (0.25, 0.5, 0.75, 1.0):
                *state, time = (value(row, part * t) for row in rows)
                self._show(self.time + time, *state)

    def _show(self, time: float, u: float, rate: float, margin: float, lack: float) -> None:
        """Show one instant."""
        if self.watch is not None:
            self.watch(time, u, rate, self.sign * (rate - margin), self.sign * (u**3 - 1.5 * lack))
