"""The march that every fixed-step scheme shares: drift, ask the law, kick."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from contactlab.checks import Real
from contactlab.contracts import (
    Increment,
    Motion,
    NormalContact,
    Observer,
    Problem,
    Run,
    RunningTangentialLaw,
    Sample,
    SteppedTangentialLaw,
)
from contactlab.status import Status


class Step(NamedTuple):
    """One step of the normal motion, as the tangential march needs it.

    The schemes differ only in where they sample the contact and how long they drift and kick.

    Attributes
    ----------
    contact : NormalContact
        At the sample.
    drift : float or array
        Time from the last sample to this one, in s: slip velocity acts on displacement.
    kick : float or array
        Time in s for which the force found at the sample acts on velocity.
    normal_force : float or array
        Mean of P over the kick, in N.
    time, approach, rate : float or array
        At the sample, for the observer.
    """

    contact: NormalContact
    drift: Real
    kick: Real
    normal_force: Real
    time: Real
    approach: Real
    rate: Real


class NormalEnd:
    """How the normal motion ended; filled in by the scheme that produces the steps."""

    duration: Real = math.nan
    rate: Real = math.nan
    separated: bool = True


def march(
    problem: Problem, steps: Iterable[Step], end: NormalEnd, observer: Observer | None
) -> Motion:
    """Follow the tangential motion along ``steps``.

    The change of velocity is summed apart from the velocity, which may be so large
    that it would swallow the change (theory §8).
    """
    law, single = problem.tangential, not problem.shape
    assert isinstance(law, SteppedTangentialLaw)
    if single and observer is None and isinstance(law, RunningTangentialLaw):
        return march_at_once(problem, law, steps, end)
    initial = problem.slip_velocity
    mass = problem.pair.tangential_mass
    change: Real = 0.0 if single else np.zeros(problem.shape)
    work: Real = 0.0 if single else np.zeros(problem.shape)
    nothing = 0.0 * change
    before = NormalContact(nothing, nothing, nothing)
    state = law.start(problem)
    status, detail, count = Status.SUCCESS, "", 0
    velocity: Real = initial
    for step in steps:
        change_per_force = step.kick / mass  # once: often the same for a whole batch
        arresting = velocity / change_per_force
        increment = Increment(
            velocity * step.drift, velocity, arresting, step.normal_force, step.kick
        )
        response, state = law.advance(state, increment, before, step.contact)
        force = response.force
        change = change - force * change_per_force
        work = work + response.friction_work
        before = step.contact
        count += 1
        if observer is not None:
            middle = velocity - 0.5 * force * change_per_force
            observer(_sample(step, middle, force, law, state))
        velocity = initial + change
        if response.settled is not True and not np.all(response.settled):
            status = Status.UNSETTLED
        elif not (math.isfinite(force) if single else np.isfinite(force).all()):
            status = Status.NON_FINITE
        if status is not Status.SUCCESS:
            detail = f"At step {count}, from {type(law).__name__}."
            break
    return _ended(problem, end, change, work, status, detail, count)


def _ended(
    problem: Problem,
    end: NormalEnd,
    change: Real,
    work: Real,
    status: Status,
    detail: str,
    count: int,
) -> Motion:
    """Return the motion, after a last look at how the normal motion ended."""
    if status is Status.SUCCESS and not np.all(np.isfinite(end.rate)):
        status, detail = Status.NON_FINITE, f"From {type(problem.normal).__name__}."
    elif status is Status.SUCCESS and not end.separated:
        status, detail = Status.NOT_SEPARATED, f"After {count} steps."
    return Motion(
        duration=_spread(end.duration, problem.shape),
        normal_velocity=_spread(end.rate, problem.shape),
        slip_velocity_change=_spread(change, problem.shape),
        friction_work=_spread(work, problem.shape),
        status=np.full(problem.shape, status, dtype=object) if problem.shape else status,
        detail=detail,
        counters={"steps": count},
    )


def march_at_once(
    problem: Problem, law: RunningTangentialLaw, steps: Iterable[Step], end: NormalEnd
) -> Motion:
    """Follow the tangential motion of one impact with a law that takes all steps at once."""
    course = list(steps)
    numbers = np.array([(*step.contact[:2], step.drift, step.kick) for step in course])
    mass, initial = float(problem.pair.tangential_mass), float(problem.slip_velocity)
    if not np.isfinite(numbers).all():
        count = int(np.isfinite(numbers).all(axis=1).argmin())
        detail = f"At step {count + 1}, from {type(problem.normal).__name__}."
        return _ended(problem, end, math.nan, math.nan, Status.NON_FINITE, detail, count)
    force, radius, drift, kick = numbers.T
    response = law.run(problem, Run(force, radius, drift, kick, initial, mass))
    count = len(response.force)
    change = -float(np.sum(response.force * numbers[:count, 3] / mass))
    status, detail = Status.SUCCESS, ""
    if not response.settled:
        status, detail = Status.UNSETTLED, f"At step {count + 1}, from {type(law).__name__}."
    elif not math.isfinite(change):
        status, detail = Status.NON_FINITE, f"From {type(law).__name__}."
    return _ended(problem, end, change, response.friction_work, status, detail, count)


def _sample(
    step: Step, velocity: Real, force: Real, law: SteppedTangentialLaw, state: object
) -> Sample:
    return Sample(
        time=step.time,
        approach=step.approach,
        normal_velocity=step.rate,
        contact=step.contact,
        slip_velocity=velocity,
        tangential_force=force,
        fields=lambda: law.fields(state),
    )


def _spread(value: Real, shape: tuple[int, ...]) -> Real:
    return np.array(np.broadcast_to(value, shape)) if shape else float(value)
