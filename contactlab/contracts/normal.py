"""The contract of a normal law: force and contact radius from approach and rate."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.bodies import Pair
from contactlab.checks import Real
from contactlab.contracts.law import Law


class NormalContact(NamedTuple):
    """The normal contact at one instant; every entry broadcasts to the batch shape.

    Attributes
    ----------
    force : float or array
        P in N, positive in compression; 0 out of contact.
    radius : float or array
        b in m, the contact radius; 0 out of contact, and 0 from a law that has none.
    overlap : float or array
        Positive in contact, negative out of contact, zero as contact begins and ends:
        its sign tells an integrator where the impact ends. Any smooth measure in m.
    """

    force: Real
    radius: Real
    overlap: Real


class NormalLaw(Law):
    """Normal force of a contact.

    Contract
    --------
    1. ``start(pair)`` returns the state before first touch: any value, ``None`` for a law
       without memory.
    2. ``respond(state, approach, rate)`` returns ``(NormalContact, state)``. It is pure:
       the state that goes in is not changed, a new one comes out, so that a step may be
       tried and thrown away.
    3. ``approach`` (m) grows in compression and is zero at first touch; ``rate`` (m/s) is its
       time derivative, positive in compression. Both are floats for one impact, or arrays
       of the batch shape; arithmetic that serves both keeps one code path.
    4. NaN in gives NaN out, never "no contact".
    """

    kind: ClassVar[str] = "normal"

    @abstractmethod
    def start(self, pair: Pair) -> Any:
        """Return the state before first touch, for bodies ``pair``."""

    @abstractmethod
    def respond(self, state: Any, approach: Real, rate: Real) -> tuple[NormalContact, Any]:
        """Return the contact at ``approach`` (m) and ``rate`` (m/s), and the new state."""


class Course(NamedTuple):
    """A normal motion in units of its own, at many phases (arrays) or at one (floats).

    Approach, radius and force are over their greatest values, the rate over that at first
    touch; T is time in units of greatest approach over rate at first touch (theory §1).

    Attributes
    ----------
    phase : float or array
    approach, radius, rate, force : float or array
        zeta, b/a, V and P/P_max.
    pace : float or array
        dT/dx.
    """

    phase: Any
    approach: Any
    radius: Any
    rate: Any
    force: Any
    pace: Any


class ClosedFormMotion(ABC):
    """A normal motion known in closed form, along a phase that runs from 0 to pi.

    The phase x is a smooth stand-in for time: contact begins at 0, compression is
    greatest at pi/2, contact ends at pi, and every quantity is analytic in it, so
    that high-order methods keep their order (theory §3; in time they do not).
    """

    @property
    @abstractmethod
    def duration(self) -> Real:
        """Time from first touch to separation, in s, of the batch shape."""

    @property
    @abstractmethod
    def maximum_radius(self) -> Real:
        """Largest contact radius, in m."""

    @property
    @abstractmethod
    def maximum_approach(self) -> Real:
        """Greatest approach, in m."""

    @property
    @abstractmethod
    def maximum_force(self) -> Real:
        """P_max, the greatest normal force, in N."""

    @property
    @abstractmethod
    def scaled_mass(self) -> float:
        """M in M dV/dT = -P/P_max; 0.8 for elastic Hertz contact."""

    @abstractmethod
    def course(self, phase: NDArray[np.float64]) -> Course:
        """Return the scaled motion of one impact at many phases, as arrays."""

    @abstractmethod
    def instant(self, phase: float) -> Course:
        """Return the scaled motion of one impact at one phase, as floats."""

    @abstractmethod
    def phase_at_rate(self, rate: float) -> float:
        """Return the phase at which V = ``rate``, of one impact; V falls throughout."""

    @abstractmethod
    def at(self, phase: Real) -> tuple[Real, Real, Real, NormalContact]:
        """Return (time, approach, rate, contact) at ``phase``.

        ``phase`` broadcasts against the batch shape: a column of K phases, shape
        (K, 1, ..., 1), gives K rows of the batch.
        """

    @abstractmethod
    def phase(self, fraction: Real) -> Real:
        """Return the phase at which ``fraction`` of the duration has passed, to about 1e-8.

        For steps that are even in time; what they start from is taken exactly from ``at``.
        """

    @abstractmethod
    def pace(self, phase: Real) -> Real:
        """Return dt/dx at ``phase``, in s."""


class ClosedFormNormalLaw(NormalLaw):
    """A normal law whose motion is known in closed form: the integration is skipped."""

    @abstractmethod
    def motion(self, pair: Pair, speed: Real) -> ClosedFormMotion:
        """Return the motion of an impact at normal ``speed`` (m/s)."""
