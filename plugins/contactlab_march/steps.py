"""How many fixed steps an impact needs, and what is done if fewer were asked for."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import attrs
import numpy as np

from contactlab.checks import refuse
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
    return np.maximum(np.ceil(steps), LEAST_STEPS)


def remarks(steps: int, refine: bool, problem: Problem) -> tuple[str, ...]:
    """Return what the plan should say of the number of steps."""
    needed = float(np.max(needed_steps(problem)))
    if needed <= steps:
        return ()
    if refine and needed <= MOST_STEPS:
        return (f"steps raised from {steps} to {needed:.0f}: fewer do not resolve the stiffness",)
    return (f"{steps} steps are too few: this scene needs {needed:.6g}",)


def enough(
    steps: int, refine: bool, problem: Problem, follow: Callable[[Problem, int], Motion]
) -> Motion:
    """Follow ``problem`` with enough steps: refine, or refuse with the number needed."""
    needed = needed_steps(problem)
    most = float(np.max(needed))
    if most <= steps or (refine and most <= MOST_STEPS):
        return follow(problem, max(steps, int(most)))
    detail = f"steps = {steps}; this scene needs at least {most:.6g}."
    return Motion.nothing(problem.shape, Status.TOO_FEW_STEPS, detail)


def _is_bool(_: object, attribute: attrs.Attribute[bool], value: object) -> None:
    if not isinstance(value, bool):
        raise refuse(attribute.name, value, "must be True or False")


def refine_field() -> Any:
    """Return the attrs field of ``refine``, True by default."""
    return attrs.field(default=True, validator=_is_bool, metadata={"unit": "1"})
