"""Schemes of even steps, both of second order: the paper's, and leapfrog."""

from __future__ import annotations

from typing import ClassVar

import attrs

from contactlab.contracts import NormalMotion, Steps
from contactlab.numeric.checks import count
from contactlab_laws.march.division import endpoints, midpoints
from contactlab_laws.march.fixed import MOST_STEPS, FixedSteps


@attrs.frozen(kw_only=True)
class PaperSteps(FixedSteps):
    """The paper's even steps, eqs (33)-(37): tractions at the ends of steps.

    The paper prints the equations and not the order in which a step takes them. Here the
    displacement grows with the old velocity, the tractions (33)-(37) are solved at the new contact,
    and the force changes the velocity (35). It is then Verlet's scheme, of second order: the
    velocities stand half a step before the displacements, and the half step missing at
    first touch has no force. The paper's errors fall more slowly because of its annuli.

    The normal motion (30)-(32), which the paper integrates by the same steps, is made beforehand
    as for every integrator: its restitution is then 1, where 500 steps of the paper leave 1e-9.

    Parameters
    ----------
    steps : int
        Steps from first touch to separation: delta tau = 1/steps.
    refine : bool
        Where ``steps`` are too few for the stiffness of the law: take more (the default),
        or refuse with the status ``TOO_FEW_STEPS`` and the number needed.

    References
    ----------
    Maw, Barber & Fawcett, Wear 38 (1976) 101-114, §3.1.
    """

    api_version: ClassVar[int] = 2

    steps: int | None = count(default=500, most=MOST_STEPS)

    def divide(self, normal: NormalMotion, count: int, *, graded: bool) -> Steps:
        """Return steps sampled at their ends, even whatever the contact."""
        return endpoints(normal, count)


@attrs.frozen(kw_only=True)
class Symplectic(FixedSteps):
    """Leapfrog: the contact is sampled in the middle of each step.

    Steps are even in time: with steps even in the phase the error is about 1.6 times as
    large. A law gets the exact mean friction load of each step.

    Parameters
    ----------
    steps : int, optional
        Steps from first touch to separation: 200, or what the tangential law asks for, if neither
        has a resolution by name.
    refine : bool
        Where ``steps`` are too few for the stiffness of the law: take more (the default),
        or refuse with the status ``TOO_FEW_STEPS`` and the number needed.
    """

    api_version: ClassVar[int] = 2

    def divide(self, normal: NormalMotion, count: int, *, graded: bool) -> Steps:
        """Return steps sampled in their middles."""
        return midpoints(normal, count, graded=graded)
