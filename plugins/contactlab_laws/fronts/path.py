"""The path of one planar impact from event to event (theory §§5 and 14); a sphere's is one.

The contact is the sphere's, its memory the same: a stack of pieces, the outermost last. A piece
was drawn while all stuck, or locked out of slip of one sign. Slip eats the pieces from outside.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import chain
from typing import NamedTuple, TypeAlias

import numpy as np

from contactlab_laws.fronts.compiled import OUTGROWN, UNSETTLED
from contactlab_laws.fronts.phases import DRAWN, GROSS, LOCKED, STICK, first_fall, step
from contactlab_laws.fronts.series import Laws, Rows, value
from contactlab_laws.hertz.motion import scale_motion, velocity_factor

#: Where slip or stick ends with a smaller V, it ends with maximum compression.
AT_REST = 1e-14
#: 1 + s lam from which the time of gross slip is Hertz's; below it the difference of two such times
#: would cancel.
SHALLOW = 0.01


class Drawn(NamedTuple):
    """Drawn while all stuck: u, V, k, J at its outer end, for slip of one sign; length in x."""

    sign: int
    outer: tuple[float, ...]
    length: float


class Locked(NamedTuple):
    """Locked out of slip of one sign, from radius ``inner`` to ``outer``, at one J."""

    sign: int
    lack: float
    inner: float
    outer: float


class _LostError(Exception):
    """The impact has no answer, for the reason that its argument, a status, says."""


#: A part of the path, which returns the one after it.
Part: TypeAlias = "Callable[[], Part | None]"


class Impact:
    """One planar impact: its state, its memory, and a method for each of its parts.

    Parameters
    ----------
    psi1, chi, lam, eta : float
        The parameters of theory §14; lam and eta of spheres are zero.
    tolerance : float
        Error of a step.
    most : int
        Steps after which the impact is given up.
    shown : list, optional
        Where each step is kept as a row of numbers: those of ``contactlab_impact_step``.

    Attributes
    ----------
    radius, rate, margin, lack : float
        u, V, k and J.
    change : float
        psi - psi1.
    work : float
        Friction work over 2.5 mu² v1²/(2 kappa W_nn).
    time, deepest : float
        T, and the greatest u so far.
    compressions, steps : int
        How often the approach grew; steps.
    """

    def __init__(
        self,
        psi1: float,
        chi: float,
        lam: float = 0.0,
        eta: float = 0.0,
        *,
        tolerance: float,
        most: int,
        shown: list[list[float]] | None = None,
    ) -> None:
        self.numbers, self.tolerance = (chi, lam, eta), tolerance
        self.most, self.shown = most, shown
        self.radius, self.rate, self.lack = 0.0, 1.0, 0.0
        self.change = self.time = self.work = self.deepest = 0.0
        self.sign = 1 if psi1 >= 0.0 else -1
        self.laws = Laws.of(self.sign, *self.numbers)
        self.margin = 1.0 - abs(psi1)
        self.memory: list[Drawn | Locked] = []
        self.compressions, self.steps, self.phases = 1, 0, 0

    def follow(self) -> int:
        """Follow the impact to separation; return its status, a place of ``compiled.LOST``."""
        slips = self.margin < 0.0 or (self.margin == 0.0 and self.laws.drive <= 0.0)
        part: Part | None = self._gross if slips else self._stick
        try:
            while part is not None:
                part = part()
        except _LostError as lost:
            return int(lost.args[0])
        except ArithmeticError:
            return OUTGROWN
        return 0

    def ends(self) -> tuple[float, ...]:
        """Return the end of the impact, as ``compiled.follow`` does."""
        left = self.rate, self.change, self.work, self.time, self.deepest
        return (*left, self.compressions, self.steps)

    # ---------------------------------------------------------------------------- the parts

    def _stick(self) -> Part:
        """All sticks; the edge begins to slip where k, or k of the other sign, is zero."""
        event, (_, length) = self._follow_phase(STICK, (self.radius, 0.0))
        if abs(self.rate) < AT_REST:
            self.rate = 0.0
            event = int(self._at_rest())
        if event == 1:
            self._turn()
        self.margin = 0.0
        outer = (self.radius, self.rate, 0.0, self.lack)
        self.memory.append(Drawn(self.sign, outer, length))
        return self._slip()

    def _draw_back(self) -> Part:
        """Let the front run back along a piece that was drawn while all stuck."""
        piece = self.memory[-1]
        assert isinstance(piece, Drawn)
        *then, self.lack = piece.outer
        event, (front, rate, margin, left) = self._follow_phase(DRAWN, (*then, piece.length))
        self.memory[-1] = Drawn(piece.sign, (front, rate, margin, self.lack), left)
        return self._after(event, front)

    def _slip_back(self) -> Part:
        """Let the front run back through a zone that locked out of slip of the other sign."""
        piece = self.memory[-1]
        assert isinstance(piece, Locked)
        self.lack = (4.0 / 3.0) * piece.outer**3 - piece.lack
        event, (front,) = self._follow_phase(LOCKED, (piece.outer,), piece.inner)
        self.memory[-1] = piece._replace(outer=front)
        return self._after(event, front)

    def _gross(self) -> Part | None:
        """All slips, J = 0: V² + (1 + s lam) zeta^2.5 is constant, and k rises as V falls."""
        press, _, drive, _ = self.laws
        rate, margin, depth = self.rate, self.margin, self.radius**5
        self.lack = 0.0
        left = rate * rate + press * depth
        end = -math.sqrt(left) if left >= 0.0 else math.nan
        stop, after, stops = math.inf, 0.0, False
        if drive > 0.0:
            stop = rate + margin * press / drive
            after = depth - margin * (rate + stop) / drive
            # where press is negative V grows, through zero if it can
            turns = press <= 0.0 and (left < 0.0 or rate >= 0.0)
            stops = turns or (after > 0.0 and (press > 0.0 or stop < 0.0))
        last = stop if stops else end
        if stops:
            fall, work, rise = rate - last, 0.4 * margin * margin / drive, -margin
        else:
            # over press, which may be zero; in unloading the difference would cancel
            share = -depth / (rate + last) if rate < 0.0 else (rate - last) / press
            fall, rise, after = press * share, drive * share, 0.0
            work = 0.8 * share * (-margin - 0.5 * drive * share)
        radius, change = max(after, 0.0) ** 0.2, self.change - self.sign * (fall + rise)
        if press > SHALLOW and self.shown is None:
            self.time += _hertz_time(press, left, (self.radius, radius), (rate, last))
            if rate > 0.0 >= last:
                self.deepest = max(self.deepest, (left / press) ** 0.2)
        elif depth > 0.0 or rate > 0.0:
            self._follow_phase(GROSS, (0.0, 0.0), stops)
        self.radius, self.rate, self.margin = radius, last, margin + rise
        self.change, self.work = change, self.work + work
        self.deepest = max(self.deepest, radius)
        return self._stop() if stops else None

    # --------------------------------------------------------------------- what comes after

    def _after(self, event: int, front: float) -> Part:
        """Return the part after slip stops, a piece is spent, or the edge meets the front."""
        if event == 0:
            return self._stop(front)
        if event == 1:
            self.memory.pop()
        else:
            self.radius = front
            self._turn()
        return self._slip()

    def _slip(self) -> Part:
        """Let the edge slip into the outermost piece; without any all slips."""
        memory = self.memory
        while memory and isinstance(memory[-1], Locked) and memory[-1].sign == self.sign:
            memory.pop()  # one zone, which slips as a whole
        if not memory:
            return self._gross
        piece = memory[-1]
        if isinstance(piece, Locked):
            return self._slip_back
        if piece.sign != self.sign:
            u, V, k, J = piece.outer
            outer = (u, V, 2.0 * V - k, (4.0 / 3.0) * u**3 - J)
            memory[-1] = Drawn(self.sign, outer, piece.length)
        return self._draw_back

    def _stop(self, front: float = 0.0) -> Part:
        """Lock the zone whose slip stopped. In unloading the edge slips on with the other sign."""
        self.margin = 0.0
        self.memory.append(Locked(self.sign, self.lack, front, self.radius))
        if self.rate > AT_REST:
            return self._stick
        self.rate = min(self.rate, 0.0)
        self._turn()
        return self._slip()

    def _turn(self) -> None:
        """Swap the sign of slip."""
        self.sign = -self.sign
        self.laws = Laws.of(self.sign, *self.numbers)
        self.margin = 2.0 * self.rate - self.margin
        self.lack = (4.0 / 3.0) * self.radius**3 - self.lack

    def _at_rest(self) -> bool:
        """Return whether the other sign's edge slips where V, k and psi are all zero.

        The traction at the edge has the sign that psi had before: s if V' < k'.
        """
        press, relief, drive, spring = self.laws
        turns: bool = (drive + press) * self.radius**3 < (spring + relief) * self.lack
        return turns

    # ------------------------------------------------------------------------------ phases

    def _follow_phase(
        self, phase: int, own: tuple[float, ...] = (), end: float = 0.0
    ) -> tuple[int, list[float]]:
        """Follow a phase; return the event that ended it, and the series of this phase alone."""
        state = [self.radius, self.rate, self.margin, self.lack, *own, self.time]
        change, psi, event = self.change, self.rate - self.margin, -1
        while event < 0:
            if self.steps >= self.most:
                raise _LostError(UNSETTLED)
            made = step(phase, self.laws, state, end, self.tolerance)
            if made is None:
                raise _LostError(OUTGROWN)
            rows, length, event, work = made
            self._show(phase, rows, length)
            before, state = state, [value(row, length) for row in rows]
            self.deepest = max(self.deepest, before[0], state[0])
            if before[1] > 0.0 >= state[1]:
                top, _ = first_fall([(rows[1], False)], length)
                self.deepest = max(self.deepest, value(rows[0], top))
            self.compressions += before[1] <= 0.0 < state[1]
            self.steps, self.work = self.steps + 1, self.work + work
            self.change = change + self.sign * (state[1] - state[2] - psi)
        self.phases += 1
        self.radius, self.rate, self.margin, self.lack = state[:4]
        self.time = state[-1]
        return event, state[4:-1]

    def _show(self, phase: int, rows: Rows, length: float) -> None:
        """Keep a step, if steps are kept."""
        if self.shown is not None:
            head = (self.phases, phase, self.sign, self.change, self.work, length)
            self.shown.append([*head, *chain(*rows[:5], rows[-1])])


def _hertz_time(press: float, left: float, *ends: tuple[float, float]) -> float:
    """Return T between two u and V of gross slip, where V² + ``press`` u⁵ is ``left``."""
    top, speed = (left / press) ** 0.2, math.sqrt(left)
    radius, rate = np.array(ends[0]) / top, np.array(ends[1]) / speed
    begin, end = scale_motion(np.arctan2(radius, rate / velocity_factor(radius)))[2]
    return float(top * top / speed * (end - begin))
