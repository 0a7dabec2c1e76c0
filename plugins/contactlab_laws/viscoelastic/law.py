"""Spheres of a material that is elastic and viscous, in pressure and shear alike (theory §15)."""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import attrs

from contactlab.contracts import NormalContact, NormalLaw, Tabulated, without_tension
from contactlab.contracts.restitution import one_of_two, restitution
from contactlab.impact.hertz import hertz_scales, hertz_stiffness
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import NON_NEGATIVE, Real, quantity
from contactlab_laws.viscoelastic.relaxation import number_of

#: Default restitution, for laws with no relaxation time of their own.
DEFAULT_RESTITUTION = 0.9


class Parts(NamedTuple):
    """Stiffness k in N/m^1.5, relaxation time A in s, and the pair's radius in m."""

    stiffness: Real
    time: Real
    radius: Real


@attrs.frozen(kw_only=True)
class Viscoelastic(NormalLaw, Tabulated):
    """A contact of Kelvin-Voigt bodies, whose loss in shear springs share.

    In loading P = k z^0.5 (z + 1.5 A z') over b² = R z, k = (4/3) E* sqrt(R), P in N, positive in
    compression, z' positive while the bodies approach. In unloading the surfaces part where they
    would pull: b² = R (z + A z'), P = k (z + A z')^1.5. Contact ends at b = 0, with a dent of depth
    z left behind that relaxes. The pressure in unloading is a hemisphere.

    Parameters
    ----------
    restitution : float, optional
        e of this contact at this speed, rebound over approach velocity, without friction; 0.9 if
        neither e nor A is given. Where friction changes the approach, as of bodies that are no
        spheres, A follows from e by the mass 1/W_nn, and the rebound of the body is its own.
    relaxation_time : float, optional
        A in s, a constant of the materials: 1 - e grows as v1^(1/5).

    References
    ----------
    Lee & Radok, J. Appl. Mech. 27 (1960) 438-444, doi:10.1115/1.3644020; Ting, J. Appl. Mech. 33
    (1966) 845-854, doi:10.1115/1.3625192, in the form of springs: Popov & Hess, Method of
    Dimensionality Reduction in Contact Mechanics and Friction (2015), ch. 7. The loading is that of
    Kuwabara & Kono, Jpn. J. Appl. Phys. 26 (1987) 1230-1233, doi:10.1143/JJAP.26.1230.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"radius", "kelvin_voigt"})

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
            time = number_of(self.restitution) * unit
        return Parts(hertz_stiffness(scene), time, scene.pair.radius)

    def respond(self, state: Parts, approach: Real, rate: Real) -> tuple[NormalContact, Parts]:
        """Return force and radius; where the contact was left behind, it is Hertz's (2) anew."""
        inside: Any = approach * (approach > 0.0)
        lead: Any = state.time * rate
        edge = inside + lead * (lead < 0.0)
        edge = edge * (edge > 0.0)
        force = state.stiffness * edge**0.5 * (1.5 * (inside + lead) - 0.5 * edge)
        return without_tension(force, (state.radius * edge) ** 0.5, approach), state

    @staticmethod
    def rebound(*impact: Any, **options: Any) -> Any:
        """Return psi2 with the same loss in shear, by the table or by springs."""
        from contactlab_laws.viscoelastic.rebound import rebound  # not for a normal motion

        return rebound(*impact, **options)
