"""The law of the slip front."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import (
    ClosedFormMotion,
    ManyImpacts,
    ManyPhasedTangentialLaw,
    NormalMotion,
    Phase,
    ScaledContact,
    WholeImpact,
)
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real
from contactlab.numeric.lobatto import Array
from contactlab_laws.fronts.phases import Balanced, FrontPhase, GrossSlip, Stuck
from contactlab_laws.jaeger.gross_slip import gross_slip

#: Rings in which stick and slip are shown; the solution itself knows no rings.
RINGS = 200

#: |2 chi - 1| below which the edge's margin against slip is lost in rounding.
BALANCE = 1e-10
#: 2 chi - 1 up to which an impact that slips first is Balanced too: psi and V never differ by
#: more than this, and what comes after the first slip is lost in rounding.
NARROW = 4e-9
#: Next to psi1 = 1 and chi = 1/2, where both are nearer than this, the edge is at the limit of slip
#: to about as much all the time; solved to 1e-9, it slipped there by mistake, and psi2 was off by
#: up to 3e-7. To CLOSEST, 2,500 impacts agree with one another to 1e-10.
NEAR_LIMIT, CLOSEST = 1e-3, 1e-12
#: Errors add up over many periods: from this chi on answers to 1e-9 differed by up to 8e-11 where
#: psi1 differed by 1e-12. Answers to CLOSE take as long, and do not.
HEAVY_CHI, CLOSE = 100.0, 1e-10


@attrs.frozen(kw_only=True)
class Fronts(ManyPhasedTangentialLaw):
    """The continuum limit of the annulus law, with no discretisation.

    Where the contact sticks and where it slips is a short list of fronts; between changes
    of regime their motion is smooth (theory §§4 and 5).

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5.
    Ciavarella, J. Appl. Mech. 65 (1998) 998-1003, and Jaeger, J. Tribol. 120 (1998) 677-684:
    tangential loading from superposed normal contacts, of which the springs are one form.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"partial_slip"})
    needs: ClassVar[frozenset[str]] = frozenset({"elastic_hertz"})
    linear_below: ClassVar[float] = 1e-8
    finest_together: ClassVar[float] = 1e-9

    @property
    def books_bound(self) -> float:
        """Return 2e-6, which is for ``psi1`` within 1e-8 of 1.

        There the centre goes over to slip as the seventh root of time, and power is resolved less
        well than force. By the default tolerance up to 8e-7 was found there, elsewhere 5e-9.
        """
        return 2e-6

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return those of gross slip too, where (44) and (46) say so."""
        return (*super().whole_impacts(scene, normal), *gross_slip(scene, normal))

    def psi2_error(self, scene: Scene, normal: NormalMotion, steps: Any) -> Real:
        """Return 0: there is no discretisation."""
        return 0.0

    def begin(self, velocity: float, inertia: float, motion: ClosedFormMotion) -> Phase:
        """Return stick below psi1 = 1 (44), else slip; at exactly 1 the inertia decides."""
        ratio = inertia * motion.scaled_mass
        excess, range_of_slip = velocity - 1.0, 2.0 * (ratio - 1.0)
        if 0.0 < excess < range_of_slip <= 2.0 * NARROW:
            # psi2 = -1 - excess (1 - excess/range), to first order in the range
            return Balanced(1.0 + excess - 0.5 * excess * (excess / range_of_slip))
        if velocity > 1.0 or (velocity == 1.0 and ratio <= 1.0):
            return GrossSlip(1)
        if abs(ratio - 1.0) < BALANCE:
            return Balanced(velocity)
        return Stuck((), 0.0, 0.0, 0)

    def tolerance_needed(
        self, velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
    ) -> float:
        """Return ``CLOSEST`` next to psi1 = 1 and chi = 1/2 at once, ``CLOSE`` for large chi."""
        double_chi = inertia * motion.scaled_mass
        if max(abs(velocity - 1.0), abs(double_chi - 1.0)) < NEAR_LIMIT:
            return min(tolerance, CLOSEST)
        return min(tolerance, CLOSE) if double_chi > 2.0 * HEAVY_CHI else tolerance

    def impacts_together(
        self, velocity: Array, inertia: Array, motion: ClosedFormMotion, tolerance: float
    ) -> ManyImpacts:
        """Return the answers to many impacts, integrated from event to event in one call."""
        from contactlab_laws.fronts.many.march import march  # not for one impact

        return march(velocity, inertia, motion, tolerance)

    def phase_fields(
        self,
        normal: ClosedFormMotion,
        phase: Phase,
        contact: ScaledContact,
        slip: float,
        factor: float,
    ) -> Mapping[str, NDArray[Any]]:
        """Return rings of equal width: radius (m), stuck, and the sign of slipping traction.

        ``front`` (m) is the radius within which the contact sticks.
        """
        assert isinstance(phase, FrontPhase)
        front, sign = phase.division(contact, slip)
        ring = (np.arange(RINGS) + 0.5) / RINGS
        touching, inside = ring < contact.radius, ring < front
        shown = sign if factor > 0.0 else -sign
        largest = float(normal.maximum_radius)
        return {
            "radius": largest * ring,
            "front": np.array(largest * front),
            "stuck": touching & inside,
            "slipping": np.where(touching & ~inside, shown, 0).astype(np.int8),
        }
