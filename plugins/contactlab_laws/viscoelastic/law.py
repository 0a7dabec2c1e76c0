"""Spheres of a material that is elastic and viscous, in pressure and shear alike (theory §15)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import attrs

from contactlab.contracts import NormalContact, Tabulated, without_tension
from contactlab.numeric.checks import Real
from contactlab_laws.relaxing import Parts, Relaxing
from contactlab_laws.viscoelastic.relaxation import number_of


@attrs.frozen(kw_only=True)
class Viscoelastic(Relaxing, Tabulated):
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

    number_of = staticmethod(number_of)

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

    @staticmethod
    def table_of_arrays() -> Mapping[str, Any]:
        """Return the table of restitutions, and the elastic one under names of its own."""
        from contactlab_laws.tables import traced  # only for arrays of other libraries

        return traced.restituted_constants()

    @staticmethod
    def rebound_of_arrays(xp: Any, tables: Any, *impact: Any, **options: Any) -> Any:
        """Return psi2 of psi1, chi and restitutions."""
        from contactlab_laws.tables import traced

        return traced.rebound_with_loss(xp, tables, *impact, **options)
