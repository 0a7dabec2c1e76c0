"""Rigid-body friction as phases: sliding, then rolling."""

from __future__ import annotations

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import Course, Path, Phase, PhaseResponse, PhaseState

Array = NDArray[np.float64]
Memo = tuple[Array, ...]


@attrs.frozen
class Rolling(Phase):
    """No slip and no force, to the end of contact."""

    dissipates = False

    def respond(self, contact: Course, slip: Array, memo: Memo) -> PhaseResponse:  # noqa: ARG002
        """F = 0."""
        return PhaseResponse(np.zeros_like(slip), None, None, ())


@attrs.frozen
class Sliding(Phase):
    """Slip in the positive sense: F = P, until the velocity is zero."""

    rough = (False,)

    def respond(self, contact: Course, slip: Array, memo: Memo) -> PhaseResponse:  # noqa: ARG002
        """F = P, whatever the slip."""
        return PhaseResponse(contact.force, None, None, ())

    def margin(
        self,
        event: int,  # noqa: ARG002
        contact: Course,  # noqa: ARG002
        slip: Array,  # noqa: ARG002
        velocity: Array,
        response: PhaseResponse,  # noqa: ARG002
    ) -> Array:
        """Slip goes on while psi > 0."""
        return velocity

    def follow(self, event: int, state: PhaseState, contact: Course, path: Path | None) -> Phase:  # noqa: ARG002
        """Roll."""
        return Rolling()

    def friction_power(
        self,
        contact: Course,
        slip: Array,  # noqa: ARG002
        velocity: Array,
        response: PhaseResponse,  # noqa: ARG002
    ) -> Array:
        """Force times velocity."""
        return np.asarray(contact.force * velocity)
