"""The march that every fixed-step scheme shares: drift, ask the law, kick."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from contactlab import faults
from contactlab.checks import Real
from contactlab.contracts import (
    Increment,
    Law,
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
from contactlab_march.normal_steps import NormalEnd, Step, Table, watched


def march(
    problem: Problem, steps: Iterable[Step], end: NormalEnd, observer: Observer | None
) -> Motion:
    """Follow the tangential motion along ``steps``: all at once if the law can, else one by one."""
    law, single = problem.tangential, not problem.shape
    assert isinstance(law, SteppedTangentialLaw)
    at_once = law if observer is None and isinstance(law, RunningTangentialLaw) else None
    if at_once and single and not isinstance(steps, Table):
        try:
            steps = Table.of(problem, steps)
        except faults.LawFaultError as fault:
            return _ended(problem, end, math.nan, math.nan, fault.status, fault.detail, 0)
    if isinstance(steps, Table):
        if (motion := _unsound(problem, steps, end)) is not None:
            return motion
        fits = at_once and (single or (at_once.runs_batches and len(problem.shape) == 1))
        motion = _all_at_once(problem, at_once, steps, end) if at_once and fits else None
        if motion is not None:
            return motion
    else:
        steps = watched(problem, steps)
    return _one_by_one(problem, law, steps, end, observer)


def _all_at_once(
    problem: Problem, law: RunningTangentialLaw, table: Table, end: NormalEnd
) -> Motion | None:
    """Follow the tangential motion with a law that takes all steps at once, if it will."""
    columns = table.columns
    force, radius = columns.contact[:2]
    mass, initial = problem.pair.tangential_mass, problem.slip_velocity
    try:
        response = law.run(problem, Run(force, radius, columns.drift, columns.kick, initial, mass))
        if response is None:
            return None
        count = len(response.force)
        change = -np.sum(response.force * (columns.kick[:count] / mass), axis=0)
    except Exception as error:
        detail = faults.told(law, f"{faults.raised(error)}, all steps at once", 1)
        return _ended(problem, end, math.nan, math.nan, Status.LAW_RAISED, detail, 0)
    status, detail = Status.SUCCESS, ""
    if not response.settled:
        status, detail = Status.UNSETTLED, faults.told(law, "no division found", count + 1)
    elif not np.isfinite(change).all():
        bad = ~np.isfinite(response.force).reshape(count, -1).all(axis=1)
        step = int(bad.argmax())
        detail = faults.told(law, f"force {faults.shown(response.force[step])}", step + 1)
        status = Status.NON_FINITE
    return _ended(problem, end, change, response.friction_work, status, detail, count)


def _one_by_one(
    problem: Problem,
    law: SteppedTangentialLaw,
    steps: Iterable[Step],
    end: NormalEnd,
    observer: Observer | None,
) -> Motion:
    """Ask the law in every step.

    The change of velocity is summed apart from the velocity, which may be so large
    that it would swallow the change (theory §8).
    """
    single, initial, mass = not problem.shape, problem.slip_velocity, problem.pair.tangential_mass
    change: Real = 0.0 if single else np.zeros(problem.shape)
    work: Real = 0.0 if single else np.zeros(problem.shape)
    nothing = 0.0 * change
    before = contact = NormalContact(nothing, nothing, nothing)
    status, what, count = Status.SUCCESS, "", 0
    velocity: Real = initial
    time: Real = 0.0
    try:
        state = law.start(problem)
        for step in steps:
            time, contact = step.time, step.contact
            count += 1
            change_per_force = step.kick / mass  # once: often the same for a whole batch
            arresting = velocity / change_per_force
            increment = Increment(
                velocity * step.drift, velocity, arresting, step.normal_force, step.kick
            )
            response, state = law.advance(state, increment, before, contact)
            force, lost = response.force, response.friction_work
            if not (single and isinstance(force, float) and isinstance(lost, float)):
                status, what = _checked(problem, force, lost)
                if status is not Status.SUCCESS:
                    break
            change = change - force * change_per_force
            work = work + lost
            before = contact
            if observer is not None:
                middle = velocity - 0.5 * force * change_per_force
                observer(_sample(step, middle, force, law, state))
            velocity = initial + change
            if response.settled is not True and not np.all(response.settled):
                status, what = Status.UNSETTLED, "no division found"
            elif not (math.isfinite(force) if single else np.isfinite(force).all()):
                status, what = Status.NON_FINITE, f"force {faults.shown(force)}"
            if status is not Status.SUCCESS:
                break
    except faults.LawFaultError as fault:
        return _ended(problem, end, change, work, fault.status, fault.detail, count)
    except Exception as error:
        status, what = Status.LAW_RAISED, faults.raised(error)
    if status is Status.SUCCESS:
        return _ended(problem, end, change, work, status, "", count)
    blamed: Law = law
    if faults.unsound(contact, problem.shape):
        blamed, what = problem.normal, faults.shown(tuple(contact))
    detail = faults.told(blamed, what, count, time)
    return _ended(problem, end, change, work, status, detail, count)


def _checked(problem: Problem, *answers: Real) -> tuple[Status, str]:
    """Return what is wrong with a law's answers if they are not real numbers of the right shape."""
    for answer in answers:
        if faults.malformed(answer, problem.shape):
            return Status.MALFORMED, f"the answer {faults.shown(answer)}"
    return Status.SUCCESS, ""


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
        status = Status.NON_FINITE
        detail = faults.told(problem.normal, f"rate {faults.shown(end.rate)}", count, end.duration)
    elif status is Status.SUCCESS and not np.all(np.isfinite(work)):
        status = Status.NON_FINITE
        what = f"friction work {faults.shown(work)}"
        detail = faults.told(problem.tangential, what, count, end.duration)
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


def _unsound(problem: Problem, table: Table, end: NormalEnd) -> Motion | None:
    """Return the motion of a run that is not begun: a normal motion that is not finite.

    Not left to the tangential law: where the force is infinite Coulomb's cap is no cap, and
    the answer would look right.
    """
    columns = table.columns
    for column in (*columns.contact[:2], columns.drift, columns.kick, columns.normal_force):
        if not np.isfinite(column).all():
            bad = ~np.isfinite(column).reshape(len(column), -1).all(axis=1)
            count, nothing = int(bad.argmax()), math.nan
            what, time = faults.shown(column[count]), columns.time[count]
            detail = faults.told(problem.normal, what, count + 1, time)
            return _ended(problem, end, nothing, nothing, Status.NON_FINITE, detail, count)
    return None


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
