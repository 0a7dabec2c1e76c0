"""What a method may be wrong by: its declared error, and the invariants that bind every method.

Errors are taken over the *range* of a scene: the change of slip velocity lies between 0 and the
lesser of what friction can do in a whole impact of slip (4 chi in psi) and twice the velocity it
starts with (|psi2| <= |psi1|). So an error of 1 is an answer that says nothing, at any psi1, chi
and friction coefficient, zero and huge ones included.

The error model, in that measure:

    time steps   STEP (1 + sqrt(chi))/N + PHASE chi^1.5/N²
    parts        PART (1 + sqrt(chi))/n
    tolerance    TOLERANCE t max(1, |psi1|), in psi

A contact oscillates with a frequency that grows as sqrt(chi). The first term is what changes
between stick and slip cost that fall between two steps; the second the phase error of a
symplectic scheme, (omega dt)² over the number of oscillations. The constants are two to three
times what was measured over chi from 0.05 to 1000, psi1 from 0.01 to 4 chi - 1, n from 1 to 50 and
N from the stability limit to 256 times it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab.contracts import Integrator, TangentialLaw
from contactlab.result import ImpactResult
from contactlab.scene import Scene

STEP, PHASE, PART = 1.0, 2.0, 0.5
#: Tolerances are aims: of an adaptive scheme the error per unit of its path is held, and what a
#: law that is not smooth (annuli) does within a step is not all seen.
TOLERANCE = 50.0
#: Rounding, over the range.
ROUNDING = 1e-9
#: Energy books, over the energy at the start: an integrator that controls its error adds up
#: friction work less accurately than velocities.
BOOKS = 1e-5
#: However coarse a method is, energy from nothing beyond this is wrong.
LARGEST_GAIN = 0.1
#: The normal motion of an explicit scheme: |1 - e| <= NORMAL/N², and never beyond the largest.
NORMAL, LARGEST_NORMAL = 1.0, 0.1
#: An answer whose declared error is more than this share of the range has no digit: it is
#: counted as coarse.
COARSE = 0.25


class Range(NamedTuple):
    """Of one scene, in m/s: the unit of psi, the range of the change, and |v_x|."""

    unit: float
    width: float
    speed: float


def range_of(scene: Scene) -> Range:
    """Return the range in which the change of slip velocity must lie."""
    pair = scene.pair
    unit = float(scene.friction_coefficient * scene.normal_speed / pair.stiffness_ratio)
    # 4 chi in psi, without forming psi, which is infinite without friction.
    grip = 2.0 * float(
        scene.friction_coefficient * scene.normal_speed * (pair.normal_mass / pair.tangential_mass)
    )
    speed = abs(float(scene.slip_velocity))
    return Range(unit, min(grip, 2.0 * speed), speed)


def declared(
    tangential: TangentialLaw, integrator: Integrator, scene: Scene, taken: int | None = None
) -> float:
    """Return the declared error of the change of slip velocity, over the range of ``scene``.

    ``taken`` is the number of steps that a run took, where it refined those asked for.
    """
    growth = 1.0 + float(scene.chi) ** 0.5
    bound = ROUNDING
    for law in (tangential, integrator):
        if law.resolution == "steps":
            steps = taken or int(getattr(law, law.resolution))
            bound += STEP * growth / steps + PHASE * float(scene.chi) ** 1.5 / steps**2
        elif law.resolution and law.resolution != "tolerance":
            bound += PART * growth / float(getattr(law, law.resolution))
    tolerance = _tolerance(integrator)
    within = range_of(scene)
    if tolerance and within.width > 0.0:
        bound += TOLERANCE * tolerance * max(within.unit, within.speed) / within.width
    return bound


def broken_invariants(result: ImpactResult, bound: float, *, passive: bool = True) -> list[str]:
    """Return the laws of physics (theory §7) that a result breaks beyond what is declared.

    ``passive`` is False for a law whose model itself makes energy.
    """
    scene, motion = result.scene, result.motion
    _, width, speed = range_of(scene)
    change, rate = float(motion.slip_velocity_change), float(motion.normal_velocity)
    numbers = (change, rate, float(motion.duration), float(motion.friction_work))
    if not np.all(np.isfinite(numbers)):
        return ["a number that is not finite"]
    if width == 0.0:
        return [] if change == 0.0 else ["a change of velocity where nothing can act"]
    broken = []
    allowed = min(bound, LARGEST_GAIN)
    along = -change * np.sign(float(scene.slip_velocity))
    if along < -allowed * width and passive:
        broken.append("friction speeds the slip up")
    gripped = width < 2.0 * speed  # the range is that of slip throughout, 4 chi
    if along > (1.0 + allowed) * width and (passive or gripped):
        broken.append("|psi2 - psi1| > 4 chi" if gripped else "|psi2| > |psi1|")
    if not passive:
        return broken
    books = result.energy
    scale = 0.5 * float(scene.pair.normal_mass * scene.normal_speed**2)
    scale += float(scene.pair.tangential_mass) * width * speed
    if not abs(float(books.imbalance)) <= max(bound, BOOKS) * scale:
        broken.append("energy books do not close")
    if float(books.friction_work) < -allowed * scale:
        broken.append("friction does work on the bodies")
    return broken


def normal_error_allowed(integrator: Integrator, taken: int | None = None) -> float:
    """Return the largest |1 - e| of an elastic impact that the integrator may make."""
    if integrator.resolution == "steps":
        steps = taken or int(getattr(integrator, integrator.resolution))
        return min(NORMAL / steps**2, LARGEST_NORMAL) + ROUNDING
    return TOLERANCE * (_tolerance(integrator) or 0.0) + ROUNDING


def _tolerance(integrator: Integrator) -> float | None:
    found = getattr(integrator, "tolerance", None)
    return None if found is None else float(found)
