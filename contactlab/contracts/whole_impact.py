"""Whole-impact answers: changes of slip velocity without a march."""

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
    """Whole-impact answer of a law for some impacts of a batch.

    The answer follows from the scene and the normal motion alone.

    Attributes
    ----------
    where : bool or array of bool
        The impacts that the answer holds for; broadcasts to the batch shape, as do
        ``slip_velocity_change`` and ``friction_work``.
    slip_velocity_change : float or array
        Change of v_x in m/s; arbitrary where ``where`` is False.
    friction_work : float or array
        Friction work in J, at least 0.
    reason : str
        Why these impacts need no march, for the plan: ``"friction coefficient 0"``.
    course : callable, optional
        ``course(load_impulse, friction_load)`` returns the change of slip velocity (m/s) and
        the tangential force (N) at the instants that have this integral of the friction load
        and this friction load. Without it slip velocity and force are NaN in a history.
    psi2_error : float or array
        Bound of the numerical error of psi2, rounding aside; 0 for a closed form. NaN, the
        default, means not declared.
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
    """Return the answer for impacts whose tangential force is mu times the friction load.

    Parameters
    ----------
    scene : Scene
        One impact or a batch.
    normal : NormalMotion
        Normal motion of all impacts of ``scene``.
    where : bool or array of bool
        The impacts that the answer holds for.
    reason : str
        Why these impacts need no march, for the plan.
    stops : bool
        If True the force ends when the slip velocity reaches zero, as between rigid bodies. If
        False it acts until separation, as in gross slip of an elastic contact, eq. (45).
    """
    friction, mass = scene.friction_coefficient, scene.pair.tangential_mass
    slip: Any = scene.slip_velocity
    sense, speed = np.sign(slip), abs(slip)
    with np.errstate(all="ignore"):
        impulse: Any = friction * normal.total_load_impulse
        if stops:
            # If friction stops the slip, the slip velocity after is exactly zero.
            lost: Any = np.minimum(impulse / mass, speed)
            impulse = np.minimum(impulse, mass * speed)
        else:
            lost = impulse / mass
        # Force over load is constant: work = impulse times the mean of first and last velocity.
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
    """Return the answer for impacts without tangential force.

    Parameters
    ----------
    scene : Scene
        One impact or a batch.
    where : bool or array of bool
        The impacts that the answer holds for.
    reason : str
        Why these impacts need no march, for the plan.
    """

    def course(load_impulse: Any, load: Any) -> tuple[Any, Any]:
        zero = 0.0 * (scene.slip_velocity + load_impulse + load)
        return zero, zero

    return WholeImpact(
        where=where,
        slip_velocity_change=0.0,
        friction_work=0.0,
        reason=reason,
        course=course,
        psi2_error=0.0,
    )
