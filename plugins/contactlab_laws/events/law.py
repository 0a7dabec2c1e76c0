"""The event-locating integrator."""

from __future__ import annotations

from typing import Any, ClassVar, TypeGuard

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    ClosedFormNormalLaw,
    Integrator,
    ManyPhasedTangentialLaw,
    NormalMotion,
    Observer,
    PhasedTangentialLaw,
    TangentialLaw,
    TangentialMotion,
    faults,
)
from contactlab.contracts.error_model import psi_magnitude
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real, Rule, quantity
from contactlab_laws.events.history import show
from contactlab_laws.events.scaled import FEWEST, scaled, together

#: Rounding allows no more than the first; with the second the answer still has three digits.
TOLERANCES = Rule(
    lambda value: np.ndim(value) == 0 and 1e-12 <= value <= 1e-3,
    "must be one number between 1e-12 and 1e-3",
)

#: Impacts of a sweep at a time: together they gain until some thousands, one by one nothing.
TOGETHER, ONE_BY_ONE = 4000, 20


@attrs.frozen(kw_only=True)
class Events(Integrator):
    """Collocation panels of high order within smooth phases, and events found between them.

    The normal motion is taken in closed form along its phase x, in which everything is
    analytic; a panel that holds an event is cut there, so that the order is never lost.

    Parameters
    ----------
    tolerance : float
        Error of psi2 over max(1, |psi1|) that is aimed at.

    References
    ----------
    Hairer & Wanner, Solving Ordinary Differential Equations II, 2nd ed. (1996), §§IV.5 and
    IV.8: collocation at Lobatto points.
    """

    api_version: ClassVar[int] = 2
    resolution: ClassVar[str | None] = "tolerance"
    tangential_contract: ClassVar[Any] = PhasedTangentialLaw
    normal_contract: ClassVar[Any] = ClosedFormNormalLaw
    own_statuses: ClassVar[bool] = True

    tolerance: float = quantity("1", rule=TOLERANCES, default=1e-9)

    @property
    def accuracy(self) -> float:
        """The error aimed at."""
        return self.tolerance

    def chunk(self, tangential: TangentialLaw) -> int:
        """Return many impacts if they are solved together."""
        return TOGETHER if self._together(tangential) else ONE_BY_ONE

    def _together(self, law: TangentialLaw) -> TypeGuard[ManyPhasedTangentialLaw]:
        """Return whether the law solves many impacts in one call, as accurately as is asked."""
        return isinstance(law, ManyPhasedTangentialLaw) and law.finest_together <= self.tolerance

    def psi2_error(self, normal: NormalMotion, tangential: TangentialLaw, scene: Scene) -> Real:
        """Return the tolerance, and what the law declares for itself."""
        own: Any = tangential.psi2_error(scene, normal, np.inf)
        bound: Real = self.tolerance * psi_magnitude(scene) + own
        return bound

    def integrate(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion, impact by impact."""
        law, shape = tangential, scene.shape
        assert isinstance(law, PhasedTangentialLaw)
        assert isinstance(normal, ClosedFormMotion)
        left, parts = np.ones(shape, dtype=bool), []
        if left.size >= FEWEST and observer is None and self._together(law):
            known, motion = together(law, normal, self.tolerance)
            left, parts = ~known, [(known, motion)]
        solved, motions = [], []
        for place in map(tuple, np.argwhere(left).tolist() if shape else [()]):
            one = normal.take(place) if shape else normal
            assert isinstance(one, ClosedFormMotion)
            with faults.blaming(one.law):
                impact = scaled(one)
            one_solved = impact.solve(law, self.tolerance)
            motions.append(one_solved.motion)
            if observer is not None:  # trajectories are long
                solved.append(one_solved)
        if observer is not None:
            show(shape, solved, observer)
        if not shape:
            return motions[0]
        if motions:
            parts.append((left, TangentialMotion.joined(motions, (len(motions),))))
        return TangentialMotion.merged(parts, shape)
