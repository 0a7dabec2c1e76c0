"""The law of the half-space on rings and angles."""

from __future__ import annotations

from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import NormalMotion, WholeImpact, WholeImpactTangentialLaw
from contactlab.impact.coupling import coupling_number
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import choice, count, flag, refuse
from contactlab.numeric.types import Real
from contactlab_halfspace.groups import Options
from contactlab_halfspace.whole_impacts import own_answers
from contactlab_laws.differences import table as differences
from contactlab_laws.jaeger.partial_slip import gross_slip, hemisphere

#: Energy that one-way coupling loses by nature, over that at the start and Lambda²; at most at the
#: largest Lambda that was measured.
ONE_WAY_LOSS, LARGEST_LOSS = 0.14, 4.0

#: Most rings of tractions along one direction, and of vectors, whose matrices take 250 MB at 96.
MOST_RINGS, MOST_OF_VECTORS = 256, 96


@attrs.frozen(kw_only=True)
class HalfSpace(WholeImpactTangentialLaw):
    """Friction over a three-dimensional elastic half-space, with Coulomb's law at every point.

    Tractions are vectors on rings and angles; every displacement follows in closed form. Nothing
    is left out but the curvature of the surfaces: neither the terms in cos 2 theta and sin 2 theta,
    nor the coupling of pressure and slip between unlike bodies. The law follows the impact by
    itself, in steps that end with the contact edge on an edge of a ring. Without coupling and with
    more than one angle it answers spin about the normal (theory §17).

    Parameters
    ----------
    rings : int
        Rings within the largest contact; an even number with ``extrapolate``. At 32 rings psi2 is
        known to about 5e-5 along one direction, with coupling to about 2e-3.
    angles : int
        Angles on the half circle; one angle is the axisymmetric problem, with tractions along
        the slip velocity. Eight angles and sixteen differ by at most 3e-4 in psi2; with spin about
        the normal by 1e-3 for w up to 0.5, and by 5e-3 beyond.
    coupling : str
        ``"none"``: pressure and slip of unlike bodies do not act on each other. ``"one_way"``:
        pressure drags the surfaces sideways. ``"two_way"``: traction changes the pressure and
        the normal motion too, so that no energy is lost but by friction.
    extrapolate : bool
        Follow the impact over half the rings too: the difference is declared as the error, and
        without coupling psi2 is extrapolated from both, as the error falls as 1/rings².

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5, without its
    approximation below eq. (12). Theory §9.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"normal_spin"})
    needs: ClassVar[frozenset[str]] = frozenset({"radius", "elastic_hertz"})
    resolution: ClassVar[str | None] = "rings"

    rings: int = count(default=32, least=4, most=MOST_RINGS)
    angles: int = count(default=8, most=32)
    coupling: str = choice("none", "one_way", "two_way", default="none")
    extrapolate: bool = flag(default=True)

    def __attrs_post_init__(self) -> None:
        if self.angles == 1 and self.coupling != "none":
            raise refuse(
                "angles",
                self.angles,
                f"must be at least 2 with coupling = {self.coupling!r}, which drags radially",
                "give angles=8",
            )
        if self.extrapolate and self.rings % 2:
            raise refuse(
                "rings",
                self.rings,
                "must be even, for the impact is followed over half as many too",
                "give an even number, or extrapolate=False",
            )
        if self.angles > 1 and self.rings > MOST_OF_VECTORS:
            raise refuse(
                "rings",
                self.rings,
                f"must be at most {MOST_OF_VECTORS} with more than one angle: matrices grow as "
                "rings³",
                "give fewer rings, or angles=1",
            )

    def waives(self) -> frozenset[str]:
        """Return the words of another coupling.

        Slip and spin are one without coupling and with more than one angle; two-way coupling finds
        the pressure, from elastic surfaces.
        """
        needed = self._options.spins, self.coupling == "two_way"
        words = zip(("normal_spin", "elastic_hertz"), needed, strict=True)
        return frozenset(word for word, holds in words if not holds)

    @property
    def _options(self) -> Options:
        return Options(self.rings, self.angles, self.coupling, self.extrapolate)

    def books_bound(self, scene: Scene) -> Real:
        """Return the imbalance of the books: one-way coupling loses up to 0.14 Lambda²."""
        if self.coupling != "one_way":
            return 0.02
        number = np.minimum(coupling_number(scene), LARGEST_LOSS)
        bound: Real = 0.02 + ONE_WAY_LOSS * number * number
        return bound

    def accept(self, scene: Scene) -> None:
        """Refuse two-way coupling where the friction coefficient is 1 by choice of units."""
        if self.coupling == "two_way" and scene.unit_friction and np.any(scene.pair.dundurs_beta):
            raise refuse(
                "friction_coefficient",
                None,
                "must be given with two-way coupling, for mu beta lifts the surfaces",
                "give Scene.nondimensional(..., friction_coefficient=0.3)",
            )

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the answers in closed form, and those of the march."""
        known = super().whole_impacts(scene, normal)
        if self.coupling == "none" and self.angles == 1:
            known = (*known, *gross_slip(scene, normal))
        return (*known, *own_answers(self._options, scene, normal, known))

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the caution of coupling, if it is left out, and of the pressure."""
        own = differences.choice(scene, normal)
        if self.coupling != "two_way":
            own = (*own, *hemisphere(normal))
        left_out = super().cautions(scene, normal) if self.coupling == "none" else ()
        return (*left_out, *own)
