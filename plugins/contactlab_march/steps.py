"""How many fixed steps an impact needs, and what is done if fewer were asked for."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from contactlab.contracts import Motion, Problem, SteppedTangentialLaw
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
    follow: Callable[[Problem, int], Motion],
    *,
    one_time_axis: bool,
) -> Motion:
    """Follow ``problem`` with enough steps: refine, or refuse with the number needed.

    Each impact of a batch takes the steps that it would take alone, unless a history asks
    for ``one_time_axis``.
    """
    needed, shape = needed_steps(problem), problem.shape
    taken = np.broadcast_to(steps_for(steps, refine, problem), np.shape(needed))
    followed = (needed <= taken) & (taken <= MOST_STEPS)
    if np.all(followed) and (one_time_axis or np.min(taken) == np.max(taken)):
        return follow(problem, int(np.max(taken)))
    if not shape or one_time_axis:
        return Motion.nothing(shape, Status.TOO_FEW_STEPS, _refusal(steps, np.max(needed)))
    taken = np.broadcast_to(np.where(followed, taken, 0), shape)
    needed = np.broadcast_to(needed, shape)
    parts = []
    for count in np.unique(taken).tolist():
        where = taken == count
        if count:
            motion = follow(problem.take(where), int(count))
        else:
            detail = [_refusal(steps, number) for number in needed[where].tolist()]
            motion = Motion.nothing((len(detail),), Status.TOO_FEW_STEPS, detail)
        parts.append((where, motion))
    return Motion.merged(parts, shape)


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
