"""The contract of a tangential law that knows its path: an impact in, stretches of it out.

All quantities are scaled, theory §1, so that a law reads like the paper and a change of units
changes no digit. The normal motion is a ``ScaledContact``; besides it:

============  ==================================================================
``velocity``  psi = kappa v_x/(mu v1), eq. (29)
``force``     F/(mu P_max), positive where it opposes positive slip velocity
``inertia``   d psi/dT = -inertia · force; 2.5 chi for elastic Hertz contact
``work``      friction work, in units of force times the integral of psi over T
============  ==================================================================
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from numpy.typing import NDArray

from contactlab.contracts.motion import ClosedFormMotion, ScaledContact
from contactlab.contracts.tangential import TangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array

#: Below this velocity a response is proportional to velocity, to 1e-8 of itself: the law answers
#: at this velocity, and the answer is scaled.
LINEAR_BELOW = 1e-8


class Cost(NamedTuple):
    """How a law solves a batch.

    Attributes
    ----------
    block : int
        Impacts of a sweep that are solved in one call, so that none takes long.
    solver : str
        What computes the paths, in words, where that depends on the installation.
    one_by_one : bool
        True if a batch takes as long as its impacts one by one.
    """

    block: int = 1000
    solver: str = ""
    one_by_one: bool = False


class LostPathError(ArithmeticError):
    """The path cannot be followed any further, for the reason that its message says."""


class Stretch(ABC):
    """The motion between two events.

    Attributes
    ----------
    start, stop : float
        Phases x of the normal motion between which it holds.
    change, work : float
        Change of velocity and friction work from first touch to ``stop``. The change is not added
        to the velocity, which may be so large that it would swallow digits of the change. Work is
        added up from tractions and slip, not from the balance of energy.
    solves : int
        Systems of equations solved from first touch on.
    """

    start: float
    stop: float
    change: float
    work: float
    solves: int = 0

    @abstractmethod
    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return (change of velocity since first touch, force) at the contact's x.

        Parameters
        ----------
        contact : ScaledContact
            At phases within the stretch, shape (K,).
        """

    def fields(
        self, normal: ClosedFormMotion, contact: ScaledContact, factor: float
    ) -> Mapping[str, NDArray[Any]]:
        """Return named arrays in SI (traction, stuck, ...) at one instant.

        Parameters
        ----------
        normal : ClosedFormMotion
            Normal motion of the impact, which has its scales.
        contact : ScaledContact
            Contact at the instant; its entries are floats.
        factor : float
            Factor on the scaled solution: -1 for a negative slip velocity, and smaller than 1 where
            the law is linear.
        """
        return {}


class PathTangentialLaw(TangentialLaw, way="path"):
    """A tangential law that knows the path of its state from event to event.

    Contract
    --------
    1. ``path`` yields the stretches of one impact, one after another without gaps, to x = pi. It
       is given a velocity > 0, as a law is odd.
    2. A path that cannot be followed further raises ``LostPathError``.
    3. Stretches of no length are allowed, a hundred in a row.
    """

    def cost(self, scene: Scene, accuracy: float | None) -> Cost:
        """Return the best size of a block of a batch, and what solves it.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        accuracy : float or None
            The error that the integrator controls: answers with a larger one are not used.
        """
        return Cost()

    @abstractmethod
    def path(
        self, velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
    ) -> Iterator[Stretch]:
        """Yield the stretches of one impact.

        Parameters
        ----------
        velocity, inertia : float
            psi and 2.5 chi at first touch, as the table of this module has them; positive and
            finite.
        motion : ClosedFormMotion
            The normal motion, of one impact.
        tolerance : float
            Error of psi2 over max(1, psi1) that is aimed at.
        """
