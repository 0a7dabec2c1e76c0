"""The path of one planar impact from event to event (theory §§5 and 14); a sphere's is one.

The contact is the sphere's, its memory the same: a stack of pieces, the outermost last. A piece
was drawn while all stuck, or locked out of slip of one sign. Slip eats the pieces from outside.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from typing import NamedTuple, TypeAlias

from contactlab_laws.fronts.phases import DRAWN, GROSS, HEAD, LAWS, LOCKED, STICK, Numbers, Phase
from contactlab_laws.fronts.series import Laws

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


#: A phase of which the path asks, with its numbers.
Request: TypeAlias = tuple[Phase, Numbers]
#: The event that ended it, with the numbers there.
Answer: TypeAlias = tuple[int, Numbers]
#: A stretch of the path, and the one after it.
Part: TypeAlias = Generator[Request, Answer, "Callable[[], Part] | None"]
Next: TypeAlias = Callable[[], Part]


class Impact:
    """One planar impact: its state, its memory, and a method for each of its parts.

    Parameters
    ----------
    psi1, chi, lam, eta : float
        The parameters of theory §14; lam and eta of spheres are zero.
    stepped : bool
        Whether gross slip is stepped, too, which has a closed form.

    Attributes
    ----------
    radius, rate, margin, lack : float
        u, V, k and J.
    change : float
        psi - psi1.
    work : float
        Friction work over 2.5 mu² v1²/(2 kappa W_nn).
    time, deepest : float
        T, but for the slides in ``slides``, and the greatest u so far.
    slides : list
        Gross slip in closed form: 1 + s lam, V² + (1 + s lam) u⁵, and u and V at both ends.
    compressions, steps : int
        How often the approach grew; steps.
    """

    def __init__(
        self, psi1: float, chi: float, lam: float = 0.0, eta: float = 0.0, *, stepped: bool = False
    ) -> None:
        self.numbers, self.stepped = (chi, lam, eta), stepped
        self.radius, self.rate, self.lack = 0.0, 1.0, 0.0
        self.change = self.time = self.work = self.deepest = 0.0
        self.sign = 1 if psi1 >= 0.0 else -1
        self.laws = Laws.of(self.sign, *self.numbers)
        self.margin = 1.0 - abs(psi1)
        self.memory: list[Drawn | Locked] = []
        self.slides: list[tuple[float, ...]] = []
        self.steps: float = 0
        self.compressions: float = 1

    def path(self) -> Generator[Request, Answer, None]:
        """Ask for the phases of the impact until separation."""
        slips = self.margin < 0.0 or (self.margin == 0.0 and self.laws.drive <= 0.0)
        part: Next | None = self._gross if slips else self._stuck
        while part is not None:
            part = yield from part()

    # ---------------------------------------------------------------------------- the parts

    def _stuck(self) -> Part:
        """All sticks; the edge begins to slip where k, or its like of the other sign, is zero."""
        event, (length,) = yield from self._along(STICK, (0.0,))
        if abs(self.rate) < AT_REST:
            self.rate = 0.0
            event = int(self._at_rest())
        if event == 1:
            self._turn()
        self.margin = 0.0
        outer = (self.radius, self.rate, 0.0, self.lack)
        self.memory.append(Drawn(self.sign, outer, length))
        return self._slip()

    def _drawn(self) -> Part:
        """Let the front run back along a piece that was drawn while all stuck."""
        piece = self.memory[-1]
        assert isinstance(piece, Drawn)
        *then, self.lack = piece.outer
        event, (front, rate, margin, left) = yield from self._along(DRAWN, (*then, piece.length))
        if event == 1:
            self.memory.pop()
            return self._slip()
        self.memory[-1] = Drawn(piece.sign, (front, rate, margin, self.lack), left)
        return self._stopped(front) if event == 0 else self._caught(front)

    def _locked(self) -> Part:
        """Let the front run back through a zone that locked out of slip of the other sign."""
        piece = self.memory[-1]
        assert isinstance(piece, Locked)
        self.lack = (4.0 / 3.0) * piece.outer**3 - piece.lack
        event, (front,) = yield from self._along(LOCKED, (piece.outer,), (piece.inner,))
        if event == 1:
            self.memory.pop()
            return self._slip()
        self.memory[-1] = piece._replace(outer=front)
        return self._stopped(front) if event == 0 else self._caught(front)

    def _gross(self) -> Part:
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
        before, change = self.radius, self.change - self.sign * (fall + rise)
        radius = max(after, 0.0) ** 0.2
        if press > SHALLOW and not self.stepped:
            self.slides.append((press, left, before, rate, radius, last))
            if rate > 0.0 >= last:
                self.deepest = max(self.deepest, (left / press) ** 0.2)
        elif depth > 0.0 or rate > 0.0:
            yield from self._along(GROSS, (), (int(stops),))
        self.radius, self.rate, self.margin = radius, last, margin + rise
        self.change, self.work = change, self.work + work
        self.deepest = max(self.deepest, radius)
        return self._stopped() if stops else None

    # --------------------------------------------------------------------- what comes after

    def _slip(self) -> Next:
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

    def _stopped(self, front: float = 0.0) -> Next:
        """Slip has stopped: its zone locks. In unloading the edge slips on with the other sign."""
        self.margin = 0.0
        self.memory.append(Locked(self.sign, self.lack, front, self.radius))
        if self.rate > AT_REST:
            return self._stuck
        self.rate = min(self.rate, 0.0)
        self._turn()
        return self._slip()

    def _caught(self, front: float) -> Next:
        """Let the edge, which has met the front, slip with the other sign."""
        self.radius = front
        self._turn()
        return self._slip()

    def _turn(self) -> None:
        """Look from the other sign of slip."""
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

    def _along(
        self, phase: Phase, own: tuple[float, ...] = (), constants: tuple[float, ...] = ()
    ) -> Generator[Request, Answer, tuple[int, tuple[float, ...]]]:
        """Ask for a phase; return the event that ended it, and what the phase has of its own."""
        tally = (self.deepest, self.compressions, self.steps)
        state = (self.radius, self.rate, self.margin, self.lack, *own, self.time, self.work)
        psi = self.rate - self.margin
        event, numbers = yield phase, (*tally, *self.laws, *state, *constants)
        self.deepest, self.compressions, self.steps = numbers[:HEAD]
        self.radius, self.rate, self.margin, self.lack = numbers[LAWS : LAWS + 4]
        *ends, self.time, self.work = numbers[LAWS + 4 : LAWS + phase.size]
        self.change += self.sign * (self.rate - self.margin - psi)
        return event, tuple(ends)
