"""A symplectic scheme of second order: velocities at the steps, forces between them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar

import attrs
import numpy as np

from contactlab.checks import Real, count, flag
from contactlab.contracts import (
    ClosedFormNormalLaw,
    Integrator,
    Motion,
    NormalContact,
    Observer,
    Problem,
)
from contactlab_march.march import march
from contactlab_march.normal_steps import NormalEnd, Step, Table
from contactlab_march.steps import (
    LONGEST_CONTACT,
    MOST_STEPS,
    enough,
    remarks,
    steps_for,
)


@attrs.frozen(kw_only=True)
class Symplectic(Integrator):
    """Leapfrog: the contact is sampled in the middle of each step.

    Where the normal motion is known in closed form it is taken; otherwise it is integrated
    by the same scheme, and the end of contact is located between samples rather than
    overshot. Steps are even in time: even in the phase of the closed form the error is
    about 1.6 times as large. A law is told the exact mean normal force of each step.

    Parameters
    ----------
    steps : int
        Steps in one duration (7) of a Hertz impact.
    refine : bool
        Where ``steps`` are too few for the stiffness of the law: take more (the default),
        or refuse with the status ``TOO_FEW_STEPS`` and the number needed.
    """

    api_version: ClassVar[int] = 1
    resolution: ClassVar[str | None] = "steps"
    order: ClassVar[int | None] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"steps"})
    needs: ClassVar[frozenset[str]] = frozenset({"advance"})
    uses: ClassVar[frozenset[str]] = frozenset({"closed_form_motion"})

    steps: int = count(default=200, most=MOST_STEPS)
    refine: bool = flag(default=True)

    def steps_for(self, problem: Problem) -> Any:
        """Return ``steps``, or more for those impacts of a batch for which they are too few."""
        return steps_for(self.steps, self.refine, problem)

    def remarks(self, problem: Problem) -> tuple[str, ...]:
        """Say whether the steps are enough for ``problem``."""
        return remarks(self.steps, self.refine, problem)

    def integrate(self, problem: Problem, observer: Observer | None = None) -> Motion:
        """Return the motion, with more steps than asked for where those are too few."""
        closed = isinstance(problem.normal, ClosedFormNormalLaw)

        def follow(problem: Problem, count: int, observer: Observer | None) -> Motion:
            end = NormalEnd()
            steps = self._along if closed else self._through
            return march(problem, steps(problem, count, end), end, observer)

        return enough(self.steps, self.refine, problem, follow, observer)

    def _along(self, problem: Problem, count: int, end: NormalEnd) -> Table:
        """Return the steps of a motion in closed form."""
        assert isinstance(problem.normal, ClosedFormNormalLaw)
        motion = problem.normal.motion(problem.pair, problem.normal_speed)
        mass = problem.pair.normal_mass
        column = (-1,) + (1,) * len(problem.shape)
        halves: Any = np.array(motion.phase(np.linspace(0.0, 1.0, 2 * count + 1)))
        halves[-1] = np.pi  # exactly, as the inverse is not
        at_ends: Any = motion.at(halves[::2].reshape(column))
        ends, rates = at_ends[0], at_ends[2]
        middles: Any = motion.at(halves[1::2].reshape(column))
        times, approaches, velocities, contacts = middles
        kicks = ends[1:] - ends[:-1]
        means = mass * (rates[:-1] - rates[1:]) / kicks
        drifts = np.array(times)
        drifts[1:] -= times[:-1]
        end.duration, end.rate = motion.duration, rates[-1]
        full = np.zeros_like(times)  # what all impacts share may lack the batch's axes
        contact = NormalContact(*(full + entry for entry in contacts))
        return Table(Step(contact, drifts, kicks, means, times, approaches, velocities))

    def _through(self, problem: Problem, count: int, end: NormalEnd) -> Iterator[Step]:
        """Yield steps of a motion integrated here; locate the end between two samples."""
        normal, mass = problem.normal, problem.pair.normal_mass
        state = normal.start(problem.pair)
        step = problem.duration / count
        rate, drift = problem.normal_speed, 0.5 * step
        approach, time, before = 0.0 * step, 0.0 * step, 0.0 * step
        loss: Real = 0.0 * rate
        touching: Any = np.ones(problem.shape, dtype=bool) if problem.shape else True
        for _ in range(LONGEST_CONTACT * count):
            approach = approach + rate * drift
            # The rate at the sample, half a step on: second order, where the force depends on it.
            contact, state = normal.respond(state, approach, rate - 0.5 * loss)
            # Where the overlap changed sign the contact ended on the way to this sample.
            ending = touching & (contact.overlap <= 0.0)
            inside = before / (before - contact.overlap + (contact.overlap == before))
            time = time + drift * np.where(ending, inside, np.where(touching, 1.0, 0.0))
            touching = touching & ~ending if problem.shape else bool(touching and not ending)
            loss = contact.force * step / mass
            middle = rate - 0.5 * loss  # at the sample, to second order
            rate = rate - loss
            yield Step(contact, drift, step, contact.force, time, approach, middle)
            before, drift = contact.overlap, step
            if not np.any(touching):
                end.duration, end.rate = time, rate
                return
        end.duration, end.rate, end.separated = time, rate, False
