"""From first touch to separation: phases, the panels they are solved on, and their events."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab import faults
from contactlab.checks import Real
from contactlab.collocation import lobatto, row, rows
from contactlab.contracts import (
    ClosedFormMotion,
    ClosedPhase,
    Phase,
    PhasedTangentialLaw,
    PhaseState,
)
from contactlab.status import Status
from contactlab_events.forecast import too_many
from contactlab_events.panel import PanelPath, Solved, newton
from contactlab_events.search import first_event

Array = NDArray[np.float64]

NODES = 32
#: Longest panels, and highest Legendre terms of a panel over the tolerance, both in velocity, by
#: which it is resolved: collocation gains far more digits at a panel's end than inside it. The
#: normal motion's nearest singularity in x lies at 0.22 + 0.86 i (theory §3). An impact that fails,
#: or whose books do not add up, is followed again in shorter panels, held closer.
ATTEMPTS = ((1.6, 1e-2), (0.6, 3e-3), (0.2, 1e-3))
#: Friction work and loss of energy may differ by this part of the tangential energy, taken at
#: LEAST_AUDITED if psi1 is less. Work is less accurate than motion, most of all near psi1 = 1
#: and for small psi1; an event missed shows at 1e-2 and above.
BOOKS = 1e-3
#: Books that miss by more are suspect, and those of shorter panels may be better: next to psi1 = 1
#: and chi = 1/2, where psi and V differ by rounding, a mistaken event showed at 1e-7 and above.
SUSPECT = 2e-8
LEAST_AUDITED = 0.1
SHORTEST_PANEL = 1e-9
#: Beyond this chi the shortest panels are taken at once: they need a third fewer solves there,
#: and came to the end wherever longer ones did (measured to chi = 2e5).
DENSE_CHI = 1.01e4
#: Phases of no length in a row: a law may have to take leave of a long history at one point.
ZERO_LENGTH_CAP = 100
REJECT_CAP = 60
#: Below this length an event at the very start of a panel is believed, resolved or not.
SURELY_RESOLVED = 1e-6
#: A first panel is tried this much longer than the law's guess of its phase's length.
SPAN_MARGIN = 1.08
SHORTEST_SPAN = 1e-3
#: An event in a panel that is not resolved is not trusted to shorten it further than this.
LEAST_PART = 0.1
RATE_GAP = 0.01
TINY = 1e-300


class Piece(NamedTuple):
    """A stretch of the motion: its phase, the state it began with, its course, where it ends."""

    phase: Phase
    start: PhaseState
    path: PanelPath | ClosedPhase
    stop: float


class Followed(NamedTuple):
    """What came out; ``failure`` is empty on success."""

    failure: str
    state: PhaseState
    pieces: tuple[Piece, ...]
    solves: int
    status: Status = Status.SUCCESS


def follow(
    law: PhasedTangentialLaw,
    motion: ClosedFormMotion,
    inertia: float,
    velocity: float,
    tolerance: float,
) -> Followed:
    """Follow one impact of scaled velocity >= 0 to the end of contact."""
    solves, best = 0, None
    dense = 0.5 * inertia * motion.scaled_mass > DENSE_CHI
    for longest, part in ATTEMPTS[-1:] if dense else ATTEMPTS:
        walk = _Walk(law, motion, inertia, velocity, longest, part * tolerance)
        missing, status = 0.0, Status.UNRESOLVED
        try:
            failure = walk.go()
            if not failure:
                missing = float(books_miss(velocity, inertia, walk.state.change, walk.state.work))
                if not missing <= BOOKS:
                    failure = f"The energy books miss {missing:.1e} of the tangential energy."
        except Exception as error:
            what = f"{faults.raised(error)}, at x = {walk.state.x:.6g}"
            failure = faults.sentence(law, what, len(walk.pieces) + 1)
            status = Status.LAW_RAISED
        solves += walk.solves
        status = status if failure else Status.SUCCESS
        found = Followed(failure, walk.state, tuple(walk.pieces), solves, status)
        if status is Status.LAW_RAISED or (not failure and missing <= SUSPECT + 10.0 * tolerance):
            return found
        if best is None or best[1].failure or (not failure and missing < best[0]):
            best = missing, found
    assert best is not None
    return best[1]._replace(solves=solves)


def books_miss(velocity: Real, inertia: Real, change: Real, work: Real) -> Any:
    """Return by what part of the tangential energy friction work is not the loss of energy."""
    # Over the velocity, as its square may be too large for a number.
    scale = np.maximum(velocity, LEAST_AUDITED)
    lost = change * ((velocity + 0.5 * change) / scale)
    return abs(lost + inertia * (work / scale)) / (0.5 * scale)


class _Walk:
    """One impact on its way: what is done, and the panel to try next."""

    def __init__(
        self,
        law: PhasedTangentialLaw,
        motion: ClosedFormMotion,
        inertia: float,
        velocity: float,
        longest: float,
        tail: float,
    ) -> None:
        self.law, self.motion, self.inertia = law, motion, inertia
        self.longest, self.tail = longest, tail
        self.nodes = lobatto(NODES)
        self.state = PhaseState(0.0, 0.0, 0.0, velocity, 0.0, 0.0, 0.0)
        self.pieces: list[Piece] = []
        self.solves = self.idle = 0
        self.begun: float | None = None  # where the first panel began

    def go(self) -> str:
        """Advance to the end of contact; return what went wrong, if anything did."""
        self._enter(self.law.begin(self.state.velocity, self.inertia, self.motion))
        while self.state.x < math.pi:
            closed = self.phase.closed_form(self.state, self.motion, self.inertia)
            failure = self._panel() if closed is None else self._jump(closed)
            if failure:
                return f"{failure} In phase {type(self.phase).__name__} at x = {self.state.x:.9g}."
        return ""

    def _enter(self, phase: Phase) -> None:
        """Begin a phase: its first panel, and no guess of its motion."""
        self.phase, self.rejects = phase, 0
        self.guess: Array | None = None
        self.fits = True  # not after a failure, which may be that of the fit
        span = phase.span
        self.length = self.longest
        if span is not None:
            self.length = min(self.longest, max(SPAN_MARGIN * span, SHORTEST_SPAN))

    def _stand_still(self) -> str:
        """Count phases of no length."""
        self.idle += 1
        return "Events follow one another without end." if self.idle > ZERO_LENGTH_CAP else ""

    def _jump(self, closed: ClosedPhase) -> str:
        """Take a phase in closed form."""
        start, end = self.state, closed.end
        self.pieces.append(Piece(self.phase, start, closed, end.x))
        failure = ""
        if end.x > start.x:
            self.idle = 0
        else:
            failure = self._stand_still()
        self.state = end
        if closed.event is None:
            self.state = end._replace(x=math.pi)
        else:
            instant = self.motion.scaled_at(end.x)
            self._enter(self.phase.follow(closed.event, end, instant, None))
        return failure

    def _panel(self) -> str:
        """Try one panel; accept it, or set out what to try next."""
        left = math.pi - self.state.x
        if self.length > left or (not self.rejects and 1.3 * self.length > left):
            self.length = left
        if self.begun is None:
            self.begun = self.state.x
        chi = 0.5 * self.inertia * self.motion.scaled_mass
        if complaint := too_many(self.solves, self.begun, self.state.x, chi):
            return complaint
        if self.rejects > REJECT_CAP or self.length < min(SHORTEST_PANEL, 0.5 * left):
            return "Newton's method fails on the shortest panel allowed."
        given = self.phase, self.motion, self.nodes, self.state, self.length, self.inertia
        solved = newton(*given, self.guess, fits=self.fits)
        self.solves += 1
        self.rejects += 1
        self.guess, self.fits = None, solved is not None
        if solved is None:
            self.length *= 0.5
            return ""
        tail = self._tail(solved)
        found = first_event(self.nodes, self.phase, solved)
        if found is not None and found[1] == 0.0:
            if tail <= 1.0 or solved.length < SURELY_RESOLVED:
                self._turn(found[0])
                return self._stand_still()
            found = None
        if tail <= 1.0:
            self._accept(solved, found, tail)
        else:
            self._retry(solved, found, tail)
        return ""

    def _tail(self, solved: Solved) -> float:
        """Return the highest Legendre terms of the force over what is allowed of them."""
        one, two = (self.nodes.tail @ (solved.contact.time_rate * solved.force)).tolist()
        middle = abs(solved.velocity[NODES // 2].item())
        scale = abs(self.state.velocity) + abs(solved.change[-1].item()) + middle
        largest = self.inertia * solved.length * max(abs(one), abs(two))
        if largest == 0.0:  # as in rolling, where nothing is left to be a share of
            return 0.0
        return float(largest / (self.tail * scale)) if scale > 0.0 else math.inf

    def _retry(self, solved: Solved, found: tuple[int, float] | None, tail: float) -> None:
        """Set out another panel, shorter, after one that was not accepted."""
        part = 1.0 if found is None else found[1]
        if solved.fitted is not None:
            self.length = 0.5 * solved.length
        elif part < 0.97:
            part = max(1.03 * part, LEAST_PART)
            self.guess = rows(self.nodes, part * self.nodes.points) @ solved.change
            self.length *= part
        else:
            self.length *= max(0.9 * tail ** (-1.0 / NODES), 0.3)

    def _turn(self, event: int) -> None:
        """Go over to the next phase at once."""
        state = self.state
        self._enter(self.phase.follow(event, state, self.motion.scaled_at(state.x), None))

    def _accept(self, solved: Solved, found: tuple[int, float] | None, tail: float) -> None:
        """Move to the event found in a solved panel, or to its end."""
        self.rejects = 0
        event, stop = (solved.fitted, 1.0) if found is None else found
        start, motion = self.state, self.motion
        part = stop if solved.fitted is None else stop * (2.0 - stop)
        x = min(start.x + solved.length * part, math.pi)
        self.idle = self.idle + 1 if x == start.x else 0
        path = PanelPath(solved, self.nodes, start.x)
        self.pieces.append(Piece(self.phase, start, path, x))
        self.state = self._arrive(solved, stop, x)
        if event is None:
            self.phase = self.phase.carry_on(self.state, motion.scaled_at(x), path)
            growth = min(0.9 * (tail + TINY) ** (-1.0 / NODES), 2.0)
            self.length = min(self.longest, growth * solved.length)
        else:
            self._enter(self.phase.follow(event, self.state, motion.scaled_at(x), path))

    def _arrive(self, solved: Solved, stop: float, x: float) -> PhaseState:
        """Return the state at tau = ``stop`` of a solved panel."""
        start, known = self.state, [solved.change, solved.force, solved.slip, solved.time]
        if self.phase.dissipates:
            power = self.phase.friction_power(
                solved.contact, solved.slip, solved.velocity, solved.response
            )
            known.append(solved.time_matrix.dot(power))
        table = np.array(known)
        change, force, slip, time, *work = table.dot(row(self.nodes, stop)).tolist()
        _, earlier, _, before, *_ = table.dot(row(self.nodes, stop - RATE_GAP)).tolist()
        return PhaseState(
            x=x,
            slip=slip,
            change=start.change + change,
            velocity=start.velocity + change,
            force=force,
            force_rate=(force - earlier) / (time - before),
            work=start.work + sum(work),
        )
