"""The contract of normal motions, which are made before any friction is computed."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.law import Law, claims
from contactlab.contracts.status import Details, Status
from contactlab.numeric.types import Each, Index, Real

if TYPE_CHECKING:
    from contactlab.contracts.contact import NormalContact
    from contactlab.impact.scene import Scene


T = TypeVar("T")
#: Most values that motions share; beyond them all are made anew, so that memory stays bounded.
MOST_SHARED = 8


class NormalSample(NamedTuple, Generic[Each]):
    """The normal motion at one instant, or at many.

    Attributes
    ----------
    time : float or array
        Time since first touch, in s.
    approach, rate : float or array
        Approach in m and its rate in m/s, positive in compression.
    contact : NormalContact
        The normal contact.
    load_impulse : float or array
        Integral of the friction load since first touch, in N s.
    """

    time: Each
    approach: Each
    rate: Each
    contact: NormalContact
    load_impulse: Each


class Units(NamedTuple):
    """Units of impacts over the units of the one impact that all their motions follow.

    Attributes
    ----------
    time, approach, rate, force, radius : float or array
        Without unit, of the batch shape.
    """

    time: Real = 1.0
    approach: Real = 1.0
    rate: Real = 1.0
    force: Real = 1.0
    radius: Real = 1.0


class NormalMotion(ABC):
    """A normal motion from first touch to separation, of one impact or of a batch.

    The motion is a function of its phase, which grows with time from 0 at first touch to pi at
    separation. Each class chooses its phase; ``phase`` returns it for a fraction of the duration.

    Attributes
    ----------
    law : NormalLaw
        The law that made the motion.
    scene : Scene
        The impacts of the motion.
    duration : float or array
        Time from first touch to separation, in s.
    maximum_radius, maximum_approach : float or array
        Greatest contact radius and approach, in m.
    maximum_force : float or array
        P_max, the greatest normal force, in N.
    final_rate : float or array
        Rate of approach at separation, in m/s; negative.
    total_load_impulse : float or array
        Integral of the friction load over the duration, in N s.
    status : Status, or array of Status
        Status of each impact; the numbers of an impact without success are meaningless.
    detail : str, or array of str
        What failed; empty on success.

    Parameters of methods
    ---------------------
    phase : float or array
        Phase from 0 at first touch to pi at separation.
    fraction : float or array
        Fraction of the duration, from 0 to 1.
    part : slice, array of bool or int, int or tuple of int
        Index of an array of the batch shape.
    """

    law: Law
    scene: Scene
    duration: Real
    maximum_radius: Real
    maximum_approach: Real
    maximum_force: Real
    final_rate: Real
    total_load_impulse: Real
    status: Any = Status.SUCCESS
    detail: Details = ""
    #: Declared relative error of the load impulse; NaN, the default, means not declared.
    accuracy: float = math.nan
    #: True if the motions of all impacts are one but for their scale.
    alike: bool = False
    #: Content of the motion: "course", "ends" (final rate and load impulse), or "nothing".
    _known: ClassVar[str] = "course"

    @property
    def shared(self) -> dict[Any, Any] | None:
        """A dict that equal motions share, for ``once``; None, the default, if there is none."""
        return None

    @property
    def pattern(self) -> tuple[NormalMotion, Units] | None:
        """One impact whose motion, in these units, is that of every impact; None without one."""
        return None

    @property
    def claims(self) -> frozenset[str]:
        """Words that the normal law offers, with its parameters."""
        return claims(self.law)

    def once(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return ``make()``, kept for later calls with this key and an equal motion.

        Parameters
        ----------
        key : hashable
            Names what is made; it contains all that the value depends on besides the motion.
        make : callable
            Returns the value, which nobody may change afterwards.
        """
        if (shared := self.shared) is None:
            return make()
        if key not in shared:
            if len(shared) >= MOST_SHARED:
                shared.clear()
            shared[key] = make()
        value: T = shared[key]
        return value

    @abstractmethod
    def at(self, phase: Real) -> NormalSample:
        """Return the motion at ``phase``.

        ``phase`` broadcasts against the batch shape: K phases of shape (K, 1, ..., 1) give
        samples of shape (K, ...).
        """

    @abstractmethod
    def phase(self, fraction: Real) -> Real:
        """Return the phase at which ``fraction`` of the duration has passed, to about 1e-8.

        Integrators with even steps use it. The error does no harm: ``at`` returns the exact time
        of that phase.
        """

    @abstractmethod
    def take(self, part: Index) -> NormalMotion:
        """Return the motion of the impacts that ``part`` indexes."""


class ScaledContact(NamedTuple):
    """A scaled normal motion at many phases (arrays) or at one (floats).

    Approach, radius and force are divided by their greatest values, the rate by its value at
    first touch. T is time times the rate at first touch over the greatest approach.

    Attributes
    ----------
    phase : float or array
        x, from 0 at first touch to pi at separation.
    approach, radius, rate, force : float or array
        zeta, b/a, V and P/P_max.
    time_rate : float or array
        dT/dx.
    """

    phase: Any
    approach: Any
    radius: Any
    rate: Any
    force: Any
    time_rate: Any


class ClosedFormMotion(NormalMotion):
    """A normal motion in closed form, whose quantities are analytic functions of the phase.

    Contact begins at phase 0, the approach is greatest at pi/2, contact ends at pi. Methods of
    high order keep their order in such a phase; in time they would not.
    """

    alike = True

    @property
    @abstractmethod
    def scaled_mass(self) -> float:
        """The mass M of the scaled equation M dV/dT = -P/P_max; 0.8 for elastic Hertz contact."""

    @abstractmethod
    def scaled(self, phase: NDArray[np.float64]) -> ScaledContact:
        """Return the scaled motion of one impact at many phases, as arrays of shape (K,)."""

    @abstractmethod
    def scaled_at(self, phase: float) -> ScaledContact:
        """Return the scaled motion of one impact at one phase, as floats."""

    @abstractmethod
    def phase_at_rate(self, rate: Real) -> Real:
        """Return the phase at which V = ``rate``; V falls throughout the impact.

        Parameters
        ----------
        rate : float or array
            V, the scaled rate: 1 at first touch.
        """
