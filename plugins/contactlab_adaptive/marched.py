"""A normal law without a closed form, integrated along with the tangential motion."""

from __future__ import annotations

from typing import Any, NamedTuple

from contactlab import faults
from contactlab.contracts import ClosedFormNormalLaw, NormalContact, NormalLaw, Problem
from contactlab.status import Status
from contactlab_adaptive.paths import ClosedPath, Leg, NormalPath, Trial


class Flight(NamedTuple):
    """Place of a motion that is integrated."""

    time: float
    approach: float
    rate: float
    overlap: float
    state: Any


class MarchedPath(NormalPath):
    """A normal law without closed form, by the same leapfrog; a step is one of time."""

    length = None

    def __init__(self, law: NormalLaw, problem: Problem) -> None:
        self.law, self.mass = law, float(problem.pair.normal_mass)
        self.start = law.start(problem.pair)
        self.speed = float(problem.normal_speed)
        self.depth = self.speed * float(problem.duration)

    def begin(self) -> Flight:
        """Return first touch."""
        return Flight(0.0, 0.0, self.speed, 0.0, self.start)

    def attempt(self, place: Any, step: float) -> Trial:
        """Try a step of time, cut off where the overlap is about to vanish."""
        separating = place.rate < 0.0 and place.overlap > 0.0
        # The bodies part no slower than they do now: the end is at most this far.
        step = min(step, place.overlap / -place.rate) if separating else step
        whole, there = self._leg(place, step)
        first, middle = self._leg(place, 0.5 * step)
        second, place = self._leg(middle, 0.5 * step)
        error = abs(place.rate - there.rate) / self.speed
        error += abs(place.approach - there.approach) / self.depth
        ended = place.rate < 0.0 and place.overlap <= 1e-9 * self.depth
        return Trial(whole, (first, second), place, error, ended)

    def _leg(self, place: Flight, step: float) -> tuple[Leg, Flight]:
        lead = 0.5 * step
        approach = place.approach + place.rate * lead
        contact, state = self.law.respond(place.state, approach, place.rate)
        contact = _plain(contact)
        force, overlap = float(contact.force), float(contact.overlap)
        loss = force * step / self.mass
        middle, rate = place.rate - 0.5 * loss, place.rate - loss
        time = place.time + lead
        leg = Leg(contact, lead, lead, step, force, time, approach, middle)
        after = approach + rate * lead
        overlap += rate * lead
        return leg, Flight(place.time + step, after, rate, overlap, state)

    def end(self, place: Any) -> tuple[float, float]:
        """Return (time, rate)."""
        return place.time, place.rate


def _plain(contact: NormalContact) -> NormalContact:
    """Return the answer of a normal law in floats.

    Raises
    ------
    LawFaultError
        If it is not made of real numbers.
    """
    parts = (contact.force, contact.radius, contact.overlap)
    for part in parts:
        if type(part) is not float and faults.malformed(part, ()):
            raise faults.LawFaultError(Status.MALFORMED, f"the answer {faults.shown(part)}")
    return NormalContact(*map(float, parts))


def path_of(problem: Problem) -> NormalPath:
    """Return the normal motion: in closed form where the law has one."""
    if isinstance(problem.normal, ClosedFormNormalLaw):
        motion = problem.normal.motion(problem.pair, problem.normal_speed)
        return ClosedPath(motion, float(problem.pair.normal_mass))
    return MarchedPath(problem.normal, problem)
