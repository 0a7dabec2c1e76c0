"""The event-locating integrator."""

from __future__ import annotations

from typing import ClassVar

import attrs
import numpy as np

from contactlab.checks import Rule, quantity
from contactlab.contracts import (
    Integrator,
    Motion,
    Observer,
    PhasedTangentialLaw,
    Problem,
)
from contactlab_events.dense import show
from contactlab_events.scaled import Run, scaled

#: Rounding allows no more than the first; with the second the answer still has three digits.
TOLERANCES = Rule(
    lambda value: np.ndim(value) == 0 and 1e-12 <= value <= 1e-3,
    "must be one number between 1e-12 and 1e-3",
)


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

    api_version: ClassVar[int] = 1
    resolution: ClassVar[str | None] = "tolerance"
    offers: ClassVar[frozenset[str]] = frozenset({"events"})
    needs: ClassVar[frozenset[str]] = frozenset({"phases", "closed_form_motion"})
    uses: ClassVar[frozenset[str]] = frozenset({"closed_form_motion"})
    together: ClassVar[bool] = False

    tolerance: float = quantity("1", rule=TOLERANCES, default=1e-9)

    @property
    def accuracy(self) -> float:
        """The error aimed at."""
        return self.tolerance

    def integrate(self, problem: Problem, observer: Observer | None = None) -> Motion:
        """Return the motion, impact by impact."""
        law = problem.tangential
        assert isinstance(law, PhasedTangentialLaw)
        runs = [impact.run(law, self.tolerance) for impact in map(scaled, problem.impacts())]
        if observer is not None:
            show(problem, law, runs, observer)
        motions = [_motion(run) for run in runs]
        return Motion.joined(motions, problem.shape) if problem.shape else motions[0]


def _motion(run: Run) -> Motion:
    return Motion(
        duration=run.duration,
        normal_velocity=run.normal_velocity,
        slip_velocity_change=run.slip_velocity_change,
        friction_work=run.friction_work,
        status=run.status,
        detail=run.failure,
        counters={"panels": len(run.followed.pieces), "solves": run.followed.solves},
    )
