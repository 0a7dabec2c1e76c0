"""A spring and a dashpot: linear, and Tsuji's over Hertz's spring."""

from __future__ import annotations

from typing import ClassVar, NamedTuple

import attrs

from contactlab.contracts import (
    ClosedFormMotion,
    ClosedFormNormalLaw,
    NormalContact,
    without_tension,
)
from contactlab.contracts.restitution import TAKEN_RESTITUTION, restitution
from contactlab.impact.hertz import hertz_scales, hertz_stiffness, linear_stiffness
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import POSITIVE, quantity
from contactlab.numeric.types import Real
from contactlab_laws.dashpot.motion import DashpotMotion, ScaledMotion
from contactlab_laws.dashpot.oscillator import damping_of
from contactlab_laws.hertz.motion import HertzMotion


class Parts(NamedTuple):
    """Stiffness k and damping c of P = k z^n + c z^m z', in SI, and the pair's radius."""

    stiffness: Real
    damping: Real
    radius: Real


def press(parts: Parts, approach: Real, rate: Real, powers: tuple[float, float]) -> NormalContact:
    """Return the contact of P = k z^n + c z^m z', ``powers`` (n, m), without tension; b² = R z."""
    touching = approach >= 0.0
    inside: Real = approach * touching  # type: ignore[assignment]  # float64; NaN stays NaN
    damping = parts.damping * inside ** powers[1] * touching
    force = parts.stiffness * inside ** powers[0] + damping * rate
    return without_tension(force, (parts.radius * inside) ** 0.5, approach)


@attrs.frozen(kw_only=True)
class Tsuji(ClosedFormNormalLaw):
    """Hertz's spring with a dashpot that gives the same restitution at any speed.

    P = k z^1.5 + 2 beta sqrt(1.25 M k) z^0.25 z', k = (4/3) E* sqrt(R), in N, positive in
    compression, z' positive while the bodies approach. Contact ends where P returns to zero: no
    tension. beta follows from the restitution, and the motion is known in closed form.

    Parameters
    ----------
    restitution : float
        e, rebound over approach velocity, at most 1.

    References
    ----------
    Tsuji, Tanaka & Ishida, Powder Technol. 71 (1992) 239-250,
    doi:10.1016/0032-5910(92)88030-L. The end without tension: Schwager & Pöschel, Granular
    Matter 9 (2007) 465-469, doi:10.1007/s10035-007-0065-z.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset(
        {"radius", "hertzian_pressure", "elliptic", "viscous"}
    )

    restitution: float = restitution(default=TAKEN_RESTITUTION)

    def waives(self) -> frozenset[str]:
        """Return ``viscous`` without a loss."""
        return frozenset({"viscous"} if self.restitution == 1.0 else ())

    def start(self, scene: Scene) -> Parts:
        """Return stiffness and damping of the pair; the law has no memory."""
        pair = scene.pair
        stiffness = hertz_stiffness(scene)
        critical = 2.0 * (1.25 * pair.normal_mass * stiffness) ** 0.5
        return Parts(stiffness, damping_of(self.restitution) * critical, pair.radius)

    def respond(self, state: Parts, approach: Real, rate: Real) -> tuple[NormalContact, Parts]:
        """Return force and Hertz's radius (2)."""
        return press(state, approach, rate, (1.5, 0.25)), state

    def motion(self, scene: Scene) -> ClosedFormMotion:
        """Return the motion in closed form: an oscillator in zeta^1.25, Hertz's without damping."""
        if self.restitution == 1.0:  # another phase makes this motion smooth
            return HertzMotion.of(self, scene)
        scaled = ScaledMotion(damping_of(self.restitution), 1.25)
        return DashpotMotion.of(self, scene, scaled, hertz_scales(scene).approach)


@attrs.frozen(kw_only=True)
class Linear(ClosedFormNormalLaw):
    """A linear spring and dashpot.

    P = k z + 2 beta sqrt(M k) z', in N, positive in compression; contact ends where P returns to
    zero. beta follows from the restitution, which is the same at any speed. The contact
    radius is taken from Hertz's contact at the same approach, b² = R z.

    Parameters
    ----------
    restitution : float
        e, rebound over approach velocity, at most 1.
    stiffness : float, optional
        k in N/m. By default k = M (v1/z_max)² for each impact: without damping a spring of this
        stiffness reaches the largest approach of Hertz's contact, z_max.

    References
    ----------
    Cundall & Strack, Géotechnique 29 (1979) 47-65, doi:10.1680/geot.1979.29.1.47. Restitution
    without tension: Schwager & Pöschel, Granular Matter 9 (2007) 465-469,
    doi:10.1007/s10035-007-0065-z.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "elliptic"})

    restitution: float = restitution(default=TAKEN_RESTITUTION)
    stiffness: float | None = quantity("N/m", rule=POSITIVE, default=None)

    def start(self, scene: Scene) -> Parts:
        """Return stiffness and damping of the pair; the law has no memory."""
        pair = scene.pair
        stiffness = linear_stiffness(scene) if self.stiffness is None else self.stiffness
        critical = 2.0 * (pair.normal_mass * stiffness) ** 0.5
        return Parts(stiffness, damping_of(self.restitution) * critical, pair.radius)

    def respond(self, state: Parts, approach: Real, rate: Real) -> tuple[NormalContact, Parts]:
        """Return force and radius."""
        return press(state, approach, rate, (1.0, 0.0)), state

    def motion(self, scene: Scene) -> ClosedFormMotion:
        """Return the motion of the oscillator."""
        stiffness = self.start(scene).stiffness
        deepest = scene.normal_speed * (scene.pair.normal_mass / stiffness) ** 0.5
        return DashpotMotion.of(
            self, scene, ScaledMotion(damping_of(self.restitution), 1.0), deepest
        )
