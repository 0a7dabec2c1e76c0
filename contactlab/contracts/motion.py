"""The normal motion as a value: made once, before any friction is computed."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.status import Status
from contactlab.numeric.checks import Real

if TYPE_CHECKING:
    from contactlab.contracts.contact import NormalContact
    from contactlab.contracts.law import Law
    from contactlab.impact.scene import Scene


class NormalSample(NamedTuple):
    """The normal motion at one instant, or at many.

    Attributes
    ----------
    time : float or array
        Since first touch, in s.
    approach, rate : float or array
        In m and m/s, positive in compression.
    contact : NormalContact
    load_impulse : float or array
        Integral of the friction load since first touch, in N s.
    """

    time: Any
    approach: Any
    rate: Any
    contact: NormalContact
    load_impulse: Any


class NormalMotion(ABC):
    """A normal motion from first touch to separation, of one impact or of a batch.

    It runs along a phase from 0 to pi, a stand-in for time that grows with it and that the
    motion chooses: ``phase`` gives the phase at a fraction of the duration.

    Attributes
    ----------
    law : NormalLaw
    scene : Scene
    duration : float or array
        Time from first touch to separation, in s.
    maximum_radius, maximum_approach : float or array
        Greatest contact radius and approach, in m.
    maximum_force : float or array
        P_max, the greatest normal force, in N.
    final_rate : float or array
        Rate of approach at separation, in m/s; negative.
    total_load_impulse : float or array
        Integral of the friction load over the contact, in N s.
    status : Status, or array of Status
        Of an impact that did not separate everything else means nothing.
    detail : str, or array of str
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
    detail: Any = ""
    #: Declared relative error of the load impulse; NaN, the default: not declared.
    accuracy: float = math.nan

    @property
    def offers(self) -> frozenset[str]:
        """Claims of the normal law."""
        return self.law.offers

    @abstractmethod
    def at(self, phase: Real) -> NormalSample:
        """Return the motion at ``phase``.

        ``phase`` broadcasts against the batch shape: a column of K phases, shape (K, 1, ..., 1),
        gives K rows of the batch.

        Parameters
        ----------
        phase : float or array
            From 0 at first touch to pi at separation.
        """

    @abstractmethod
    def phase(self, fraction: Real) -> Real:
        """Return the phase at which ``fraction`` of the duration has passed, to about 1e-8.

        For steps that are even in time; what they start from is taken exactly from ``at``.

        Parameters
        ----------
        fraction : float or array
            Of the duration, from 0 to 1; broadcasts against the batch shape.
        """

    @abstractmethod
    def take(self, part: Any) -> NormalMotion:
        """Return the motion of some impacts of a batch, as ``contactlab.numeric.arrays.taken``.

        Parameters
        ----------
        part : slice, array of bool or int, int or tuple of int
            As numpy indexes an array of the batch shape.
        """


class ScaledContact(NamedTuple):
    """A normal motion in units of its own, at many phases (arrays) or at one (floats).

    Approach, radius and force are over their greatest values, the rate over that at first
    touch; T is time in units of greatest approach over rate at first touch.

    Attributes
    ----------
    phase : float or array
    approach, radius, rate, force : float or array
        zeta, b/a, V and P/P_max.
    time_rate : float or array
        dT/dx, x the phase.
    """

    phase: Any
    approach: Any
    radius: Any
    rate: Any
    force: Any
    time_rate: Any


class ClosedFormMotion(NormalMotion):
    """A normal motion known in closed form, every quantity analytic along its phase.

    Contact begins at the phase 0, compression is greatest at pi/2, contact ends at pi. In such
    a phase high-order methods keep their order (in time they do not).
    """

    @property
    @abstractmethod
    def scaled_mass(self) -> float:
        """M in M dV/dT = -P/P_max; 0.8 for elastic Hertz contact."""

    @abstractmethod
    def scaled(self, phase: NDArray[np.float64]) -> ScaledContact:
        """Return the scaled motion of one impact at many phases, as arrays.

        Parameters
        ----------
        phase : array, shape (K,)
            From 0 at first touch to pi at separation.
        """

    @abstractmethod
    def scaled_at(self, phase: float) -> ScaledContact:
        """Return the scaled motion of one impact at one phase, as floats.

        Parameters
        ----------
        phase : float
            From 0 at first touch to pi at separation.
        """

    @abstractmethod
    def phase_at_rate(self, rate: Real) -> Real:
        """Return the phase at which V = ``rate``, a float or an array; V falls throughout.

        Parameters
        ----------
        rate : float or array
            V, the scaled normal velocity: 1 at first touch.
        """
