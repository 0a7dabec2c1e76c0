"""A dashpot beside a spring whose force is cut off at Coulomb's limit."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.contracts import Increment
from contactlab.numeric.checks import Real


def critical_share(share: float, stiffness: Real, mass: Real) -> Any:
    """Return 2 share sqrt(stiffness mass), the constant of a dashpot in N s/m."""
    return 2.0 * share * np.sqrt(stiffness * mass)


def with_dashpot(
    spring: Real, constant: Real, increment: Increment, tangential_mass: Real, limit: Real
) -> Any:
    """Return the force of a spring and a dashpot, cut off at the limit, in N.

    The dashpot acts on the velocity in the middle of the time in which the force acts, which the
    force itself changes: that is solved for, and leaves a march of second order.

    Parameters
    ----------
    spring : float or array
        Force of the spring, in N.
    constant : float or array
        Of the dashpot, in N s/m.
    increment : Increment
    tangential_mass : float or array
        In kg.
    limit : float or array
        mu times the friction load, in N.
    """
    slowing = 0.5 * increment.duration / tangential_mass
    force = (spring + constant * increment.velocity) / (1.0 + constant * slowing)
    return cut(force, limit)


def cut(value: Real, limit: Real) -> Any:
    """Return ``value``, brought to within plus and minus ``limit``."""
    return np.minimum(np.maximum(value, -limit), limit)
