"""The initial-value problem of one impact: phases, the panels they are solved on, their events."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    ClosedPhase,
    Phase,
    PhasedTangentialLaw,
    PhaseState,
    faults,
)
from contactlab.contracts.status import Status
from contactlab.numeric.arrays import chosen
from contactlab.numeric.checks import Real
from contactlab.numeric.lobatto import Array, lobatto, row, rows
from contactlab_laws.events.forecast import too_many
from contactlab_laws.events.panel import Collocation, SolvedPanel
from contactlab_laws.events.search import first_event

NODES = 32
#: Longest panels, and highest Legendre terms of a panel over the tolerance, both in velocity, by
#: which it is resolved: collocation gains far more digits at a panel's end than inside it. The
#: normal motion's nearest singularity in x lies at 0.22 + 0.86 i (theory §3). An impact that fails,
#: or whose books do not add up, is solved again in shorter panels, held closer.
ATTEMPTS = ((1.6, 1e-2), (0.6, 3e-3), (0.2, 1e-3))
#: Friction work and loss of energy may differ by this part of the tangential energy, taken at
#: LEAST_AUDITED if psi1 is less. Work is less accurate than motion, most of all near psi1 = 1
#: and for small psi1; an event missed shows at 1e-2 and above.
BOOKS = 1e-3
#: Books that miss by more are suspect, and those of shorter panels may be better: next to psi1 = 1
#: and chi = 1/2, where psi and V differ by rounding, a mistaken event showed at 1e-7 and above.
SUSPECT = 2e-9
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
#: A first panel is tried this much longer than the law's guess of its phase's length, and no
#: shorter than the second.
GUESS_MARGIN, SHORTEST_GUESS = 1.08, 1e-3
#: An event in a panel that is not resolved is not trusted to shorten it further than this.
LEAST_PART = 0.1
RATE_GAP = 0.01
TINY = 1e-300


class Segment(NamedTuple):
    """A part of a trajectory between two states: a solved panel, or a phase in closed form."""

    phase: Phase
    start: PhaseState
    output: SolvedPanel | ClosedPhase
    stop: float  # x where it ends


class Trajectory(NamedTuple):
    """The tangential motion of one impact; ``failure`` is empty on success.

    ``state`` is the last that was reached, ``solves`` counts the panels solved on the way.
    """

    state: PhaseState
    failure: str = ""
    segments: tuple[Segment, ...] = ()
    solves: int = 0
    status: Status = Status.SUCCESS


def trajectory(
    law: PhasedTangentialLaw,
    motion: ClosedFormMotion,
    inertia: float,
    velocity: float,
    tolerance: float,
) -> Trajectory:
    """Return the motion of one impact from first touch to the end of contact.

    Parameters
    ----------
    law : PhasedTangentialLaw
    motion : ClosedFormMotion
        The normal motion.
    inertia : float
        In d psi/dT = -inertia F/(mu P_max).
    velocity : float
        psi1, at least 0.
    tolerance : float
        Error of psi2 over max(1, psi1) that is aimed at.
    """
    collocation = Collocation(motion, inertia, lobatto(NODES))
    tolerance = law.tolerance_needed(velocity, inertia, motion, tolerance)
    solves, best = 0, None
    dense = 0.5 * inertia * motion.scaled_mass > DENSE_CHI
    for longest, part in ATTEMPTS[-1:] if dense else ATTEMPTS:
        state = PhaseState(0.0, 0.0, 0.0, velocity, 0.0, 0.0, 0.0)
        attempt = _Integration(collocation, longest, part * tolerance, state)
        missing, status = 0.0, Status.UNRESOLVED
        try:
            failure = attempt.run(law)
            if not failure:
                end = attempt.state
                missing = float(books_miss(velocity, inertia, end.change, end.work))
                if not missing <= BOOKS:
                    failure = f"The energy books miss {missing:.1e} of the tangential energy."
        except Exception as error:
            what = f"{faults.raised(error)}, at x = {attempt.state.x:.6g}"
            failure = faults.sentence(law, what, len(attempt.segments) + 1)
            status = Status.LAW_RAISED
        solves += attempt.solves
        status = status if failure else Status.SUCCESS
        found = Trajectory(attempt.state, failure, tuple(attempt.segments), solves, status)
        if status is Status.LAW_RAISED or (not failure and missing <= SUSPECT + 10.0 * tolerance):
            return found
        if best is None or best[1].failure or (not failure and missing < best[0]):
            best = missing, found
    assert best is not None
    return best[1]._replace(solves=solves)


def books_miss(velocity: Real, inertia: Real, change: Real, work: Real) -> Any:
    """Return by what part of the tangential energy friction work is not the loss of energy.

    Parameters
    ----------
    velocity, inertia : float or array
        psi1 and the inertia, of one impact or of many.
    change, work : float or array
        psi2 - psi1 and the scaled friction work.
    """
    # Over the velocity, as its square may be too large for a number.
    small: Any = velocity < LEAST_AUDITED
    scale = chosen(small, LEAST_AUDITED, velocity)
    lost = change * ((velocity + 0.5 * change) / scale)
    return abs(lost + inertia * (work / scale)) / (0.5 * scale)


@attrs.define(eq=False)
class _Integration:
    """The integration of one impact in progress: what is solved, and the panel to try next.

    Parameters
    ----------
    collocation : Collocation
    longest : float
        Length of the longest panel, in x.
    tail : float
        Highest Legendre terms allowed in a panel, over the velocity.
    state : PhaseState
        The initial condition; later the last state reached.
    """

    collocation: Collocation
    longest: float
    tail: float
    state: PhaseState
    segments: list[Segment] = attrs.field(factory=list)
    solves: int = 0
    zero_lengths: int = 0  # segments of no length in a row
    first_panel: float | None = None  # x where the first panel began
    phase: Phase = attrs.field(init=False)
    length: float = attrs.field(init=False)  # of the next panel
    guess: Array | None = None  # of its change of velocity
    rejects: int = 0
    fits: bool = True  # not after a failure, which may be that of the fit

    def run(self, law: PhasedTangentialLaw) -> str:
        """Advance to the end of contact; return what went wrong, if anything did."""
        motion, inertia = self.collocation.motion, self.collocation.inertia
        self._begin(law.begin(self.state.velocity, inertia, motion))
        while self.state.x < math.pi:
            closed = self.phase.closed_form(self.state, motion, inertia)
            failure = ""
            if closed is None:
                failure = self._try_panel()
            else:
                self._arrive(closed, closed.end)
                if closed.event is None:
                    self.state = closed.end._replace(x=math.pi)
                else:
                    self._begin_after(closed.event, None)
            if self.zero_lengths > ZERO_LENGTH_CAP:
                failure = "Events follow one another without end."
            if failure:
                return f"{failure} In phase {type(self.phase).__name__} at x = {self.state.x:.9g}."
        return ""

    def _begin(self, phase: Phase) -> None:
        """Begin a phase: its first panel, and no guess of its motion."""
        self.phase, self.rejects, self.guess, self.fits = phase, 0, None, True
        self.length = self.longest
        if phase.length_guess is not None:
            expected = max(GUESS_MARGIN * phase.length_guess, SHORTEST_GUESS)
            self.length = min(self.longest, expected)

    def _begin_after(self, event: int, output: SolvedPanel | None) -> None:
        """Begin the phase after an event at the present state."""
        contact = self.collocation.motion.scaled_at(self.state.x)
        self._begin(self.phase.after_event(event, self.state, contact, output))

    def _arrive(self, output: SolvedPanel | ClosedPhase, end: PhaseState) -> None:
        """Add a segment to the trajectory."""
        start = self.state
        self.segments.append(Segment(self.phase, start, output, end.x))
        self.zero_lengths = 0 if end.x > start.x else self.zero_lengths + 1
        self.state = end

    def _try_panel(self) -> str:
        """Try one panel; accept it, or set out what to try next."""
        left = math.pi - self.state.x
        if self.length > left or (not self.rejects and 1.3 * self.length > left):
            self.length = left
        if self.first_panel is None:
            self.first_panel = self.state.x
        chi = 0.5 * self.collocation.inertia * self.collocation.motion.scaled_mass
        if complaint := too_many(self.solves, self.first_panel, self.state.x, chi):
            return complaint
        if self.rejects > REJECT_CAP or self.length < min(SHORTEST_PANEL, 0.5 * left):
            return "Newton's method fails on the shortest panel allowed."
        given = self.phase, self.state, self.length, self.guess
        panel = self.collocation.solve(*given, fits=self.fits)
        self.solves += 1
        self.rejects += 1
        self.guess, self.fits = None, panel is not None
        if panel is None:
            self.length *= 0.5
            return ""
        tail = self._tail(panel)
        found = first_event(self.phase, panel)
        if found is not None and found[1] == 0.0:
            if tail <= 1.0 or panel.length < SURELY_RESOLVED:
                self.zero_lengths += 1
                self._begin_after(found[0], None)
                return ""
            found = None
        if tail <= 1.0:
            self._accept(panel, found, tail)
        else:
            self._shorten(panel, found, tail)
        return ""

    def _tail(self, panel: SolvedPanel) -> float:
        """Return the highest Legendre terms of the force over what is allowed of them."""
        sample = panel.sample
        one, two = (panel.nodes.tail @ (sample.contact.time_rate * panel.force)).tolist()
        middle = abs(sample.velocity[NODES // 2].item())
        scale = abs(self.state.velocity) + abs(panel.change[-1].item()) + middle
        largest = self.collocation.inertia * panel.length * max(abs(one), abs(two))
        if largest == 0.0:  # as in rolling, where nothing is left to be a share of
            return 0.0
        return float(largest / (self.tail * scale)) if scale > 0.0 else math.inf

    def _shorten(self, panel: SolvedPanel, found: tuple[int, float] | None, tail: float) -> None:
        """Set out another panel, shorter, after one that was not accepted."""
        part = 1.0 if found is None else found[1]
        if panel.fitted is not None:
            self.length = 0.5 * panel.length
        elif part < 0.97:
            part = max(1.03 * part, LEAST_PART)
            self.guess = rows(panel.nodes, part * panel.nodes.points) @ panel.change
            self.length *= part
        else:
            self.length *= max(0.9 * tail ** (-1.0 / NODES), 0.3)

    def _accept(self, panel: SolvedPanel, found: tuple[int, float] | None, tail: float) -> None:
        """Move to the event found in a solved panel, or to its end."""
        self.rejects = 0
        event, stop = (panel.fitted, 1.0) if found is None else found
        part = stop if panel.fitted is None else stop * (2.0 - stop)
        x = min(panel.origin + panel.length * part, math.pi)
        self._arrive(panel, self._state_at(panel, stop, x))
        if event is None:
            contact = self.collocation.motion.scaled_at(x)
            self.phase = self.phase.after_panel(self.state, contact, panel)
            growth = min(0.9 * (tail + TINY) ** (-1.0 / NODES), 2.0)
            self.length = min(self.longest, growth * panel.length)
        else:
            self._begin_after(event, panel)

    def _state_at(self, panel: SolvedPanel, stop: float, x: float) -> PhaseState:
        """Return the state at tau = ``stop`` of a solved panel."""
        start, known = self.state, [panel.change, panel.force, panel.sample.slip, panel.time]
        if self.phase.dissipates:
            known.append(panel.time_matrix.dot(self.phase.friction_power(panel.sample)))
        table = np.array(known)
        change, force, slip, time, *work = table.dot(row(panel.nodes, stop)).tolist()
        _, earlier, _, before, *_ = table.dot(row(panel.nodes, stop - RATE_GAP)).tolist()
        return PhaseState(
            x=x,
            slip=slip,
            change=start.change + change,
            velocity=start.velocity + change,
            force=force,
            force_rate=(force - earlier) / (time - before),
            work=start.work + sum(work),
        )
