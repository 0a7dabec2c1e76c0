"""Hertz's impact in the phase x in [0, pi], for arrays of phases: theory §3."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Contact(NamedTuple):
    """The normal contact at some phases; scaled, all of the shape of the phases."""

    radius: Array  # u = sqrt(zeta)
    approach: Array  # zeta
    rate: Array  # V
    pace: Array  # dT/dx


def contact(phase: Array) -> Contact:
    """Return the contact at ``phase``: u = sin x, V = cos x g(u), dT/dx = 2 u / g(u)."""
    u = np.sin(phase)
    np.maximum(u, 0.0, out=u)
    rate = np.cos(phase)
    approach = u * u
    above = 1.0 + u
    factor = approach * (above + approach)
    factor += above
    np.divide(factor, above, out=factor)
    np.sqrt(factor, out=factor)
    rate *= factor
    pace = 2.0 * u
    pace /= factor
    return Contact(u, approach, rate, pace)


def phase_of_rate(rate: Array) -> Array:
    """Return the phase at which the normal velocity is ``rate``, from V² + zeta^2.5 = 1."""
    u = np.maximum((1.0 - rate) * (1.0 + rate), 0.0) ** 0.2
    factor = np.sqrt((1.0 + u * (1.0 + u * (1.0 + u * (1.0 + u)))) / (1.0 + u))
    return np.asarray(np.arctan2(u, rate / factor))
