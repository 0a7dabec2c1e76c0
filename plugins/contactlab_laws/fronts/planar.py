"""The planar eccentric impact, followed from event to event by Taylor series (theory §14).

The contact is the sphere's, its memory the same: a stack of pieces, the outermost last. A piece
was drawn while all stuck, or locked out of slip of one sign. Slip eats the pieces from outside.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from contactlab_laws.fronts.series import Laws, Series, value
from contactlab_laws.fronts.steps import (
    Answer,
    Request,
    drawn,
    gross,
    locked,
    many,
    one,
    stick,
)
from contactlab_laws.hertz.motion import scaled_motion, velocity_factor

#: Steps of an impact before it is given up; a hard one takes 40, one of kappa = 1e6 some 10,000.
MOST_STEPS = 20_000
#: Fewer impacts than these are stepped one at a time.
FEW = 12


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


#: What a phase asks and is answered, and the phase after it.
Phase: TypeAlias = Generator[Request, Answer, "Callable[[], Phase] | None"]
Next: TypeAlias = Callable[[], Phase]
#: Called with T, u, V, psi and F/(mu P_max) at instants of the impact.
Watch = Callable[[float, float, float, float, float], object]


class Impact:
    """One planar impact: its state, its memory, and a method for each phase.

    Parameters
    ----------
    psi1, chi, lam, eta : float
        The parameters of theory §14.
    watch : callable, optional
        Sees the instants.

    Attributes
    ----------
    rate : float
        V.
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
        watch: Watch | None = None,
    ) -> None:
        self.numbers, self.watch = (chi, lam, eta), watch
        self.psi1 = psi1
        self.radius, self.rate, self.lack = 0.0, 1.0, 0.0
        self.time = self.work = self.deepest = 0.0
        self.sign = 1 if psi1 >= 0.0 else -1
        self.laws = Laws.of(self.sign, *self.numbers)
        self.margin = 1.0 - abs(psi1)
        self.memory: list[Drawn | Locked] = []
        self.steps, self.compressions = 0, 1

    def motion(self) -> Generator[Request, Answer, None]:
        """Ask for the steps of the impact until separation."""
        slips = self.margin < 0.0 or (self.margin == 0.0 and self.laws.drive <= 0.0)
        phase: Next | None = self._gross if slips else self._stuck
        while phase is not None:
            phase = yield from phase()

    @property
    def outcome(self) -> tuple[float, ...]:
        """V, the change of psi, friction work, T, the greatest u, and compressions."""
        change = self.sign * (self.rate - self.margin) - self.psi1
        return self.rate, change, self.work, self.time, self.deepest, self.compressions

    # ---------------------------------------------------------------------------- the phases

    def _stuck(self) -> Phase:
        """All sticks; the edge begins to slip where k, or its like of the other sign, is zero."""
        length, fresh, event = 0.0, self.margin == 0.0, -1
        while event < 0:
            state = (self.radius, self.rate, self.margin, self.lack)
            t, event, values, peak = yield (stick,), (*self.laws, *state, fresh)
            self._arrive(values, peak)
            length, fresh = length + t, False
        if event == 1:
            self._turn()
        self.margin = 0.0
        outer = (self.radius, self.rate, 0.0, self.lack)
        self.memory.append(Drawn(self.sign, outer, length))
        return self._slip()

    def _drawn(self) -> Phase:
        """Let the front run back along a piece that was drawn while all stuck."""
        piece = self.memory[-1]
        assert isinstance(piece, Drawn)
        then, left = piece.outer, piece.length
        meets, event = then[0] == self.radius, -1
        while event < 0:
            begins = self.margin == 0.0
            now = (self.radius, self.rate, self.margin)
            numbers = (*self.laws, *now, *then, left, begins, meets)
            _, event, values, peak = yield (drawn, begins and then[2] == 0.0), numbers
            self._arrive(values, peak)
            front, rate, margin, left, work = values[5:]
            then, meets = (front, rate, margin, self.lack), False
            self.work += work
        if event == 1:
            self.memory.pop()
            return self._slip()
        self.memory[-1] = Drawn(piece.sign, then, left)
        return self._stopped(front) if event == 0 else self._caught(front)

    def _locked(self) -> Phase:
        """Let the front run back through a zone that locked out of slip of the other sign."""
        piece = self.memory[-1]
        assert isinstance(piece, Locked)
        front, base = piece.outer, -piece.lack
        meets, event = front == self.radius, -1
        while event < 0:
            now = (self.radius, self.rate, self.margin)
            numbers = (*self.laws, *now, front, base, piece.inner, self.margin == 0.0, meets)
            _, event, values, peak = yield (locked,), numbers
            self._arrive(values, peak)
            front, work = values[5:]
            self.work, meets = self.work + work, False
        if event == 1:
            self.memory.pop()
            return self._slip()
        self.memory[-1] = piece._replace(outer=front)
        return self._stopped(front) if event == 0 else self._caught(front)

    def _gross(self) -> Phase:
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
        radius = max(after, 0.0) ** 0.2
        if press > 0.0 and self.watch is None:
            self.time += _time(press, left, (self.radius, rate), (radius, last))
        else:
            yield from self._through(last, stops)
        self.rate, self.radius = last, radius
        self.deepest = max(self.deepest, self.radius)
        self.margin = 0.0 if stops else margin
        return self._stopped() if stops else None

    def _through(self, last: float, stops: bool) -> Generator[Request, Answer, None]:
        """Add the time of gross slip until the rate is ``last``, and show the instants."""
        u, rate, margin, event = self.radius, self.rate, self.margin, -1
        falls = stops and rate > last
        while event < 0 and last != rate:
            numbers = (*self.laws, u, rate, margin, last, u == 0.0)
            _, event, values, _ = yield (gross, stops, falls), numbers
            u, rate, margin, _, time = values
            self.time += time

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
        if self.rate > 0.0:
            return self._stuck
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

    # ------------------------------------------------------------------------------ steps

    def _arrive(self, values: list[float], peak: float) -> None:
        """Take u, V, k and J at the end of a step, and its time."""
        before = self.rate
        self.radius, self.rate, self.margin, self.lack, time = values[:5]
        self.time += time
        self.deepest = max(self.deepest, peak)
        self.compressions += before <= 0.0 < self.rate

    def look(self, rows: list[Series], t: float) -> None:
        """Show u, V, psi and F within a step."""
        if self.watch is None:
            return
        for part in (0.25, 0.5, 0.75, 1.0):
            u, rate, margin, lack, time = (value(row, part * t) for row in rows[:5])
            psi, force = self.sign * (rate - margin), self.sign * (u**3 - 1.5 * lack)
            self.watch(self.time + time, u, rate, psi, force)


def _time(press: float, left: float, *ends: tuple[float, float]) -> float:
    """Return T between two ends, u and V each, where V² + ``press`` u⁵ is ``left``, as Hertz's."""
    top, speed = (left / press) ** 0.2, math.sqrt(left)
    phases = []
    for u, rate in ends:
        sine = u / top
        phases.append(math.atan2(sine, rate / (speed * velocity_factor(sine))))
    begin, end = scaled_motion(np.array(phases))[2].tolist()
    time: float = top * top / speed * (end - begin)
    return time


def follow(impacts: list[Impact], tolerance: float) -> list[str]:
    """Follow impacts to separation; return why each has no answer, "" if it has one.

    All that wait in one phase are stepped at once, first those whose first has made the fewest.
    """
    lost = [""] * len(impacts)
    motions = [impact.motion() for impact in impacts]
    waiting: dict[Any, list[tuple[int, Request]]] = {}

    def send(place: int, answer: Answer | None) -> None:
        """Let an impact ask for its next step."""
        impacts[place].steps += 1
        try:
            request = motions[place].send(answer)  # type: ignore[arg-type]
        except StopIteration:
            return
        except ArithmeticError as error:
            lost[place] = str(error)
        else:
            waiting.setdefault(request[0], []).append((place, request))

    for place in range(len(impacts)):
        send(place, None)
    while waiting:
        behind = min(waiting, key=lambda phase: impacts[waiting[phase][0][0]].steps)
        places, requests = zip(*waiting.pop(behind), strict=True)
        if len(places) < FEW:
            answers = [one(request, tolerance, impacts[0].look) for request in requests]
        else:
            answers = many(requests, tolerance)
        for place, answer in zip(places, answers, strict=True):
            if answer is None:
                lost[place] = "The velocities of a jam outgrow the numbers"
            elif impacts[place].steps > MOST_STEPS:
                lost[place] = f"The contact neither ends nor settles in {MOST_STEPS} steps"
            else:
                send(place, answer)
    return lost
