"""Spheres of a material that is elastic and viscous, in pressure and shear alike (theory §15)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import attrs
import numpy as np

from contactlab.contracts import (
    NormalContact,
    Tabulated,
    UnfollowedNormalLaw,
    without_tension,
)
from contactlab.contracts.restitution import LEAST_RESTITUTION, restitution
from contactlab.impact.of_speed import interpolate, speed_pairs
from contactlab.impact.scene import Scene
from contactlab.numeric.array_api import Library, Traced
from contactlab.numeric.arrays import plain
from contactlab.numeric.checks import Rule, quantity, refuse
from contactlab.numeric.types import Real
from contactlab_laws.relaxing import Parts, Relaxing
from contactlab_laws.tables.restituted_regions import RESTITUTED_CHI, bound_restitution_error
from contactlab_laws.viscoelastic.relaxation import number_of

#: c above this leaves nothing to rebound with at 30 m/s.
LOSS = Rule(
    lambda value: np.ndim(value) == 0 and 0.0 <= value <= 0.5, "must be one number from 0 to 0.5"
)
#: Options by which e depends on the speed.
BY_SPEED = ("speed_loss", "restitutions")
#: Options by which e is one for all speeds, or follows from the material.
ONE_FOR_ALL = ("restitution", "relaxation_time")
PAIRS = "must be two or more pairs of speed and e"


def pair_speeds(table: object) -> tuple[tuple[float, float], ...]:
    """Return a table of speeds and restitutions as pairs, or refuse it."""
    pairs = speed_pairs("restitutions", table, "e").T
    e = pairs[:, 1]
    if not np.all((e >= 0.0) & (e <= 1.0)):
        remedy = "write [[speed, e], [speed, e]], speeds in m/s"
        raise refuse("restitutions", table, "must have e from 0 to 1", remedy)
    return tuple((float(speed), float(each)) for speed, each in pairs)


@attrs.frozen(kw_only=True)
class Viscoelastic(Relaxing, UnfollowedNormalLaw, Tabulated):
    """A contact of Kelvin-Voigt bodies, whose loss in shear springs share.

    In loading P = k z^0.5 (z + 1.5 A z') over b² = R z, k = (4/3) E* sqrt(R), P in N, positive in
    compression, z' positive while the bodies approach. In unloading the surfaces part where they
    would pull: b² = R (z + A z'), P = k (z + A z')^1.5. Contact ends at b = 0, with a dent of depth
    z left behind that relaxes. The pressure in unloading is a hemisphere.

    Parameters
    ----------
    restitution : float or array, optional
        e of this contact at this speed, from 0 to 1, rebound over approach velocity, without
        friction; one number, or one an impact; 0.9 if neither e nor A is given. Below 0.01 the
        impact has no course, and ``tangential.springs`` answers it as a whole. Where friction
        changes the approach, as of bodies that are no spheres, A follows from e by the mass
        1/W_nn, and the rebound of the body is its own.
    relaxation_time : float, optional
        A in s, a constant of the materials: 1 - e grows as v1^(1/5).
    speed_loss : float, optional
        c in (s/m)^(1/5), of e = 1 - c v1^(1/5).
    restitutions : list of (speed, e), optional
        Measured e at speeds of approach in m/s, which increase; e is linear between them.

    References
    ----------
    Lee & Radok, J. Appl. Mech. 27 (1960) 438-444, doi:10.1115/1.3644020; Ting, J. Appl. Mech. 33
    (1966) 845-854, doi:10.1115/1.3625192, in the form of springs: Popov & Hess, Method of
    Dimensionality Reduction in Contact Mechanics and Friction (2015), ch. 7. The loading is that of
    Kuwabara & Kono, Jpn. J. Appl. Phys. 26 (1987) 1230-1233, doi:10.1143/JJAP.26.1230.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = Relaxing.offers | {"kelvin_voigt"}

    speed_loss: float | None = quantity("(s/m)^(1/5)", rule=LOSS, default=None)
    restitutions: tuple[tuple[float, float], ...] | None = attrs.field(
        default=None,
        converter=attrs.converters.optional(pair_speeds),
        metadata={"unit": "m/s, 1", "range": PAIRS},
    )

    restitution: Real | None = restitution(default=None, least=0.0, per_impact=True)
    number_of = staticmethod(number_of)
    chi_range: ClassVar[tuple[float, float]] = RESTITUTED_CHI

    def __attrs_post_init__(self) -> None:
        by_speed = [name for name in BY_SPEED if getattr(self, name) is not None]
        rivals = [name for name in ONE_FOR_ALL if getattr(self, name) is not None]
        if not by_speed:
            super().__attrs_post_init__()
        elif len(by_speed + rivals) > 1:
            raise ValueError(
                f"{', '.join(by_speed + rivals)}: only one of them may be given; each is the loss"
            )

    def __repr__(self) -> str:
        names = (*ONE_FOR_ALL, *(name for name in BY_SPEED if getattr(self, name) is not None))
        return f"Viscoelastic({', '.join(f'{name}={getattr(self, name)!r}' for name in names)})"

    @property
    def loses(self) -> bool:
        """True if there is any loss."""
        return super().loses or bool(self.speed_loss) or self.restitutions is not None

    def accept(self, scene: Scene) -> None:
        """Refuse a speed outside the table of e."""
        if self.restitution is None and self.relaxation_time is None:
            self.restitution_in(scene)

    def restitution_in(self, scene: Scene) -> Real | None:
        """Return e of each impact at its speed of approach."""
        if self.restitution is not None:
            return super().restitution_in(scene)
        speed = np.asarray(scene.normal_speed)
        e: Real
        if self.restitutions is None:
            e = 1.0 - (self.speed_loss or 0.0) * speed**0.2
            if np.min(e, initial=1.0) < 0.0:
                rule = f"makes e {np.min(e):.3g} at {np.max(speed):.4g} m/s"
                remedy = "e must be at least 0; give less, or slower impacts"
                raise refuse("speed_loss", self.speed_loss, rule, remedy)
        else:
            e = interpolate("restitutions", np.transpose(self.restitutions), speed, "e")
        found: Real = plain(e)
        return found

    def unfollowed_rate(self, scene: Scene) -> Real | None:
        """Return the rate at separation where e is below 0.01: A grows without bound."""
        if self.restitution is None and (self.speed_loss or self.restitutions) is None:
            return None
        e = self.restitution_in(scene)
        assert e is not None
        if isinstance(e, float):
            return -e * scene.normal_speed if e < LEAST_RESTITUTION else None
        hardly = np.less(e, LEAST_RESTITUTION)
        return np.where(hardly, -e * scene.normal_speed, np.nan) if hardly.any() else None

    def respond(self, state: Parts, approach: Real, rate: Real) -> tuple[NormalContact, Parts]:
        """Return force and radius; surfaces that meet again have Hertz's contact (2)."""
        inside: Any = approach * (approach > 0.0)
        lead: Real = state.time * rate
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
    def rebound_error(*impact: Real) -> Real:
        """Return the bound of the table, and that of springs beyond the table."""
        return bound_restitution_error(*impact)

    @staticmethod
    def table_of_arrays() -> Mapping[str, Any]:
        """Return the table of restitutions, and the elastic one under names of its own."""
        from contactlab_laws.tables import traced  # only for arrays of other libraries

        return traced.list_constants()

    @staticmethod
    def rebound_of_arrays(
        xp: Library, tables: Mapping[str, Traced], *impact: Traced, **options: Any
    ) -> Traced:
        """Return psi2 of psi1, chi and restitutions."""
        from contactlab_laws.tables import traced

        return traced.rebound_with_loss(xp, tables, *impact, **options)
