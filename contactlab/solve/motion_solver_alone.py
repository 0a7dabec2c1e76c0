"""The normal motion of one impact, in plain numbers: by the rule of ``normal_steps``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from contactlab.contracts import faults, judges
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.status import Status
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import quote
from contactlab.numeric.lobatto import lobatto
from contactlab.numeric.runge_kutta import Alone as Step
from contactlab.solve import normal_steps as rule
from contactlab.solve.scaled_normal_law import ScaledNormalLaw
from contactlab.solve.solved_motion import NODES, MotionTable, SolvedMotion


class Seen(NamedTuple):
    """Force (N), radius (m), overlap (m) and friction load (N), at scaled values."""

    force: float
    radius: float
    overlap: float
    load: float
    approach: float
    rate: float
    impulse: float


class Alone:
    """The solver of one normal motion; ``motion_solver.Solver`` says what its numbers are.

    This solver calls the law less often: the slope at the end of a step serves the next step, and a
    step that misses the tolerance is checked at its end only.
    """

    def __init__(self, law: NormalLaw, scene: Scene) -> None:
        self.law = ScaledNormalLaw(law, scene)
        self.length, self.speed = self.law.length.item(), self.law.speed.item()
        self.unit, self.response = self.law.unit.item(), self.law.response.item()
        self.radius = self.law.radius.item()
        self.largest = self.radius, 1.0 / self.response
        self.points: list[float] = lobatto(NODES).points.tolist()
        self.place, self.time, self.turns = [0.0, 1.0, 0.0], 0.0, 0
        self.width, self.event = rule.FIRST_STEP, math.inf
        #: Width of the last step that set one, and the eighth root of its error.
        self.before = rule.FIRST_STEP, 1.0
        self.begun, self.active, self.tried = False, True, 0
        #: Whether the last step ended at an event, where no sign is judged.
        self.at_event = True
        self.status, self.detail = Status.SUCCESS, ""
        self.first = self._slope(self.place)

    def solve(self) -> SolvedMotion:
        """Return the solved motion."""
        law, edges, values = self.law, [0.0], []
        while self.active:
            width, columns = self._step()
            if columns is not None:
                edges.append(edges[-1] + width)
                values.append(columns)
        if not values:  # abandoned in its first step
            edges, values = [0.0, 0.0], [self._columns([self.seen] * NODES)[0]]
        table = MotionTable.make(
            shape=law.shape,
            edges=np.array([edges]),
            unit=law.unit,
            values=np.array([values]),
            status=np.array([self.status], dtype=object),
            detail=np.array([self.detail], dtype=object),
        )
        return SolvedMotion(law.law, law.scene, table)

    def _slope(self, place: Sequence[float]) -> tuple[float, float, float]:
        """Return the derivatives of scaled approach, rate and load impulse."""
        seen = self.seen = self._contact(place)
        self.law.finite = math.isfinite(seen.force) and math.isfinite(seen.load)
        return seen.rate, -seen.force * self.response, seen.load * self.response

    def _contact(self, place: Sequence[float]) -> Seen:
        """Return the contact at scaled values; ``state`` is the law's after it."""
        contact, self.state = self.law.respond(place[0] * self.length, place[1] * self.speed)
        force, radius, overlap, load = contact.complete
        return Seen(float(force), float(radius), float(overlap), float(load), *place)

    def _step(self) -> tuple[float, list[list[float]] | None]:
        """Try a step; return its width and the table's columns (NODES, 6), None if rejected."""
        law = self.law
        self.tried += 1
        width = min(self.width, self.event)
        begin, planned = self.seen, width == self.event
        step = Step(self._slope, self.place, self.first, width, tolerance=rule.TOLERANCE)
        end, state, good = self.seen, self.state, step.error <= 1.0
        doubt = rule.doubt(step.error, width)
        close = rule.NEAR * (self.time + width)
        until, ended, contacts = 1.0, False, [begin]
        if doubt < 1.0:
            until, ended = self._until(step, end, doubt, close, contacts)
        # A step is rejected if it misses the tolerance or spans an event.
        taken = good and width * (1.0 - until) <= close
        ended = ended and (taken or width * until <= close)
        taken = taken or ended
        self._plan(step.error, width, rule.sure_part(until, doubt), taken)
        if not taken:
            if not math.isfinite(begin.force + begin.load):  # a shorter step begins there too
                raise law.fault(Status.NON_FINITE, f"the answer {quote(begin.load)}")
            self.seen = begin
            self._abandon(self.place[1], begin.force, taken=False)
            return 0.0, None
        if ended:
            contacts = [self._contact(step.at(until * point)) for point in self.points]
        elif len(contacts) < NODES:  # the event is at the end of the step
            asked = self.points[len(contacts) : -1]
            contacts += [*(self._contact(step.at(point)) for point in asked), end]
        if not all(math.isfinite(each.force + each.radius + each.load) for each in contacts):
            raise law.fault(Status.NON_FINITE, f"the answer {quote(contacts[-1].force)}")
        radius, load = min(each.radius for each in contacts), min(each.load for each in contacts)
        if (radius < 0.0 or load < 0.0) and (
            words := judges.below_zero(radius, load, self.largest)
        ):
            raise law.fault(Status.MALFORMED, words)
        columns, impulse = self._columns(contacts)
        self.time += width * until if ended else width
        self.begun = self.begun or any(each.overlap > 0.0 for each in contacts)
        self.active = not ended
        self.at_event = planned or until < 1.0
        before, self.place = self.place[1], [*step.end[:2], impulse]
        law.steps, law.time = law.steps + 1, self.time * self.unit
        if state is not law.state and not ended:  # a law with memory: call it again
            law.state = state
            step.last = list(self._slope(self.place))
        else:
            self.seen = end._replace(impulse=impulse)
        self.first = (step.last[0], step.last[1], step.last[2])
        self._abandon(before, self.seen.force, taken=True)
        return width * until if ended else width, columns

    def _until(
        self, step: Step, end: Seen, doubt: float, close: float, contacts: list[Seen]
    ) -> tuple[float, bool]:
        """Return the fraction of a step before its first event, and whether contact ends there.

        ``contacts`` are continued to those at the nodes, as far as these are before an event.
        """
        width, good = step.width, step.error <= 1.0
        start, before = 0.0, contacts[0]
        if self.at_event:  # just after, so that the last step's event is not repeated
            start = min(close / width, 1.0)
            before = self._contact(step.at(start))
            self._refuse_nan(before)
        if self.begun and not before.overlap > 0.0:
            return 0.0, True
        begun, loaded = self.begun or before.overlap > 0.0, before.load > 0.0

        def quiet(seen: Seen) -> bool:
            self._refuse_nan(seen)
            turned = seen.rate * before.rate < 0.0 or (seen.load > 0.0) != loaded
            return not turned and (seen.overlap > 0.0 or not begun)

        low, high, there = start, 1.0, end
        if good:
            for point in self.points[1:-1]:
                there = self._contact(step.at(point))
                if point > start and not quiet(there):
                    high = point
                    break
                low = max(point, start)
                contacts.append(there)
            else:
                there = end
        if high == 1.0 and quiet(end):
            if good:
                contacts.append(end)
            return 1.0, False
        out = begun and not there.overlap > 0.0
        turns = quiet(there._replace(rate=before.rate))  # the rate alone, without the law
        for _ in range(rule.HALVINGS):
            if not (high - low) * width > 0.1 * max(close, doubt * low * width):
                break
            middle = 0.5 * (low + high)
            place = step.at(middle)
            there = there._replace(rate=place[1]) if turns else self._contact(place)
            if quiet(there):
                low = middle
            else:
                high, out = middle, begun and not there.overlap > 0.0
        return low, out

    def _plan(self, error: float, width: float, sure: float, taken: bool) -> None:
        """Set ``width`` and ``event`` of the next step from the error and width of this one."""
        missed = not error <= 1.0
        root = max(math.inf if math.isnan(error) else error**0.125, rule.LEAST_ROOT)
        factor = rule.SAFETY / root
        if rule.sets_width(missed, sure, width, self.width):
            if not missed:
                # the trend of the errors continues (Gustafsson)
                before, its_root = self.before
                factor *= min(1.0, width / before * its_root / root)
                self.before = width, root
            self.width = rule.next_width(width, factor)
        self.event = rule.next_event(width, sure, not taken)
        if not taken and self.width <= rule.SHORTEST * self.time:
            raise rule.too_short(self.law)

    def _columns(self, contacts: list[Seen]) -> tuple[list[list[float]], float]:
        """Return the table's columns for one step, and the scaled load impulse at its end."""
        # Without tension the load impulse is the change of momentum.
        pressed = all(seen.load == seen.force for seen in contacts)
        first, most, columns, momentum = contacts[0], -math.inf, [], self.law.momentum.item()
        for seen in contacts:
            gained = first.impulse + (first.rate - seen.rate) if pressed else seen.impulse
            most = max(most, gained)
            square = seen.radius * seen.radius
            place = seen.approach * self.length, seen.rate * self.speed
            columns.append([*place, seen.force, square, seen.load, most * momentum])
        return columns, most

    def _refuse_nan(self, seen: Seen) -> None:
        """Refuse an overlap that is NaN: a comparison would take it for the end of contact."""
        if math.isnan(seen.overlap):
            raise self.law.fault(Status.NON_FINITE, "the overlap nan")

    def _abandon(self, before: float, force: float, *, taken: bool) -> None:
        """Abandon a contact that does not end, from the rate before a step."""
        rate = self.place[1]
        self.turns += rate * before < 0.0
        change, approach = force * self.response * self.time, self.place[0] * self.length
        endless = taken and rule.is_endless(self.turns, rate, change, approach, self.radius)
        if self.active and (endless or self.tried >= rule.MOST_STEPS):
            self.active, self.status = False, Status.NOT_SEPARATED
            time = self.time * self.unit
            self.detail = faults.sentence(
                self.law.law, "the bodies do not separate", self.law.steps, time
            )
