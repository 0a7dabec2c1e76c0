"""The tangential motion over one leg: drift to the sample, ask the law, kick, and drift on."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlab import faults
from contactlab.contracts import Increment, NormalContact, Problem, SteppedTangentialLaw
from contactlab.status import Status
from contactlab_adaptive.paths import Leg


class Kinematics(NamedTuple):
    """Where the tangential motion stands. A value: a rejected step is simply forgotten."""

    pending: float  # displacement since the last sample, m
    change: float  # of slip velocity since first touch, m/s
    work: float
    contact: NormalContact  # at the last sample
    state: Any  # the law's


class Taken(NamedTuple):
    """A leg taken: where it leads, the answer at its sample, and whether the law settled."""

    after: Kinematics
    force: float
    velocity: float
    settled: bool

    @property
    def finite(self) -> bool:
        """Whether the answer is finite."""
        return math.isfinite(self.after.change) and math.isfinite(self.after.work)


class Slide:
    """The tangential motion of one impact."""

    def __init__(self, problem: Problem, law: SteppedTangentialLaw) -> None:
        self.problem, self.law = problem, law
        self.evaluations = 0
        self.initial, self.mass = float(problem.slip_velocity), float(problem.pair.tangential_mass)

    def begin(self) -> Kinematics:
        """Return first touch."""
        none = NormalContact(0.0, 0.0, 0.0)
        return Kinematics(0.0, 0.0, 0.0, none, self.law.start(self.problem))

    def take(self, here: Kinematics, leg: Leg) -> Taken:
        """Take one leg.

        The change of velocity is summed apart from the velocity, which may be so large
        that it would swallow the change (theory §8).

        Raises
        ------
        LawFaultError
            If the law's answer is not made of real numbers.
        """
        self.evaluations += 1
        velocity = self.initial + here.change
        increment = Increment(
            here.pending + velocity * leg.lead,
            velocity,
            self.mass * velocity / leg.kick,
            leg.normal_force,
            leg.kick,
        )
        response, state = self.law.advance(here.state, increment, here.contact, leg.contact)
        force, lost, settled = response.force, response.friction_work, response.settled
        if type(force) is not float or type(lost) is not float:
            for number in (force, lost):
                if faults.malformed(number, ()):
                    what = f"the answer {faults.shown(number)}"
                    raise faults.LawFaultError(Status.MALFORMED, what)
            force, lost = float(force), float(lost)
        slowed = force * leg.kick / self.mass
        change = here.change - slowed
        pending = (self.initial + change) * leg.tail
        after = Kinematics(pending, change, here.work + lost, leg.contact, state)
        return Taken(
            after, force, velocity - 0.5 * slowed, settled is True or bool(np.all(settled))
        )
