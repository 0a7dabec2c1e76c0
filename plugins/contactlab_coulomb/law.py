"""Rigid-body friction: slip, then rolling with no force."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar

import attrs
import numpy as np

from contactlab.checks import Mask, Real
from contactlab.contracts import (
    ClosedFormMotion,
    Increment,
    NormalContact,
    Phase,
    PhasedTangentialLaw,
    Problem,
    SteppedTangentialLaw,
    TangentialResponse,
)
from contactlab_coulomb.phases import Rolling, Sliding

#: Of the energy books, over the energy at the start.
ROUNDING = 1e-9


@attrs.frozen(kw_only=True)
class Coulomb(SteppedTangentialLaw, PhasedTangentialLaw):
    """Coulomb friction between bodies that do not deform tangentially.

    While the contact slips the force is mu P; once slip has stopped the bodies roll and
    the force is zero. The step in which slip stops takes exactly the force that stops it,
    so there is no chatter, and the rebound is exact whatever the step.

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, the rigid body theory of §§1 and 4.3.
    """

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset[str]] = frozenset({"advance", "phases"})
    exact: ClassVar[bool] = True
    #: Slip that friction can stop is stopped, however slow; its square must be a number.
    linear_below: ClassVar[float] = 1e-100
    expected_failures: ClassVar[Mapping[str, str]] = {
        "cattaneo_mindlin": "rigid bodies slip all over or not at all: there is no partial slip",
        "impact_reference": "the exact solution is that of bodies which deform tangentially",
    }

    @property
    def books_bound(self) -> float:
        """Return the bound of rounding: the work is that of the force in every step."""
        return ROUNDING

    def slips_throughout(self, psi1: Real, chi: Real) -> Mask:
        """Return True for |psi1| >= 4 chi: friction cannot stop the slip."""
        return np.abs(psi1) >= 4.0 * np.asarray(chi)

    def start(self, problem: Problem) -> Real:
        """Return the friction coefficient: the law has no memory."""
        return problem.friction_coefficient

    def advance(
        self,
        state: Real,
        increment: Increment,
        before: NormalContact,  # noqa: ARG002
        after: NormalContact,  # noqa: ARG002
    ) -> tuple[TangentialResponse, Real]:
        """Return the arresting force, as far as mu P allows it."""
        limit = state * increment.normal_force
        arresting = increment.arresting_force
        if isinstance(limit, float) and isinstance(arresting, float):
            # NaN compares false: a load of NaN would read as a limit that is never reached.
            known = limit >= 0.0
            force: Real = min(max(arresting, -limit), limit) if known else math.nan
        else:
            force = np.clip(arresting, -limit, limit)
        # Velocity falls in the step, to zero where friction arrests the sphere (force =
        # arresting force): slip is its mean times the duration.
        share = force / (arresting + (arresting == 0.0))
        slip = increment.velocity * increment.duration * (1.0 - 0.5 * share)
        return TangentialResponse(force, force * slip), state

    def begin(self, velocity: float, inertia: float, motion: ClosedFormMotion) -> Phase:  # noqa: ARG002
        """Slide, unless the velocity is zero."""
        return Sliding() if velocity > 0.0 else Rolling()


@attrs.frozen(kw_only=True)
class Frictionless(SteppedTangentialLaw, PhasedTangentialLaw):
    """No tangential force at all: the null object, and the yardstick for cost."""

    api_version: ClassVar[int] = 1
    offers: ClassVar[frozenset[str]] = frozenset({"advance", "phases"})
    exact: ClassVar[bool] = True
    inert: ClassVar[bool] = True
    expected_failures: ClassVar[Mapping[str, str]] = {
        "gross_slip": "there is no friction, however large the slip",
        "cattaneo_mindlin": "there is no friction, and so no partial slip",
        "impact_reference": "the exact solution is that of bodies with friction",
        "non_finite": "the force is zero whatever the input; the normal motion reports the NaN",
    }

    @property
    def books_bound(self) -> float:
        """Return the bound of rounding: there is no work."""
        return ROUNDING

    def start(self, problem: Problem) -> Real:
        """Return a zero of the batch shape."""
        return np.zeros(problem.shape) if problem.shape else 0.0

    def advance(
        self,
        state: Real,
        increment: Increment,  # noqa: ARG002
        before: NormalContact,  # noqa: ARG002
        after: NormalContact,  # noqa: ARG002
    ) -> tuple[TangentialResponse, Real]:
        """Return no force."""
        return TangentialResponse(state, state), state

    def begin(self, velocity: float, inertia: float, motion: ClosedFormMotion) -> Phase:  # noqa: ARG002
        """Make no force from start to end."""
        return Rolling()
