"""What psi2 may be wrong by: the error that a law and an integrator declare for a scene.

Errors are taken over the *range* of a scene: the change of slip velocity lies between 0 and the
lesser of what friction can do in a whole impact of slip (4 chi in psi) and twice the velocity it
starts with (|psi2| <= |psi1|). So an error of 1 is an answer that says nothing, at any psi1, chi
and friction coefficient, zero and huge ones included.

The error model, in that measure:

    time steps   STEP (1 + sqrt(chi))/N + PHASE chi^1.5/N²
    parts        PART (1 + sqrt(chi))/n
    tolerance    TOLERANCE t max(1, |psi1|), in psi

Of a law that is exact whatever the step only the steps of the normal motion count, NORMAL/N².
A contact oscillates with a frequency that grows as sqrt(chi). The first term is what changes
between stick and slip cost that fall between two steps; the second the phase error of a
symplectic scheme, (omega dt)² over the number of oscillations. The constants are two to three
times what was measured over chi from 0.05 to 1000, psi1 from 0.01 to 4 chi - 1, n from 1 to 50 and
N from the stability limit to 256 times it; ``contactlab stability`` holds every answer to them.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.checks import Real
from contactlab.contracts import Integrator, Problem, SteppedTangentialLaw, TangentialLaw
from contactlab.scene import Scene

STEP, PHASE, PART = 1.0, 2.0, 0.5
#: Tolerances are aims: of an adaptive scheme the error per unit of its path is held, and what a
#: law that is not smooth (annuli) does within a step is not all seen.
TOLERANCE = 50.0
#: An explicit normal motion: |1 - e| <= NORMAL/N².
NORMAL = 1.0
#: Rounding, over the range.
ROUNDING = 1e-9
#: An answer whose declared error is more than this share of the range has no digit: it is coarse.
COARSE = 0.25
#: Of what is known in closed form, over max(1, |psi1|).
CLOSED_FORM = 1e-12


class Range(NamedTuple):
    """Of a scene, in m/s: the unit of psi, the range of the change, and |v_x|."""

    unit: Any
    width: Any
    speed: Any


def range_of(scene: Scene) -> Range:
    """Return the range in which the change of slip velocity must lie."""
    pair = scene.pair
    speed: Any = abs(scene.slip_velocity)
    lesser: Any = np.minimum if scene.shape else min
    with np.errstate(over="ignore", under="ignore"):
        friction: Any = scene.friction_coefficient * scene.normal_speed
        # 4 chi in psi, without forming psi, which is infinite without friction.
        grip = 2.0 * (friction * (pair.normal_mass / pair.tangential_mass))
        return Range(friction / pair.stiffness_ratio, lesser(grip, 2.0 * speed), speed)


def declared(
    tangential: TangentialLaw, integrator: Integrator, scene: Scene, steps: Any = None
) -> Any:
    """Return the declared error of the change of slip velocity, over the range of ``scene``.

    ``steps`` are those that a run takes, where it refines those asked for.
    """
    growth: Any = 1.0 + np.sqrt(scene.chi)
    bound: Any = ROUNDING
    if integrator.resolution == "steps":
        count = getattr(integrator, integrator.resolution) if steps is None else steps
        if not tangential.exact:
            bound = bound + STEP * growth / count + PHASE * scene.chi**1.5 / count**2
        elif "closed_form_motion" not in integrator.uses:
            bound = bound + NORMAL / count**2
    if tangential.resolution:
        bound = bound + PART * growth / float(getattr(tangential, tangential.resolution))
    tolerance = tolerance_of(integrator)
    if tolerance:
        unit, width, speed = range_of(scene)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            held = TOLERANCE * tolerance * np.divide(np.maximum(unit, speed), width)
        bound = bound + np.where(np.asarray(width) > 0.0, held, 0.0)
    return bound


def tolerance_of(integrator: Integrator) -> float | None:
    """Return the tolerance of an integrator that has one."""
    found = getattr(integrator, "tolerance", None)
    return None if found is None else float(found)


def is_declared(problem: Problem, integrator: Integrator) -> bool:
    """Say if the error model holds: for elastic Hertz contacts, of laws whose stiffness is known.

    A law of one's own may be stiffer than it says, or not say how fine it is.
    """
    law = problem.tangential
    if "elastic_hertz" not in problem.normal.offers:
        return False
    if any(part.resolution and not hasattr(part, part.resolution) for part in (law, integrator)):
        return False
    if law.exact:
        return True
    return isinstance(law, SteppedTangentialLaw) and bool(np.all(law.stiffness(problem) > 0.0))


def psi2_error(
    scene: Scene, problem: Problem, integrator: Integrator, marched: Any
) -> tuple[Real, Real]:
    """Return the declared error of psi2, and the same over the range; NaN if none is declared.

    ``marched`` says which impacts are followed; the others are known in closed form.
    """
    largest = np.maximum(1.0, np.abs(scene.psi1))
    known = CLOSED_FORM * largest
    if not is_declared(problem, integrator):
        return _only(np.where(marched, np.nan, known)), _only(np.where(marched, np.nan, 0.0))
    unit, width, _ = range_of(scene)
    with np.errstate(all="ignore"):
        scale = np.divide(width, unit)
        if problem.tangential.exact and integrator.accuracy is not None:
            error = integrator.accuracy * largest
            share = np.divide(error, scale)
        else:
            steps = integrator.steps_for(problem)
            share = np.minimum(declared(problem.tangential, integrator, scene, steps), 1.0)
            error = share * scale
    return _only(np.where(marched, error, known)), _only(np.where(marched, share, 0.0))


def told(
    error: Real, share: Real, problem: Problem, integrator: Integrator
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return what a plan should say of the declared error, and what it should warn of."""
    law = problem.tangential
    if law.exact and integrator.accuracy is not None and is_declared(problem, integrator):
        return (), ()  # that it is exact is said already
    worst = float(np.max(error))
    if np.isnan(worst):
        return ("numerical error of psi2: none is declared for these laws",), ()
    most = " at most" if np.ndim(error) else ""
    said = f"numerical error of psi2, declared:{most} {worst:.2g}"
    coarse = np.asarray(share) > COARSE
    if not coarse.any():
        return (said,), ()
    of = f" for {int(coarse.sum())} of {coarse.size} impacts" if coarse.ndim else ""
    finer = " and ".join(part.resolution for part in (law, integrator) if part.resolution)
    exact = "; fronts is exact" if "partial_slip" in law.offers else ""
    return (said,), (
        f"coarse{of}: the declared error is {float(np.max(share)):.2g} of the range of psi2, "
        f"so that no digit is sure; finer {finer} would help{exact}",
    )


def _only(array: Any) -> Real:
    return array if array.ndim else float(array)
