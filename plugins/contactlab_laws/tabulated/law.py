"""The tabulated rebound as a friction law of whole impacts."""

from __future__ import annotations

from functools import reduce
from typing import Any, ClassVar

import attrs
import numpy as np

from contactlab.contracts import NormalMotion, WholeImpact, WholeImpactTangentialLaw
from contactlab.impact.scene import Scene
from contactlab_laws.jaeger.gross_slip import gross_slip
from contactlab_laws.tabulated.coordinates import LARGEST_CHI
from contactlab_laws.tabulated.function import rebound

#: Error of psi2 over max(1, |psi1|), in the table and beyond it: what ``verify`` holds both to.
ERROR = 1e-9
#: Of the energy books, over the energy at the start: the work is what the velocities leave.
ROUNDING = 1e-9
WORK = "friction work from the energy balance, not an independent sum"


@attrs.frozen(kw_only=True)
class Tabulated(WholeImpactTangentialLaw):
    """The exact rebound of elastic spheres, from a table of psi1 and chi.

    Beyond chi = 2.5, where the table ends, impacts are solved, many at once. There is no course
    of the impact, and the energy books are no test: the friction work is what the velocities leave.

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"partial_slip"})
    needs: ClassVar[frozenset[str]] = frozenset({"elastic_hertz"})

    @property
    def books_bound(self) -> float:
        """Return the bound of rounding: the books close by construction."""
        return ROUNDING

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return slip throughout in closed form, and the rest from the table or solved."""
        closed = (*super().whole_impacts(scene, normal), *gross_slip(scene, normal))
        chi: Any = scene.chi
        psi1: Any = scene.psi1
        left: Any = np.logical_not(reduce(np.logical_or, (each.where for each in closed)))
        # Where the closed forms answer no impact is solved, and psi1 may be infinite.
        psi1 = np.where(left, psi1, 0.0) if np.ndim(left) else float(psi1 if left else 0.0)
        psi2: Any = rebound(psi1, chi)
        slip: Any = scene.slip_velocity
        unit = scene.friction_coefficient * scene.normal_speed / scene.pair.stiffness_ratio
        change = (psi2 - psi1) * unit
        work = -scene.pair.tangential_mass * change * (slip + 0.5 * change)
        answer = WholeImpact(
            where=chi <= LARGEST_CHI,
            slip_velocity_change=change,
            friction_work=np.maximum(work, 0.0),
            reason=f"the rebound is tabulated; {WORK}",
            psi2_error=ERROR * np.maximum(np.abs(psi1), 1.0),
        )
        beyond = attrs.evolve(answer, where=True, reason=f"chi > {LARGEST_CHI}, solved; {WORK}")
        return (*closed, answer, beyond)
