"""The event-locating integrator."""

from __future__ import annotations

from typing import ClassVar

import attrs
import numpy as np

from contactlab.contracts import (
    ClosedFormMotion,
    ClosedFormNormalLaw,
    Errors,
    Integrator,
    NormalMotion,
    Observer,
    PathTangentialLaw,
    TangentialLaw,
    TangentialMotion,
)
from contactlab.impact.error_model import psi_magnitude
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Rule, quantity
from contactlab.numeric.types import Real
from contactlab_laws.events.scaled import show, solve

#: Rounding allows no more than the first; with the second the answer still has three digits.
TOLERANCES = Rule(
    lambda value: np.ndim(value) == 0 and 1e-12 <= value <= 1e-3,
    "must be one number between 1e-12 and 1e-3",
)


@attrs.frozen(kw_only=True)
class Events(Integrator):
    """Impacts one by one along the paths that their law knows, in scaled units.

    The normal motion is taken in closed form along its phase x, in which everything is
    analytic between events.

    Parameters
    ----------
    tolerance : float
        Error of psi2 over max(1, |psi1|) that is aimed at.
    """

    api_version: ClassVar[int] = 2
    offers: ClassVar[frozenset[str]] = frozenset({"controls_error"})
    resolution: ClassVar[str | None] = "tolerance"
    needs: ClassVar[frozenset[type]] = frozenset({PathTangentialLaw, ClosedFormNormalLaw})

    tolerance: float = quantity("1", rule=TOLERANCES, default=1e-9)

    def errors(self, scene: Scene, normal: NormalMotion, tangential: TangentialLaw) -> Errors:
        """Return the tolerance, and what the law declares for itself."""
        own: Real = tangential.errors(scene, normal, np.inf).psi2
        return Errors(self.tolerance * psi_magnitude(scene) + own)

    def integrate(
        self,
        scene: Scene,
        normal: NormalMotion,
        tangential: TangentialLaw,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion, impact by impact."""
        law, shape = tangential, scene.shape
        assert isinstance(law, PathTangentialLaw)
        assert isinstance(normal, ClosedFormMotion)
        solved = []
        for place in np.ndindex(shape):
            one = normal.take(place) if shape else normal
            assert isinstance(one, ClosedFormMotion)
            one_solved = solve(law, one, self.tolerance)
            if observer is None:  # paths are long
                one_solved = one_solved._replace(stretches=())
            solved.append(one_solved)
        if observer is not None:
            show(shape, solved, observer)
        motions = [each.motion for each in solved]
        return TangentialMotion.join(motions, shape) if shape else motions[0]
