"""Spheres of a material that is elastic and viscous."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import NormalContact, without_tension
from contactlab.numeric.types import Array, Real
from contactlab_laws.relaxing import Parts, Relaxing

#: Tolerance of the integration and of the calibration.
TOLERANCE = 1e-12
#: Greatest A v1/z_max in the calibration, times e: it gives less than any e >= 0.01.
STRONGEST = 10.0


def rebound(number: float) -> float:
    """Return e at A v1/z_max = ``number``, z_max the greatest approach without viscosity."""
    from scipy.integrate import solve_ivp  # not before a law is calibrated

    # u = sqrt(zeta), dT = 2 u dq: u' = V, V' = -2.5 u² (u² + 1.5 A V), smooth from first touch.
    # Contact ends where the force vanishes: V is stationary there.
    def slope(_: float, state: Sequence[float] | Array) -> list[float]:
        u, rate = state
        return [rate, -2.5 * u * u * (u * u + 1.5 * number * rate)]

    def release(_: float, state: Sequence[float] | Array) -> float:
        return float(state[0] - max(-1.5 * number * state[1], 0.0) ** 0.5)

    release.terminal, release.direction = True, -1  # type: ignore[attr-defined]
    motion = solve_ivp(
        slope, (0.0, np.inf), [0.0, 1.0], method="DOP853", events=release,
        rtol=TOLERANCE, atol=TOLERANCE,
    )  # fmt: skip
    return -float(motion.y[1, -1])


@lru_cache(maxsize=256)
def viscosity_number(coefficient: float) -> float:
    """Return A v1/z_max at a coefficient of restitution."""
    from scipy.optimize import brentq

    if coefficient == 1.0:
        return 0.0
    elastic = rebound(0.0)  # 1 but for the tolerance: a coefficient may be nearer to 1
    number = brentq(
        lambda trial: rebound(trial) / elastic - coefficient,
        0.0,
        STRONGEST / coefficient,
        xtol=TOLERANCE,
    )
    return float(number)


@attrs.frozen(kw_only=True)
class KuwabaraKono(Relaxing):
    """Hertz contact of viscoelastic spheres, to first order in the viscosity.

    P = k z^0.5 (z + 1.5 A z'), k = (4/3) E* sqrt(R), P in N, positive in compression, z' positive
    while the bodies approach. Contact ends where P returns to zero: no tension. The elastic
    pressure is a hemisphere over b² = R z, the viscous one that of a flat punch.

    Parameters
    ----------
    restitution : float, optional
        e, rebound over approach velocity, the same at any speed; 0.9 if neither e nor A is
        given.
    relaxation_time : float, optional
        A in s, a constant of the materials: 1 - e grows as v1^(1/5).

    References
    ----------
    Kuwabara & Kono, Jpn. J. Appl. Phys. 26 (1987) 1230-1233, doi:10.1143/JJAP.26.1230;
    Brilliantov, Spahn, Hertzsch & Pöschel, Phys. Rev. E 53 (1996) 5382-5392,
    doi:10.1103/PhysRevE.53.5382. The end without tension: Schwager & Pöschel, Phys. Rev. E 78
    (2008) 051304, doi:10.1103/PhysRevE.78.051304.
    """

    api_version: ClassVar[int] = 2

    number_of = staticmethod(viscosity_number)

    def respond(self, state: Parts, approach: Real, rate: Real) -> tuple[NormalContact, Parts]:
        """Return force and Hertz's radius (2)."""
        inside: Real = approach * (approach > 0.0)  # type: ignore[assignment]  # float64
        force = state.stiffness * inside**0.5 * (inside + 1.5 * state.time * rate)
        return without_tension(force, (state.radius * inside) ** 0.5, approach), state
