"""The contract of a tangential law: friction force from slip displacement and history."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.whole_impact import WholeImpact, no_force
from contactlab.impact.coupling import coupling
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Mask, Real

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
    friction_load : float or array
        The normal force in N that Coulomb's limit is taken of, never negative: the mean over
        the time in which the answer will act.
    duration : float or array
        That time, in s.
    """

    displacement: Real
    velocity: Real
    friction_load: Real
    duration: Real


class TangentialResponse(NamedTuple):
    """What a tangential law answers; every entry has the batch shape.

    Attributes
    ----------
    force : float or array
        F in N, positive where it opposes positive slip velocity.
    friction_work : float or array
        In J, at least 0: work done by friction on slipping parts over ``displacement``, added up
        from traction and slip, not from an energy balance. The slip is part of the
        displacement, and the traction the mean of those at the two ends of the step: with that
        the books close under any scheme, whatever its stages.
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
    1. Friction is Coulomb's, abs(F) <= mu times the friction load (a discrete law may exceed
       this by its own stated discretisation error), and F = 0 out of contact.
    2. Odd: reversing every displacement reverses every force. A central impact (v_x = 0)
       makes no tangential force, whatever the normal motion.
    3. How a law is run is a narrower contract: ``SteppedTangentialLaw`` for laws that answer
       to a step, ``contactlab.contracts.phases.PhasedTangentialLaw`` for laws that are smooth
       between events, ``WholeImpactTangentialLaw`` for laws that need no march. A law may be
       several.
    4. ``whole_impacts`` gives what the law knows of whole impacts; those are not followed. Where
       several answers hold for an impact the first is taken.
    5. ``psi2_error`` is a bound of the error of psi2 that the law's own discretisation and
       ``steps`` even steps of an integrator of second order make; infinite ``steps`` are none.
       NaN, the default: not declared.
    6. ``cautions`` says where the model itself is doubtful.
    """

    kind: ClassVar[str] = "tangential"

    @property
    def books_bound(self) -> float:
        """Imbalance of the energy books, over the energy at the start, that still is success.

        Infinite unless the law declares one. What an integrator that controls its error adds
        comes on top.
        """
        return math.inf

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return what is known of whole impacts: by contract, those of no slip or no friction.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        normal : NormalMotion
            Of all impacts of ``scene``.
        """
        slip: Any = scene.slip_velocity
        friction: Any = scene.friction_coefficient
        central, smooth = slip == 0.0, friction == 0.0
        return (
            no_force(scene, where=central, reason="central impact, no slip velocity"),
            no_force(scene, where=smooth, reason="friction coefficient 0"),
        )

    def psi2_error(self, scene: Scene, normal: NormalMotion, steps: Any) -> Real:
        """Return the declared numerical error of psi2 at so many steps of an impact.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        normal : NormalMotion
            Of all impacts of ``scene``.
        steps : int or array of int
            Of each impact, from first touch to separation.
        """
        return math.nan

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return what to be wary of in the model, a sentence each: coupling of unlike bodies.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        normal : NormalMotion
            Of all impacts of ``scene``.
        """
        return coupling(scene)


class WholeImpactTangentialLaw(TangentialLaw):
    """A tangential law that answers every impact as a whole: no integrator is asked.

    Contract
    --------
    1. ``whole_impacts`` holds everywhere: the last of its answers is for all impacts left.
    """

    @abstractmethod
    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return what is known of whole impacts: everything.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        normal : NormalMotion
            Of all impacts of ``scene``.
        """
        return super().whole_impacts(scene, normal)


class Steps(NamedTuple):
    """All even steps of an impact, arrays of shape (K,).

    Of a batch they are (K, ...), with axes of length 1 where all impacts agree.

    The march drifts to a sample of the normal contact, asks the law, and kicks.

    Attributes
    ----------
    contact : NormalContact
        At the samples, of arrays.
    drift : array
        Time from the last sample to this one, in s: slip velocity acts on displacement.
    kick : array
        Time in s for which the force found at the sample acts on velocity.
    friction_load : array
        Mean of the friction load over the kick, in N.
    time, approach, rate : array
        At the sample.
    """

    contact: Any
    drift: Any
    kick: Any
    friction_load: Any
    time: Any
    approach: Any
    rate: Any


class AllStepsResponse(NamedTuple):
    """What a law answers to all steps.

    Attributes
    ----------
    force : array, shape (K,), or (K, ...) of a batch
        In N, at the samples; fewer than K where it stopped.
    friction_work : float or array of the batch shape
        In J, added up over the steps.
    settled : bool or array of bool
        False where no answer was found to the step after the last force.
    """

    force: Array
    friction_work: Real
    settled: Mask


class SteppedTangentialLaw(TangentialLaw):
    """A tangential law that answers to a step: the return mapping of plasticity.

    Contract
    --------
    1. ``start(scene, normal)`` returns the state at first touch. It holds what the law needs of
       scene and normal motion (stiffness, friction coefficient, a grid that spans the largest
       contact) and its memory.
    2. ``advance(state, increment, before, after)`` returns ``(TangentialResponse, state)``.
       History is a value: the state that goes in stays untouched, so an integrator may try a
       step, reject it and try again.
    3. ``before`` and ``after`` are the normal contact at the two ends of the step. Coulomb's
       limit is taken of their friction load, or of the increment's, never of the force, which
       may be a pull.
    4. Growing normal force alone (displacement 0) makes no tangential force.
    5. ``fields(state)`` names arrays for the history; it changes nothing.
    6. ``stiffness(scene, normal)`` is an upper bound of dF/dD in N/m, from which an integrator
       knows its largest stable step; 0 for a law whose force does not come from displacement.
       Of a law that does not offer ``partial_slip``, whose microslip damps the oscillation,
       the errors of phase of all periods are taken to add up, and more steps are needed.
    """

    @abstractmethod
    def start(self, scene: Scene, normal: NormalMotion) -> Any:
        """Return the state at first touch.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        normal : NormalMotion
            Of all impacts of ``scene``.
        """

    @abstractmethod
    def advance(
        self, state: Any, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, Any]:
        """Return the response at the end of the step, and the new state.

        Parameters
        ----------
        state : object
            As ``start`` or the step before left it.
        increment : Increment
            Displacement, slip velocity, mean friction load and duration of the step.
        before, after : NormalContact
            The normal contact at the two ends of the step, friction load included.
        """

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return the largest tangential stiffness, in N/m.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        normal : NormalMotion
            Of all impacts of ``scene``.
        """
        return 0.0

    def fields(self, state: Any) -> Mapping[str, NDArray[Any]]:
        """Return named arrays of ``state`` for the history (traction, stuck, ...).

        Parameters
        ----------
        state : object
            What ``start`` or ``advance`` returned.
        """
        return {}


class AllStepsTangentialLaw(SteppedTangentialLaw):
    """A stepped law that can also take all steps in one call, which is faster.

    Contract
    --------
    1. ``advance_all(scene, normal, steps)`` gives, to rounding, the forces that ``advance`` gives
       step by step when the slip velocity falls by force times kick over mass after each step.
    2. ``scene`` is one impact or a batch, whose forces have shape (K, ...).
    3. It may return None: these impacts are better done step by step. A law that takes single
       impacts only returns it where ``scene.shape`` is not empty.
    """

    @abstractmethod
    def advance_all(
        self, scene: Scene, normal: NormalMotion, steps: Steps
    ) -> AllStepsResponse | None:
        """Return the forces of a whole impact, or of each of a batch.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        normal : NormalMotion
            Of all impacts of ``scene``.
        steps : Steps
            The contact at every step.
        """
