"""The contract of an integrator: from a problem to a motion."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, NamedTuple, TypeAlias

import attrs

from contactlab.bodies import Pair
from contactlab.checks import Real
from contactlab.contracts.law import Law
from contactlab.contracts.normal import NormalContact, NormalLaw
from contactlab.contracts.tangential import TangentialLaw
from contactlab.status import Status


@attrs.frozen(kw_only=True, eq=False)
class Problem:
    """What an integrator solves; numbers are floats, or arrays of the batch ``shape``.

    Attributes
    ----------
    pair : Pair
    friction_coefficient : float or array
    normal_speed : float or array
        v1 in m/s.
    slip_velocity : float or array
        v_x at first touch, in m/s, eq. (20).
    maximum_radius : float or array
        a = CR in m, eq. (8): the largest contact radius of a Hertz impact. Laws that need
        a fixed grid span it.
    duration : float or array
        t in s, eq. (7): the time scale for choosing steps.
    shape : tuple of int
        Batch shape, () for one impact.
    """

    normal: NormalLaw
    tangential: TangentialLaw
    pair: Pair
    friction_coefficient: Real
    normal_speed: Real
    slip_velocity: Real
    maximum_radius: Real
    duration: Real
    shape: tuple[int, ...]


class Sample(NamedTuple):
    """One instant of a motion, as handed to an observer."""

    time: Real
    approach: Real
    normal_velocity: Real
    contact: NormalContact
    slip_velocity: Real
    tangential_force: Real
    fields: Callable[[], Mapping[str, Any]]


#: Called with each instant; it must not change anything it is given.
Observer: TypeAlias = Callable[[Sample], None]


@attrs.frozen(kw_only=True, eq=False)
class Motion:
    """What an integrator returns; entries have the batch shape.

    Attributes
    ----------
    duration : float or array
        Time of contact, in s.
    normal_velocity : float or array
        Rate of approach at the end, in m/s; negative: the bodies separate.
    slip_velocity_change : float or array
        Change of v_x in m/s. Kept apart from v_x, which may be so large that the
        change would be lost in it.
    friction_work : float or array
        In J, added up by the tangential law.
    status : Status or array of Status
    detail : str
        What went wrong, where and when; empty on success.
    counters : mapping of str to int
        Work done: ``steps``, ``evaluations``, ``rejected``, ...
    """

    duration: Real
    normal_velocity: Real
    slip_velocity_change: Real
    friction_work: Real
    status: Any = Status.SUCCESS
    detail: str = ""
    counters: Mapping[str, int] = attrs.field(factory=dict)


class Integrator(Law):
    """Advances the bodies through the impact.

    Contract
    --------
    1. ``integrate(problem, observer)`` returns a ``Motion``. It is pure; it never raises for
       a numerical failure, but returns a status with the motion so far.
    2. Every loop is bounded.
    3. ``observer`` is None or is called at increasing times; having one changes no result.
    4. ``order`` is the order of convergence in the step that the class declares for smooth
       laws; None where there are no steps.
    5. Batch shapes pass through: a batch gives what its impacts give one by one.
    """

    kind: ClassVar[str] = "integrator"
    order: ClassVar[int | None] = None
    #: Narrow contracts it makes use of where a law has them, such as ``closed_form_motion``.
    uses: ClassVar[frozenset[str]] = frozenset()

    @property
    def accuracy(self) -> float | None:
        """Error of psi2 over max(1, |psi1|) that it keeps to, under laws that are ``exact``.

        None for an integrator that does not control its error.
        """
        return None

    @abstractmethod
    def integrate(self, problem: Problem, observer: Observer | None = None) -> Motion:
        """Return the motion from first touch to separation."""
