"""Steps under error control, rejected and tried again where they are too long."""

from __future__ import annotations

import math
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.checks import Rule, quantity
from contactlab.contracts import (
    ClosedFormNormalLaw,
    Increment,
    Integrator,
    Motion,
    NormalContact,
    Observer,
    Problem,
    Sample,
    SteppedTangentialLaw,
)
from contactlab.status import Status
from contactlab_adaptive.paths import ClosedPath, Leg, MarchedPath, NormalPath

#: Attempts, accepted or not, after which the run ends with a status.
MOST_ATTEMPTS = 200_000
#: A contact that lasts longer than this many Hertz durations is given up.
LONGEST_CONTACT = 10
#: First step, longest step, and the step below which errors no longer matter, over the
#: length of the impact. A law that jumps (annuli, rigid bodies) is stepped over at the last.
FIRST, LONGEST, SHORTEST = 1e-3, 0.1, 1e-7
#: A next step aims at this share of what the error allows, and grows no faster than this.
SAFETY, GROWTH, SHRINKAGE = 0.85, 3.0, 0.2

TOLERANCE = Rule(lambda value: (value >= 1e-12) & (value <= 1.0), "must lie in [1e-12, 1]")


class Kinematics(NamedTuple):
    """Where the tangential motion stands. A value: a rejected step is simply forgotten."""

    pending: float  # displacement since the last sample, m
    change: float  # of slip velocity since first touch, m/s
    work: float
    contact: NormalContact  # at the last sample
    state: Any  # the law's


class Taken(NamedTuple):
    """A leg taken: where it leads, the force at its sample, and whether the law settled."""

    after: Kinematics
    force: float
    velocity: float
    settled: bool


@attrs.frozen(kw_only=True)
class Adaptive(Integrator):
    """Second order, each step done once whole and once in halves; the halves are kept.

    The difference, over the share of the impact that the step covers, is held below
    ``tolerance``: so the error of the whole impact is about that, for a smooth law. Changes
    between stick and slip, and the end of contact, are located by the steps they force.

    Parameters
    ----------
    tolerance : float
        In psi; from 1e-12 to 1. Cost grows as its inverse square root.
    """

    api_version: ClassVar[int] = 1
    resolution: ClassVar[str | None] = "tolerance"
    offers: ClassVar[frozenset[str]] = frozenset({"steps"})
    needs: ClassVar[frozenset[str]] = frozenset({"advance"})
    uses: ClassVar[frozenset[str]] = frozenset({"closed_form_motion"})
    common_instants: ClassVar[bool] = False
    together: ClassVar[bool] = False

    tolerance: float = quantity("1", rule=TOLERANCE, default=1e-4)

    def integrate(self, problem: Problem, observer: Observer | None = None) -> Motion:
        """Return the motion; impacts of a batch choose their own steps, one by one."""
        if not problem.shape:
            return self._one(problem, observer)
        motions = [self._one(impact, None) for impact in problem.impacts()]
        return Motion.joined(motions, problem.shape)

    def _one(self, problem: Problem, observer: Observer | None) -> Motion:
        law = problem.tangential
        assert isinstance(law, SteppedTangentialLaw)
        path: NormalPath
        if isinstance(problem.normal, ClosedFormNormalLaw):
            motion = problem.normal.motion(problem.pair, problem.normal_speed)
            path = ClosedPath(motion, float(problem.pair.normal_mass))
        else:
            path = MarchedPath(problem.normal, problem)
        run = _Run(problem, law, path, float(self.tolerance))
        return run.follow(observer)


class _Run:
    """One impact under way."""

    def __init__(
        self, problem: Problem, law: SteppedTangentialLaw, path: NormalPath, tolerance: float
    ) -> None:
        self.problem, self.law, self.path, self.tolerance = problem, law, path, tolerance
        self.initial, self.mass = float(problem.slip_velocity), float(problem.pair.tangential_mass)
        self.length = path.length or float(problem.duration)
        # One unit of psi, eq. (29).
        friction = float(problem.friction_coefficient) or 1.0
        kappa = float(problem.pair.stiffness_ratio)
        self.velocity_scale = friction * float(problem.normal_speed) / kappa

    def follow(self, observer: Observer | None) -> Motion:
        """Follow the impact to its end."""
        none = NormalContact(0.0, 0.0, 0.0)
        here = Kinematics(0.0, 0.0, 0.0, none, self.law.start(self.problem))
        place, step = self.path.begin(), FIRST * self.length
        kept = rejected = 0
        status, detail = Status.NOT_SEPARATED, f"After {MOST_ATTEMPTS} attempts."
        while kept + rejected < MOST_ATTEMPTS:
            trial = self.path.attempt(place, step)
            whole = self._take(here, trial.whole)
            first = self._take(here, trial.halves[0])
            second = self._take(first.after, trial.halves[1])
            error = self._difference(whole.after, second.after) + trial.error
            if not all(math.isfinite(leg.contact.force) for leg in (trial.whole, *trial.halves)):
                error = math.nan  # under an infinite force a law with a cap would have none
            allowed = self.tolerance * step / self.length
            if error > allowed or not math.isfinite(error):
                if step > SHORTEST * self.length:
                    shrink = SAFETY * (allowed / error) ** 0.5 if math.isfinite(error) else 0.0
                    step *= min(max(shrink, SHRINKAGE), 0.9)
                    rejected += 1
                    continue
                if not math.isfinite(error):
                    status, detail = (
                        Status.NON_FINITE,
                        f"At step {kept + 1}, time {trial.whole.time:.6g} s.",
                    )
                    break
            if not (first.settled and second.settled):
                status, detail = (
                    Status.UNSETTLED,
                    f"At step {kept + 1}, time {trial.whole.time:.6g} s.",
                )
                break
            here, place, kept = second.after, trial.place, kept + 1
            if observer is not None:
                for leg, taken in zip(trial.halves, (first, second), strict=True):
                    self._show(observer, leg, taken)
            if self.path.end(place)[0] > LONGEST_CONTACT * float(self.problem.duration):
                detail = f"After {LONGEST_CONTACT} durations of a Hertz impact."
                break
            if trial.ended:
                status, detail = Status.SUCCESS, ""
                break
            grow = SAFETY * (allowed / error) ** 0.5 if error > 0.0 else GROWTH
            step = min(step * min(grow, GROWTH), LONGEST * self.length)
        time, rate = self.path.end(place)
        return Motion(
            duration=time,
            normal_velocity=rate,
            slip_velocity_change=here.change,
            friction_work=here.work,
            status=status,
            detail=detail,
            counters={"steps": kept, "rejected": rejected, "evaluations": 3 * (kept + rejected)},
        )

    def _take(self, here: Kinematics, leg: Leg) -> Taken:
        """Drift to the sample, ask the law, kick, and drift on."""
        velocity = self.initial + here.change
        increment = Increment(
            here.pending + velocity * leg.lead,
            velocity,
            self.mass * velocity / leg.kick,
            leg.normal_force,
            leg.kick,
        )
        response, state = self.law.advance(here.state, increment, here.contact, leg.contact)
        force = float(response.force)
        change = here.change - force * leg.kick / self.mass
        after = Kinematics(
            (self.initial + change) * leg.tail,
            change,
            here.work + float(response.friction_work),
            leg.contact,
            state,
        )
        middle = velocity - 0.5 * force * leg.kick / self.mass
        return Taken(after, force, middle, bool(np.all(response.settled)))

    def _difference(self, whole: Kinematics, halves: Kinematics) -> float:
        """Return how far two ways part, in psi."""
        return abs(whole.change - halves.change) / self.velocity_scale

    def _show(self, observer: Observer, leg: Leg, taken: Taken) -> None:
        state = taken.after.state
        observer(
            Sample(
                time=leg.time,
                approach=leg.approach,
                normal_velocity=leg.rate,
                contact=leg.contact,
                slip_velocity=taken.velocity,
                tangential_force=taken.force,
                fields=lambda: self.law.fields(state),
            )
        )
