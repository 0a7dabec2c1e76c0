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
    """Return the force of a spring and a dashpot in N, cut off at the limit mu L."""
    # The dashpot acts on the velocity in the middle of the time in which the force acts. The force
    # itself changes that velocity: solving for it keeps the march of second order.
    slowing = 0.5 * increment.duration / tangential_mass
    force = (spring + constant * increment.velocity) / (1.0 + constant * slowing)
    return cut(force, limit)


def cut(value: Real, limit: Real) -> Any:
    """Return ``value`` within plus and minus ``limit``."""
    return np.minimum(np.maximum(value, -limit), limit)
