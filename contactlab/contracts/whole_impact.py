"""Answers for a whole impact: the change of slip velocity without following the contact."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import attrs
import numpy as np

from contactlab.contracts.motion import NormalMotion
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Mask, Real


@attrs.frozen(kw_only=True, eq=False)
class WholeImpact:
    """What a law knows of whole impacts, from the scene and the normal motion alone.

    Attributes
    ----------
    where : bool or array of bool
        The impacts of which it is known; broadcasts to the batch shape, as the next two.
    slip_velocity_change : float or array
        In m/s; anything where it is not known.
    friction_work : float or array
        In J, at least 0.
    reason : str
        Why these impacts need not be followed, for the plan: ``"friction coefficient 0"``.
    course : callable, optional
        ``course(load_impulse, friction_load)`` returns the change of slip velocity (m/s) and
        the tangential force (N) at the instants where the integral of the friction load and
        the load itself have these values, for a history. Without it a history has none.
    psi2_error : float or array
        Bound of the numerical error of psi2, rounding aside: 0 for a closed form. NaN, the
        default: not declared.
    """

    where: Mask
    slip_velocity_change: Real
    friction_work: Real
    reason: str
    course: Callable[[Any, Any], tuple[Any, Any]] | None = None
    psi2_error: Real = math.nan


def sliding(
    scene: Scene, normal: NormalMotion, *, where: Mask, reason: str, stops: bool
) -> WholeImpact:
    """Return impacts whose tangential force is mu times the friction load.

    Parameters
    ----------
    scene : Scene
    normal : NormalMotion
    where : bool or array of bool
        The impacts.
    reason : str
        For the plan.
    stops : bool
        Whether the force ends as the slip velocity comes to zero, as between rigid bodies, or
        goes on to separation, as in gross slip of an elastic contact, eq. (45).
    """
    friction, mass = scene.friction_coefficient, scene.pair.tangential_mass
    slip: Any = scene.slip_velocity
    sense, speed = np.sign(slip), abs(slip)
    with np.errstate(all="ignore"):
        impulse: Any = friction * normal.total_load_impulse
        if stops:
            # Where friction stops the slip it takes all of the velocity, to the last bit.
            lost: Any = np.minimum(impulse / mass, speed)
            impulse = np.minimum(impulse, mass * speed)
        else:
            lost = impulse / mass
        # A constant ratio of force to load: the mean velocity is that of before and after.
        work = impulse * (speed - 0.5 * lost)

    def course(load_impulse: Any, load: Any) -> tuple[Any, Any]:
        change = friction * load_impulse / mass
        acting: Any = 1.0
        if stops:
            acting = change < speed
            change = np.minimum(change, speed)
        return -sense * change, sense * friction * load * acting

    return WholeImpact(
        where=where,
        slip_velocity_change=-sense * lost,
        friction_work=work,
        reason=reason,
        course=course,
        psi2_error=0.0,
    )


def no_force(scene: Scene, *, where: Mask, reason: str) -> WholeImpact:
    """Return impacts without any tangential force.

    Parameters
    ----------
    scene : Scene
        One impact or a batch.
    where : bool or array of bool
        Impacts of which this is known.
    reason : str
        For the plan.
    """

    def course(load_impulse: Any, load: Any) -> tuple[Any, Any]:
        nothing = 0.0 * (scene.slip_velocity + load_impulse + load)
        return nothing, nothing

    return WholeImpact(
        where=where,
        slip_velocity_change=0.0,
        friction_work=0.0,
        reason=reason,
        course=course,
        psi2_error=0.0,
    )
