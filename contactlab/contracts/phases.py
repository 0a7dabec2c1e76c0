"""The contract of a tangential law that is smooth in pieces, for integrators that locate events.

Such a law is a sequence of phases (stuck, edge slip, gross slip, ...). The integrator knows
inertia, the normal motion and collocation; the law knows traction. Neither knows the other's part.

All quantities are scaled, theory §1, so that a law reads like the paper and a change of units
changes no digit. The normal motion is a ``ScaledContact``; besides it:

======================  ==================================================================
``x``                   phase of the normal motion (see ``ClosedFormMotion``)
``velocity``            psi = kappa v_x/(mu v1), eq. (29), never negative at first touch
``slip``                D, the integral of psi over T
``force``               F/(mu P_max), positive where it opposes positive slip velocity
``inertia``             d psi/dT = -inertia · force; 2.5 chi for elastic Hertz contact
``work``                friction work in the units of force times slip
======================  ==================================================================
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.motion import ClosedFormMotion, ScaledContact
from contactlab.contracts.tangential import TangentialLaw

Array = NDArray[np.float64]


class PhaseState(NamedTuple):
    """The state of the tangential motion at one x.

    ``change`` is the velocity gained since first touch, apart from the velocity, which may be
    so large that it would swallow it. All are scaled as in the module's table.

    Attributes
    ----------
    x : float
        Phase of the normal motion, from 0 at first touch to pi at separation.
    slip, change, velocity, force : float
    force_rate : float
        d(force)/dT, which serves guesses only.
    work : float
        Friction work since first touch.
    """

    x: float
    slip: float
    change: float
    velocity: float
    force: float
    force_rate: float
    work: float


class PhaseResponse(NamedTuple):
    """The tangential force, as a part known now and a part gathered on the way.

    Attributes
    ----------
    force : array
        A function of contact and slip alone.
    stiffness : array or None
        d force / d slip at fixed x; None means zero.
    gathered : array or None
        k in F = ``force`` + integral of k d(slip) since the phase began; None means zero.
    memo : tuple of array
        The law's own; a starting guess for its next call.
    """

    force: Array
    stiffness: Array | None
    gathered: Array | None
    memo: tuple[Array, ...]


class PhaseSample(NamedTuple):
    """The motion in a phase at several x.

    Attributes
    ----------
    contact : ScaledContact
        Shape (K,).
    slip, velocity : array, shape (K,)
        D and psi.
    response : PhaseResponse
        What ``Phase.respond`` gave at this contact and slip.
    """

    contact: ScaledContact
    slip: Array
    velocity: Array
    response: PhaseResponse


class DenseOutput(Protocol):
    """The motion between the nodes of a finished panel, which a law may ask for and may keep."""

    def fields(self, x: Array) -> Array:
        """Return rows slip, force, approach, radius, d(slip)/dx, d(approach)/dx at each x.

        Parameters
        ----------
        x : array, shape (K,)
            Phases of the normal motion within the panel.
        """
        ...


class ClosedPhase(ABC):
    """A phase's motion in closed form.

    Attributes
    ----------
    end : PhaseState
    event : int or None
        Which event ends it; None if the contact ends first.
    """

    end: PhaseState
    event: int | None

    @abstractmethod
    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return (change of velocity since first touch, force) at the contact's x.

        Parameters
        ----------
        contact : ScaledContact
            At phases within this one, shape (K,).
        """


class Phase:
    """A stretch of motion in which the law's response is smooth; a value, never changed.

    Contract
    --------
    1. ``respond`` is a pure function of contact, slip and the phase; ``memo`` only saves time.
       It stays finite, and smooth if it can, somewhat beyond the end of the phase. It is not
       asked of a phase that has a closed form.
    2. ``margin`` is positive inside the phase, smooth, and zero where the event happens. It
       may be zero at the start. Events are numbered as in ``singular_events``, which is declared
       wherever there is a margin.
    3. ``singular_events[i]`` says that the force behaves as (x_event - x)^1.5 when event i comes
       near; the integrator then ends a panel at the event and crowds its nodes there.
    4. ``after_event`` gives the phase after event i. It may end at once (zero length). Its
       ``output`` is None if the phase had no length.
    5. ``after_panel`` gives the phase that continues after a panel which no event ended.
    6. ``friction_power`` is the rate of loss per unit of T, from tractions and slip and not
       from the force balance. It is asked only where ``dissipates``.
    7. ``closed_form`` may give the motion to the phase's end. The origin of ``slip`` may move
       there: nobody compares slips across it.
    """

    #: An entry for each event: whether the force is singular there (clause 3).
    singular_events: tuple[bool, ...] = ()
    #: A guess of the phase's length in x; saves time only.
    length_guess: float | None = None
    #: The force is linear in slip: one step of Newton's method is exact.
    linear: bool = False
    dissipates: bool = True

    def __init_subclass__(cls) -> None:
        """Refuse margins of events that are not declared: nobody would look for them."""
        bases = cls.__mro__[: cls.__mro__.index(Phase)]
        if cls.margin is not Phase.margin and not any("singular_events" in vars(b) for b in bases):
            raise TypeError(f"{cls.__name__}: has a margin, and no singular_events (clause 2)")

    def respond(
        self, contact: ScaledContact, slip: Array, memo: tuple[Array, ...]
    ) -> PhaseResponse:
        """Return the force at these contacts and slips (clause 1).

        Parameters
        ----------
        contact : ScaledContact
            Scaled as in theory §1, shape (K,).
        slip : array, shape (K,)
            Scaled slip displacement.
        memo : tuple of array
            What the law's last call returned with its force; a starting guess.
        """
        raise NotImplementedError(f"{type(self).__name__} has neither respond nor closed_form")

    def margin(self, event: int, sample: PhaseSample) -> Array:
        """Return the margin of one event (clause 2).

        Parameters
        ----------
        event : int
        sample : PhaseSample
            The motion at the x asked for.
        """
        raise IndexError(event)

    def after_event(
        self, event: int, state: PhaseState, contact: ScaledContact, output: DenseOutput | None
    ) -> Phase:
        """Return the next phase (clause 4).

        Parameters
        ----------
        event : int
        state : PhaseState
            At the event.
        contact : ScaledContact
            There, of floats.
        output : DenseOutput or None
            Of the panel that the event ended; None if the phase had no length.
        """
        raise IndexError(event)

    def after_panel(self, state: PhaseState, contact: ScaledContact, output: DenseOutput) -> Phase:
        """Return the phase that continues after a finished panel (clause 5).

        Parameters
        ----------
        state : PhaseState
            At the end of the panel.
        contact : ScaledContact
            There.
        output : DenseOutput
            Of the panel.
        """
        return self

    def friction_power(self, sample: PhaseSample) -> Array:
        """Return the rate of friction work (clause 6).

        Parameters
        ----------
        sample : PhaseSample
            The motion at the x asked for.
        """
        return np.zeros_like(sample.slip)

    def closed_form(
        self,
        state: PhaseState,
        motion: ClosedFormMotion,
        inertia: float,
    ) -> ClosedPhase | None:
        """Return the motion in closed form, if it has one (clause 7).

        Parameters
        ----------
        state : PhaseState
            Where the phase begins.
        motion : ClosedFormMotion
            The normal motion, of one impact.
        inertia : float
            Of the module's table.
        """
        return None


class ManyImpacts(NamedTuple):
    """Answers to many impacts, arrays of shape (impacts,); scaled as all here.

    Attributes
    ----------
    change : array
        Of velocity, over the whole impact.
    work : array
        Added up from tractions and slip.
    solved : array of bool
        False where it was given up: the other entries mean nothing there.
    panels : int
        Panels solved, of all impacts together.
    """

    change: Array
    work: Array
    solved: NDArray[np.bool_]
    panels: int


class PhasedTangentialLaw(TangentialLaw):
    """A tangential law that is smooth between events it can name.

    Contract
    --------
    1. ``begin`` returns the phase at first touch, for a velocity >= 0 (a law is odd).
    2. Below the velocity ``linear_below`` the response is proportional to the velocity, to
       1e-8 of itself, for an inertia above 1e-99; an integrator may then solve for
       ``linear_below`` and scale.
    3. ``phase_fields`` names arrays in SI for the history; it changes nothing.
    """

    linear_below: ClassVar[float] = 0.0

    @abstractmethod
    def begin(self, velocity: float, inertia: float, motion: ClosedFormMotion) -> Phase:
        """Return the phase at first touch.

        Parameters
        ----------
        velocity : float
            Scaled slip velocity at first touch, not negative.
        inertia : float
            Of the module's table.
        motion : ClosedFormMotion
            The normal motion, of one impact.
        """

    def tolerance_needed(
        self, velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
    ) -> float:
        """Return the tolerance to solve an impact with: that asked for, or a closer one.

        Closer where the margins of events are so narrow that an error of the size asked for would
        mistake one event for another.

        Parameters
        ----------
        velocity, inertia, motion
            As ``begin`` has them.
        tolerance : float
            Error of psi2 over max(1, psi1) that is asked for.
        """
        return tolerance

    def phase_fields(
        self,
        normal: ClosedFormMotion,
        phase: Phase,
        contact: ScaledContact,
        slip: float,
        factor: float,
    ) -> Mapping[str, NDArray[Any]]:
        """Return named arrays (traction, stuck, ...) of one impact at one instant.

        ``factor`` is what the scaled solution is to be multiplied with: -1 for an impact
        with negative slip velocity, and see clause 2.

        Parameters
        ----------
        normal : ClosedFormMotion
            Of the impact, for its scales.
        phase : Phase
            The one that holds at the instant.
        contact : ScaledContact
            At the instant, of floats.
        slip : float
            Scaled.
        factor : float
            What the scaled solution is to be multiplied with: -1 for an impact with negative slip
            velocity, and see clause 2.
        """
        return {}


class ManyPhasedTangentialLaw(PhasedTangentialLaw):
    """A phased law that can also integrate many impacts in one call, which is faster.

    Contract
    --------
    1. ``impacts_together`` gives, to ``tolerance`` times max(1, velocity), what its phases give
       one by one, or says that it gave up; it does not raise for a numerical failure.
    2. An answer depends on the other impacts of the call by less than 1e-10.
    3. It holds down to the tolerance ``finest_together``; an integrator that is to be better
       takes impacts one by one.
    """

    finest_together: ClassVar[float]

    @abstractmethod
    def impacts_together(
        self, velocity: Array, inertia: Array, motion: ClosedFormMotion, tolerance: float
    ) -> ManyImpacts:
        """Return the answers to many impacts.

        Parameters
        ----------
        velocity, inertia : ndarray, shape (impacts,)
            Finite and positive.
        motion : ClosedFormMotion
            Of a batch; only what is scaled is asked of it.
        tolerance : float
        """
