"""The contract of a tangential law: friction force from slip displacement and history."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.checks import Mask, Real
from contactlab.contracts.law import Law
from contactlab.contracts.normal import NormalContact

if TYPE_CHECKING:
    from contactlab.contracts.integrator import Problem


Array = NDArray[np.float64]


class Increment(NamedTuple):
    """One step as a tangential law sees it; every entry broadcasts to the batch shape.

    Attributes
    ----------
    displacement : float or array
        D in m: relative tangential displacement of the bodies, far from the contact,
        between the two instants of the step.
    velocity : float or array
        v_x in m/s, the local tangential velocity that the step starts with.
    arresting_force : float or array
        In N: the constant force that would bring ``velocity`` to zero by the end of the
        step. A rigid law needs it; elastic laws have no use for it.
    normal_force : float or array
        P in N, the mean over the time in which the answer will act.
    duration : float or array
        That time, in s.
    """

    displacement: Real
    velocity: Real
    arresting_force: Real
    normal_force: Real
    duration: Real


class TangentialResponse(NamedTuple):
    """What a tangential law answers; every entry has the batch shape.

    Attributes
    ----------
    force : float or array
        F in N, positive where it opposes positive slip velocity.
    friction_work : float or array
        In J, at least 0: work done by friction on slipping parts during the step, added up
        from traction and slip, not from an energy balance.
    settled : bool or array
        False where the law could not find an answer; the run then ends with a status.
    """

    force: Real
    friction_work: Real
    settled: Mask = True


class TangentialLaw(Law):
    """Friction of a contact.

    Contract
    --------
    1. Friction is Coulomb's, abs(F) <= mu P (a discrete law may exceed this by its own
       stated discretisation error), and F = 0 out of contact.
    2. Odd: reversing every displacement reverses every force. A central impact (v_x = 0)
       makes no tangential force, whatever the normal motion.
    3. How a law is run is a narrower contract: ``SteppedTangentialLaw`` for laws that answer
       to a step, ``contactlab.contracts.phases.PhasedTangentialLaw`` for laws that are smooth
       between events. A law may be both.
    4. ``slips_throughout`` may say of some impacts that the force is mu P from start to
       end; the plan then takes the closed form (45) and the law is not run.
    """

    kind: ClassVar[str] = "tangential"
    #: True for a law with no discretisation of its own: the integrator's error is the whole error.
    exact: ClassVar[bool] = False
    #: True for a law that never makes a force: the plan leaves the march out.
    inert: ClassVar[bool] = False

    @property
    def books_bound(self) -> float:
        """Imbalance of the energy books, over the energy at the start, that still is success.

        Infinite unless the law declares one. What an integrator that controls its error adds
        comes on top.
        """
        return math.inf

    def slips_throughout(self, psi1: Real, chi: Real) -> Mask:
        """Return True where an elastic impact slips from start to end in one direction.

        Parameters
        ----------
        psi1, chi : float or array
            Eqs (29) and (38).

        Returns
        -------
        bool or array
            False wherever the law does not know.
        """
        return np.zeros(np.broadcast_shapes(np.shape(psi1), np.shape(chi)), dtype=bool)


class Run(NamedTuple):
    """All fixed steps of one impact, arrays of shape (K,); see ``Increment``.

    Of a batch of B impacts: arrays of shape (K, B), or (K, 1) where they agree.
    """

    force: Array
    radius: Array
    drift: Array
    kick: Array
    velocity: Any
    mass: Any


class RunResponse(NamedTuple):
    """Forces at the K samples of a run (fewer where it stopped), and the friction work.

    Of a batch: shapes (K, B) and (B,).
    """

    force: Array
    friction_work: Real
    settled: bool


class SteppedTangentialLaw(TangentialLaw):
    """A tangential law that answers to a step: the return mapping of plasticity.

    Contract
    --------
    1. ``start(problem)`` returns the state at first touch. It holds what the law needs of the
       problem (stiffness, friction coefficient, grid) and its memory.
    2. ``advance(state, increment, before, after)`` returns ``(TangentialResponse, state)``.
       History is a value: the state that goes in stays untouched, so an integrator may try a
       step, reject it and try again.
    3. ``before`` and ``after`` are the normal contact at the two ends of the step.
    4. Growing normal force alone (displacement 0) makes no tangential force.
    5. ``fields(state)`` names arrays for the history; it changes nothing.
    6. ``stiffness(problem)`` is an upper bound of dF/dD in N/m, from which an integrator
       knows its largest stable step; 0 for a law whose force does not come from displacement.
       Of a law that does not offer ``partial_slip``, whose microslip damps the oscillation,
       the errors of phase of all periods are taken to add up, and more steps are needed.
    """

    @abstractmethod
    def start(self, problem: Problem) -> Any:
        """Return the state at first touch."""

    @abstractmethod
    def advance(
        self, state: Any, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, Any]:
        """Return the response at the end of the step, and the new state."""

    def stiffness(self, problem: Problem) -> Real:  # noqa: ARG002
        """Return the largest tangential stiffness, in N/m."""
        return 0.0

    def fields(self, state: Any) -> Mapping[str, NDArray[Any]]:  # noqa: ARG002
        """Return named arrays of ``state`` for the history (traction, stuck, ...)."""
        return {}


class RunningTangentialLaw(SteppedTangentialLaw):
    """A stepped law that can also take all steps of one impact at a time, which may be faster.

    Contract
    --------
    1. ``run(problem, run)`` gives, to rounding, the forces that ``advance`` gives step by step
       when velocity falls by force times kick over mass after each step.
    2. ``problem`` has the batch shape (), or (B,) if ``runs_batches``.
    3. ``run`` may return None: these impacts are better done step by step.
    """

    runs_batches: ClassVar[bool] = False

    @abstractmethod
    def run(self, problem: Problem, run: Run) -> RunResponse | None:
        """Return the forces of whole impacts."""
