"""How many fixed steps an impact needs, and what is done if fewer were asked for."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    ClosedFormNormalLaw,
    Motion,
    Observer,
    Problem,
    SteppedTangentialLaw,
)
from contactlab.status import Status

#: Largest omega dt of the fastest tangential oscillation. At 2 the leapfrog is unstable (theory
#: §4) and wrong by any amount; below it is stable, but useless well before: at 1/2 the
#: phase is off by 1 % a radian.
LARGEST_PHASE_STEP = 0.5
#: The leapfrog's phase runs ahead by (omega dt)²/24 a radian. Where microslip damps the oscillation
#: that is forgotten with it; where a law has none it adds up over the impact, to no more than
#: this, in radians: an error of up to a third of it over the range, whatever chi.
LARGEST_LEAD = 0.05
#: The normal motion is half an oscillation, and is resolved alike whatever the tangential law:
#: in 1 or 2 explicit steps the bodies part many times as fast as they met, in 7 e - 1 = 3e-3.
LEAST_STEPS = math.ceil(math.pi / LARGEST_PHASE_STEP)
#: More steps than this are refused, whoever asks for them.
MOST_STEPS = 2_000_000
#: A contact that lasts longer than this many Hertz durations is given up.
LONGEST_CONTACT = 10
#: Steps that a contact must last where the normal law is no Hertz contact, and may be stiffer:
#: those asked for are of a Hertz duration. 20 leave e wrong by less than 1 %.
LEAST_IN_CONTACT = 20
#: Where steps are raised, from one number to the next.
RUNG = 1.25


def needed_steps(problem: Problem) -> Any:
    """Return the least number of steps an impact that resolve omega = sqrt(stiffness/mass).

    A float, or an array of the batch shape; ``LEAST_STEPS`` for a law without stiffness.
    """
    law = problem.tangential
    assert isinstance(law, SteppedTangentialLaw)
    omega = np.sqrt(law.stiffness(problem) / problem.pair.tangential_mass)
    swing = omega * problem.duration
    steps = swing / LARGEST_PHASE_STEP
    if "partial_slip" not in law.offers:
        steps = np.maximum(steps, swing * np.sqrt(swing / (24.0 * LARGEST_LEAD)))
    return np.maximum(np.ceil(steps), float(LEAST_STEPS))


def steps_for(steps: int, refine: bool, problem: Problem) -> Any:
    """Return how many steps each impact takes, more than ``steps`` where those are too few."""
    return _refined(steps, needed_steps(problem)) if refine else float(steps)


def remarks(steps: int, refine: bool, problem: Problem) -> tuple[str, ...]:
    """Return what the plan should say of the number of steps."""
    needed = needed_steps(problem)
    most = float(np.max(needed))
    if most <= steps:
        return ()
    few = np.broadcast_to(needed > steps, problem.shape)
    share = f" for {int(few.sum())} of {few.size} impacts" if few.ndim else ""
    if refine and most <= MOST_STEPS:
        to = int(np.max(_refined(steps, needed)))
        return (f"steps raised from {steps} to {to}{share}: fewer do not resolve the stiffness",)
    return (f"{steps} steps are too few{share}: this scene needs {most:.6g}",)


def enough(
    steps: int,
    refine: bool,
    problem: Problem,
    follow: Callable[[Problem, int, Observer | None], Motion],
    observer: Observer | None,
) -> Motion:
    """Follow ``problem`` with enough steps: refine, or refuse with the number needed.

    Each impact of a batch takes the steps that it would take alone, unless it is observed:
    then all have one time axis.
    """
    if observer is not None:
        return _observed(steps, refine, problem, follow, observer)

    def follow_resolved(problem: Problem, count: int) -> Motion:
        return _resolved(problem, count, refine, follow)

    needed, shape = needed_steps(problem), problem.shape
    taken = np.broadcast_to(steps_for(steps, refine, problem), np.shape(needed))
    followed = (needed <= taken) & (taken <= MOST_STEPS)
    if np.all(followed) and np.min(taken) == np.max(taken):
        return follow_resolved(problem, int(np.max(taken)))
    if not shape:
        return Motion.nothing(shape, Status.TOO_FEW_STEPS, _refusal(steps, needed))
    taken = np.broadcast_to(np.where(followed, taken, 0), shape)
    needed = np.broadcast_to(needed, shape)
    parts = []
    for count in np.unique(taken).tolist():
        where = taken == count
        if count:
            motion = follow_resolved(problem.take(where), int(count))
        else:
            detail = [_refusal(steps, number) for number in needed[where].tolist()]
            motion = Motion.nothing((len(detail),), Status.TOO_FEW_STEPS, detail)
        parts.append((where, motion))
    return Motion.merged(parts, shape)


def _observed(
    steps: int,
    refine: bool,
    problem: Problem,
    follow: Callable[[Problem, int, Observer | None], Motion],
    observer: Observer,
) -> Motion:
    """Follow ``problem`` with as many steps for all as any impact needs."""
    needed = float(np.max(needed_steps(problem)))
    count = float(np.max(steps_for(steps, refine, problem)))
    if needed > count:
        return Motion.nothing(problem.shape, Status.TOO_FEW_STEPS, _refusal(steps, needed))
    if not isinstance(problem.normal, ClosedFormNormalLaw):
        motion = follow(problem, int(count), None)
        while refine and _lasts_few(problem, motion, count).any() and 4 * count <= MOST_STEPS:
            count *= 4
            motion = follow(problem, int(count), None)
        if _lasts_few(problem, motion, count).any():
            return _too_short(problem, motion, count)
    return follow(problem, int(count), observer)


def _resolved(
    problem: Problem,
    count: int,
    refine: bool,
    follow: Callable[[Problem, int, Observer | None], Motion],
) -> Motion:
    """Follow ``problem``, again and finer where the contact lasted too few steps."""
    motion = follow(problem, count, None)
    if isinstance(problem.normal, ClosedFormNormalLaw):
        return motion
    few = _lasts_few(problem, motion, count)
    if not few.any():
        return motion
    if not refine or 4 * count > MOST_STEPS:
        return _too_short(problem, motion, count)
    if not problem.shape:
        return _resolved(problem, 4 * count, refine, follow)
    finer = _resolved(problem.take(few), 4 * count, refine, follow)
    return Motion.merged(((np.ones_like(few), motion), (few, finer)), problem.shape)


def _lasts_few(problem: Problem, motion: Motion, count: float) -> NDArray[np.bool_]:
    """Say which contacts lasted fewer than ``LEAST_IN_CONTACT`` steps."""
    lasted: Any = motion.duration / (problem.duration / count)
    good: Any = np.asarray(motion.status, dtype=object) == Status.SUCCESS
    return np.asarray(good & (lasted < LEAST_IN_CONTACT))


def _too_short(problem: Problem, motion: Motion, count: float) -> Motion:
    """Return ``motion`` with the status of those contacts that lasted too few steps."""
    short = float(np.min(motion.duration / problem.duration)) * count
    told = (
        f"The contact lasted {short:.2g} of {count:.6g} steps in a Hertz duration: the normal law "
        f"is stiffer, and needs at least {LEAST_IN_CONTACT * count / short:.2g}."
    )
    return motion.failing(_lasts_few(problem, motion, count), Status.TOO_FEW_STEPS, told)


def _refined(steps: int, needed: Any) -> Any:
    """Return ``steps``, or the first rung of a ladder up from there that is enough.

    With rungs the impacts of a batch fall into a few groups of equal steps.
    """
    ladder = [float(steps)]
    while ladder[-1] < min(float(np.max(needed)), MOST_STEPS):
        ladder.append(min(math.ceil(ladder[-1] * RUNG), MOST_STEPS))
    ladder.append(np.inf)
    return np.array(ladder)[np.searchsorted(ladder, needed)]


def _refusal(steps: int, needed: float) -> str:
    return f"steps = {steps}; this scene needs at least {needed:.6g}."
