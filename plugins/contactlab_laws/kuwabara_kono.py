"""Spheres of a material that is elastic and viscous."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import NormalContact, NormalLaw, without_tension
from contactlab.contracts.restitution import one_of_two, restitution
from contactlab.impact.hertz import hertz_scales, hertz_stiffness
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import NON_NEGATIVE, Real, quantity

#: Default restitution, for laws with no relaxation time of their own.
DEFAULT_RESTITUTION = 0.9
#: Tolerance of the integration and of the calibration.
TOLERANCE = 1e-12
#: Greatest A v1/z_max in the calibration, times e: it gives less than any e >= 0.01.
STRONGEST = 10.0


def rebound(number: float) -> float:
    """Return e at A v1/z_max = ``number``, z_max the greatest approach without viscosity."""
    from scipy.integrate import solve_ivp  # not before a law is calibrated

    # u = sqrt(zeta), dT = 2 u dq: u' = V, V' = -2.5 u² (u² + 1.5 A V), smooth from first touch.
    # Contact ends where the force vanishes: V is stationary there.
    def slope(_: float, state: Any) -> list[float]:
        u, rate = state
        return [rate, -2.5 * u * u * (u * u + 1.5 * number * rate)]

    def released(_: float, state: Any) -> float:
        return float(state[0] - max(-1.5 * number * state[1], 0.0) ** 0.5)

    released.terminal, released.direction = True, -1  # type: ignore[attr-defined]
    motion = solve_ivp(
        slope, (0.0, np.inf), [0.0, 1.0], method="DOP853", events=released,
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


class Parts(NamedTuple):
    """Stiffness k in N/m^1.5, 1.5 A in s, and the pair's radius in m."""

    stiffness: Real
    time: Real
    radius: Real


@attrs.frozen(kw_only=True)
class KuwabaraKono(NormalLaw):
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
    offers: ClassVar[frozenset[str]] = frozenset({"radius"})

    restitution: float | None = restitution(default=None)
    relaxation_time: float | None = quantity("s", rule=NON_NEGATIVE, default=None)

    def __attrs_post_init__(self) -> None:
        one_of_two(self, "restitution", "relaxation_time", default=DEFAULT_RESTITUTION)

    @property
    def viscous(self) -> bool:
        """True if there is any loss."""
        return self.restitution not in (None, 1.0) or bool(self.relaxation_time)

    @property
    def similar(self) -> bool:
        """True for a restitution: then motions of all impacts are one but for their scale."""
        return self.restitution is not None

    def start(self, scene: Scene) -> Parts:
        """Return stiffness and relaxation time of the pair; the law has no memory."""
        time: Any = self.relaxation_time
        if self.restitution is not None:
            unit = hertz_scales(scene).approach / scene.normal_speed
            time = viscosity_number(self.restitution) * unit
        return Parts(hertz_stiffness(scene), 1.5 * time, scene.pair.radius)

    def respond(self, state: Parts, approach: Real, rate: Real) -> tuple[NormalContact, Parts]:
        """Return force and Hertz's radius (2)."""
        inside: Any = approach * (approach > 0.0)
        force = state.stiffness * inside**0.5 * (inside + state.time * rate)
        return without_tension(force, (state.radius * inside) ** 0.5, approach), state
