"""One impact under way: steps tried, kept or rejected, and who is to blame if none will do."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

from contactlab import faults
from contactlab.contracts import (
    Law,
    Motion,
    Observer,
    Problem,
    Sample,
    SteppedTangentialLaw,
)
from contactlab.status import Status
from contactlab_adaptive.marched import path_of
from contactlab_adaptive.paths import Leg, Trial
from contactlab_adaptive.tangential import Kinematics, Slide, Taken

#: Attempts, accepted or not, after which the run ends with a status.
MOST_ATTEMPTS = 200_000
#: A contact that lasts longer than this many Hertz durations is given up.
LONGEST_CONTACT = 10
#: First step, longest step, and the step below which errors no longer matter, over the
#: length of the impact.
FIRST, LONGEST, SHORTEST = 1e-3, 0.1, 1e-7
#: Largest omega dt of the fastest tangential oscillation: at 2 steps become unstable, and what
#: they make of a small slip would pass unseen until it is as large as the tolerance.
LARGEST_PHASE_STEP = 1.0
#: The longest dt of a step, which is even in the phase of a Hertz motion, over the mean.
STRETCH = 1.35
#: A next step aims at this share of what the error allows, and grows no faster than this.
SAFETY, GROWTH, SHRINKAGE = 0.85, 3.0, 0.2
#: Of two ways of second order, one with steps half as long as the other, the shorter is wrong by
#: 1/(2² - 1) of what parts them (Richardson).
SHARE_OF_HALVES = 1.0 / 3.0


class Run:
    """One impact under way."""

    def __init__(self, problem: Problem, law: SteppedTangentialLaw, tolerance: float) -> None:
        self.problem, self.law, self.tolerance = problem, law, tolerance
        self.slide = Slide(problem, law)
        # One unit of psi, eq. (29).
        friction = float(problem.friction_coefficient) or 1.0
        kappa = float(problem.pair.stiffness_ratio)
        self.velocity_scale = friction * float(problem.normal_speed) / kappa
        self.kept = self.rejected = 0
        self.time, self.rate = 0.0, float(problem.normal_speed)
        self.change = self.work = 0.0

    def follow(self, observer: Observer | None) -> Motion:
        """Follow the impact to its end, or to a fault."""
        try:
            status, detail = self._follow(observer)
        except faults.LawFaultError as fault:
            status, detail = fault.status, fault.detail
        return Motion(
            duration=self.time,
            normal_velocity=self.rate,
            slip_velocity_change=self.change,
            friction_work=self.work,
            status=status,
            detail=detail,
            counters={
                "steps": self.kept,
                "rejected": self.rejected,
                "evaluations": self.slide.evaluations,
            },
        )

    def _follow(self, observer: Observer | None) -> tuple[Status, str]:
        normal, problem = self.problem.normal, self.problem
        with self._blaming(normal):
            path = path_of(problem)
            place = path.begin()
        with self._blaming(self.law):
            here = self.slide.begin()
            longest = self._longest()
        length = path.length or float(problem.duration)
        step = min(FIRST, longest) * length
        for _ in range(MOST_ATTEMPTS):
            with self._blaming(normal):
                trial = path.attempt(place, step)
            with self._blaming(self.law):
                error, halves = self._try(here, trial)
            allowed = self.tolerance * step / length
            if not error <= allowed and step > SHORTEST * length:
                shrink = SAFETY * (allowed / error) ** 0.5 if math.isfinite(error) else 0.0
                step *= min(max(shrink, SHRINKAGE), 0.9)
                self.rejected += 1
                continue
            self._check(trial, halves)
            here, place = halves[-1].after, trial.place
            self.time, self.rate = path.end(place)
            self.change, self.work = here.change, here.work
            self.kept += 1
            if observer is not None:
                for leg, taken in zip(trial.halves, halves, strict=True):
                    self._show(observer, leg, taken)
            if self.time > LONGEST_CONTACT * float(problem.duration):
                return Status.NOT_SEPARATED, f"After {LONGEST_CONTACT} durations of a Hertz impact."
            if trial.ended:
                return Status.SUCCESS, ""
            # Past a jump, over which the shortest step was taken, errors fall again.
            grow = SAFETY * (allowed / error) ** 0.5 if 0.0 < error <= allowed else GROWTH
            step = min(step * min(grow, GROWTH), longest * length)
        return Status.NOT_SEPARATED, f"After {MOST_ATTEMPTS} attempts."

    def _longest(self) -> float:
        """Return the longest step, over the length of the impact."""
        problem = self.problem
        stiffness = float(self.law.stiffness(problem))
        omega = math.sqrt(stiffness / float(problem.pair.tangential_mass))
        swing = STRETCH * omega * float(problem.duration)
        return min(LONGEST, LARGEST_PHASE_STEP / swing) if swing > 0.0 else LONGEST

    def _try(self, here: Kinematics, trial: Trial) -> tuple[float, list[Taken]]:
        """Return the error of the halves in psi, NaN if anything is not finite, and the halves.

        Nothing is asked of the law beyond the first number that is not finite.
        """
        halves: list[Taken] = []
        if not all(leg.sound for leg in (trial.whole, *trial.halves)):
            return math.nan, halves
        for leg in trial.halves:
            halves.append(self.slide.take(halves[-1].after if halves else here, leg))
            if not halves[-1].finite:
                return math.nan, halves
        whole = self.slide.take(here, trial.whole).after
        parted = abs(whole.change - halves[-1].after.change) / self.velocity_scale
        return SHARE_OF_HALVES * (parted + trial.error), halves

    def _check(self, trial: Trial, halves: list[Taken]) -> None:
        """Pass a step that is to be kept.

        Raises
        ------
        LawFaultError
            If the law did not settle, or there is no finite answer in the shortest step.
        """
        for leg in (trial.whole, *trial.halves):
            if not leg.sound:
                what = faults.shown(tuple(leg.contact))
                raise self._fault(Status.NON_FINITE, what, self.problem.normal)
        for leg, taken in zip(trial.halves, halves, strict=False):
            if not taken.settled:
                raise self._fault(Status.UNSETTLED, "no division found", self.law)
            if not taken.finite:
                if faults.unsound(leg.contact, ()):
                    what = faults.shown(tuple(leg.contact))
                    raise self._fault(Status.NON_FINITE, what, self.problem.normal)
                what = f"force {taken.force}, friction work {taken.after.work}"
                raise self._fault(Status.NON_FINITE, what, self.law)

    def _fault(self, status: Status, what: str, law: Law) -> faults.LawFaultError:
        told = faults.told(law, what, self.kept + 1, self.time)
        return faults.LawFaultError(status, told)

    @contextmanager
    def _blaming(self, law: Law) -> Iterator[None]:
        """Say of what goes wrong within that it was ``law``, at which step and time."""
        try:
            yield
        except faults.LawFaultError as fault:
            raise self._fault(fault.status, fault.detail, law) from fault
        except Exception as error:
            raise self._fault(Status.LAW_RAISED, faults.raised(error), law) from error

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
