"""The contracts of tangential laws: friction force from slip displacement and history."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.tangential_motion import Observer, TangentialMotion
from contactlab.contracts.whole_impact import WholeImpact, no_force
from contactlab.impact.coupling import coupling
from contactlab.impact.scene import Scene
from contactlab.numeric.types import AnyArray, Array, Mask, Real


class Sampled(NamedTuple):
    """The motion at the end of a step, where its force acts; entries broadcast to the batch shape.

    A law whose force depends on rates takes them from here. The slip velocity there depends on the
    force in turn: it is ``slip`` if the force is ``force``, and falls by ``mobility`` for each
    newton more.

    Attributes
    ----------
    approach, rate : float or array
        Approach in m and its rate in m/s, positive in compression.
    slip, force : float or array
        Slip velocity in m/s and the force in N that it belongs to; shape (..., 2) for vectors.
    mobility : float or array
        In m/(N s): half the duration over the tangential mass; 0 along a prescribed path.
    """

    approach: Real
    rate: Real
    slip: Any
    force: Any
    mobility: Any


class Increment(NamedTuple):
    """One step as a stepped law sees it; every entry broadcasts to the batch shape.

    Attributes
    ----------
    displacement : float or array
        Increment of D in m over the step: relative tangential displacement of the bodies, far
        from the contact.
    velocity : float or array
        v_x in m/s, the slip velocity at the start of the step.
    friction_load : float or array
        Friction load in N, never negative: the mean over the time for which the force of the
        answer acts.
    duration : float or array
        The time in s for which the force of the answer acts.
    drift : float or array
        The time in s for which the bodies moved: ``displacement`` is ``velocity`` times ``drift``.
        NaN, the default, if the integrator does not tell.
    sampled : Sampled, optional
        The motion at the end of the step. Integrators give it to laws with ``shares_loss``.
    """

    displacement: Real
    velocity: Real
    friction_load: Real
    duration: Real
    drift: Real = math.nan
    sampled: Sampled | None = None


class TangentialResponse(NamedTuple):
    """Answer of a stepped law to an increment; every entry has the batch shape.

    Attributes
    ----------
    force : float or array
        F in N, positive where it opposes a positive slip velocity.
    friction_work : float or array
        Friction work in J over ``displacement``, at least 0: the sum of traction times slip over
        slipping parts, not an energy balance. The slip is part of the displacement; the traction
        is the mean of the tractions at the two ends of the step; where the law shares a loss,
        whose steps are uneven, that at the end counts ``duration/(2 drift)``. With these two
        rules the energy books close under every integrator.
    settled : bool or array
        False where the law has no answer; the run then ends with a status.
    shear_loss : float or array
        Energy in J that the bodies lose in shear over ``duration``, at least 0: that of a viscous
        contact, beside the friction work.
    """

    force: Real
    friction_work: Real
    settled: Mask = True
    shear_loss: Real = 0.0


class TangentialLaw(Law):
    """Base of tangential laws, which return the tangential force of a contact.

    Contract
    --------
    1. Friction is Coulomb's: abs(F) <= mu times the friction load, and F = 0 out of contact. A
       discrete law may exceed this limit by its declared discretisation error.
    2. The law is odd: reversing every displacement reverses every force. A central impact
       (v_x = 0) has no tangential force, whatever the normal motion.
    3. A subclass determines how the law is run: ``SteppedTangentialLaw`` for laws that answer
       to a step, ``contactlab.contracts.path.PathTangentialLaw`` for laws that know their path
       between events, ``WholeImpactTangentialLaw`` for laws that need no march. A law may be
       derived from several of these classes.
    4. ``whole_impacts`` returns the whole-impact answers of the law; the impacts for which they
       hold are not marched. If several answers hold for an impact, the first is used. A law that
       can be marched is marched where an answer has no course and a history is asked for, and
       where the error of an answer exceeds the error that the integrator controls.
    5. ``psi2_error`` is a bound of the error of psi2 from the law's own discretisation and
       from ``steps`` even steps of an integrator of second order; infinite ``steps`` add no
       error. NaN, the default, means not declared.
    6. ``cautions`` returns doubts about the model. The method is asked when a plan is read, about
       the whole batch; after a run ``normal`` has the ends and maxima of the run at hand, and all
       else is computed again.
    7. ``books_bound`` is a bound of the relative error of the energy books; infinite, the default,
       means not declared.
    8. A law with the word ``together`` answers impacts in which friction changes the approach:
       ``impacts_together`` returns normal and tangential motion, and ``errors_together`` their
       errors. With the word ``vectors`` it does so where the slip turns too.
    9. ``shares_loss(normal_law)`` is True if the force depends on the slip velocity too, through
       the loss of a viscous normal law. Increments then have ``sampled``, and integrators
       grade their steps at first touch, where such a force grows as the root of time.
    10. A law with the word ``normal_spin`` answers impacts of bodies that spin about the normal,
        ``scene.normal_spin``: its whole-impact answers have ``normal_spin_change``. By symmetry
        the change of slip is even in the spin, that of the spin odd, and there is no force across
        the slip. Other laws leave the spin as it is, and the plan cautions with a size.

    Parameters of methods
    ---------------------
    scene : Scene
        One impact or a batch.
    normal : NormalMotion
        Normal motion of all impacts of ``scene``.
    """

    kind: ClassVar[str] = "tangential"
    together: ClassVar[bool] = False
    vectors: ClassVar[bool] = False
    whole: ClassVar[bool] = False

    @property
    def normal_spin(self) -> bool:
        """True if the law answers spin about the normal (clause 10); False by default."""
        return False

    def books_bound(self, scene: Scene) -> Real:
        """Return the largest relative error of the energy books that counts as success.

        The error is the imbalance over the energy at the start. Infinite, the default, means not
        declared: the plan then cautions of an imbalance above 0.01, and 1 counts as success. The
        error that an integrator controls is allowed in addition.

        Returns
        -------
        float or array
            At least 0; broadcasts to the batch shape.
        """
        return math.inf

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the whole-impact answers: by default for central impacts and for mu = 0."""
        slip: Any = scene.slip_velocity
        friction: Any = scene.friction_coefficient
        central, smooth = slip == 0.0, friction == 0.0
        if self.normal_spin and scene.turns:
            central = central & (scene.normal_spin == 0.0)
        reasons = (
            (central, "central impact, no slip velocity"),
            (smooth, "friction coefficient 0"),
        )
        return tuple(
            no_force(scene, where=where, reason=reason)
            for where, reason in reasons
            if where is not False  # not of one impact, which it does not hold for
        )

    def needs_no_march(self, scene: Scene, accuracy: float | None) -> bool:
        """Return True if ``whole_impacts`` answers for all impacts: sweeps then take more at once.

        False, the default, is always safe.

        Parameters
        ----------
        accuracy : float or None
            The error that the integrator controls: answers with a larger one are not used.
        """
        return False

    @classmethod
    def solver(cls) -> str:
        """Return in words what computes the answers, where that depends on the installation."""
        return ""

    @classmethod
    def one_by_one(cls) -> str:
        """Return in words what makes a batch as slow as its impacts one by one; empty if not."""
        return ""

    def shares_loss(self, normal: Law) -> bool:
        """Return whether the law shares the loss of a normal law (clause 9); False by default.

        Parameters
        ----------
        normal : NormalLaw
        """
        return False

    def psi2_error(self, scene: Scene, normal: NormalMotion, steps: Real) -> Real:
        """Return the declared bound of the numerical error of psi2, of the batch shape.

        Parameters
        ----------
        steps : int or array of int
            Steps of each impact from first touch to separation.
        """
        return math.nan

    def errors_in_steps(self, scene: Scene, normal: NormalMotion, steps: Real) -> tuple[Real, Real]:
        """Return declared bounds of the numerical errors of psi2 and of the normal restitution.

        They hold where friction changes the approach and an integrator marches both motions. NaN,
        the default, means not declared. Of a psi2 with two components it is the length of the
        error.

        Parameters
        ----------
        scene : Scene
            One impact or a batch, with its inverse mass.
        normal : NormalMotion
            The approach without friction.
        steps : array of float
            Steps of each impact in the duration of that approach.
        """
        return math.nan, math.nan

    def seconds_in_steps(self, scene: Scene, normal: NormalMotion, steps: Real) -> float:
        """Return about how many seconds a march of both motions takes on a computer of 2026.

        NaN, the default, means not measured.

        Parameters
        ----------
        scene, normal, steps
            As in ``errors_in_steps``.
        """
        return math.nan

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return one sentence for each doubt about the model; by default on unlike bodies."""
        return coupling(scene)

    def impacts_together(
        self,
        scene: Scene,
        normal: NormalMotion,
        accuracy: float | None,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion of impacts in which friction changes the approach (clause 8).

        Parameters
        ----------
        scene : Scene
            One impact or a batch, with its inverse mass.
        normal : NormalMotion
            The approach without friction, with its law.
        accuracy : float or None
            Error of psi2 over max(1, psi1) that is aimed at; None for the law's own.
        observer : callable, optional
            Called with the instants of a single impact.

        Returns
        -------
        TangentialMotion
            Its ``normal`` holds the ends of the normal motion.
        """
        raise NotImplementedError(f"{type(self).__name__} has not the word 'together'")

    def errors_together(self, scene: Scene, accuracy: float | None) -> tuple[Real, Real]:
        """Return declared bounds of the numerical errors of psi2 and of the normal restitution.

        NaN, the default, means not declared.

        Parameters
        ----------
        scene : Scene
        accuracy : float or None
            As in ``impacts_together``.
        """
        return math.nan, math.nan


class WholeImpactTangentialLaw(TangentialLaw):
    """Base of tangential laws that have a whole-impact answer for every impact.

    Contract
    --------
    1. The answers of ``whole_impacts`` together hold for all impacts, which the word ``whole``
       says. No integrator is used.
    """

    whole: ClassVar[bool] = True

    @abstractmethod
    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return whole-impact answers that together hold for all impacts."""
        return super().whole_impacts(scene, normal)


class Steps(NamedTuple):
    """The K even steps of an impact, as arrays of shape (K,).

    For a batch the shape is (K, ...), with axes of length 1 along which all impacts are equal.
    Each step drifts to a sample of the normal contact, asks the law for a force, and kicks.

    Attributes
    ----------
    contact : NormalContact
        Normal contact at the samples, as arrays.
    drift : array
        Time in s from the last sample to this sample, for which the slip velocity acts on the
        displacement.
    kick : array
        Time in s for which the force at the sample acts on the slip velocity.
    friction_load : array
        Mean of the friction load over the kick, in N.
    time, approach, rate : array
        Time in s, approach in m and rate in m/s at the samples.
    """

    contact: Any
    drift: Any
    kick: Any
    friction_load: Any
    time: Any
    approach: Any
    rate: Any


class AllStepsResponse(NamedTuple):
    """Answer of a law to all steps.

    Attributes
    ----------
    force : array, shape (K,), or (K, ...) of a batch
        F in N at the samples; fewer than K if the law stopped.
    friction_work : float or array of the batch shape
        Friction work in J, summed over the steps.
    settled : bool or array of bool
        False where the law has no answer to the step after the last force.
    shear_loss : float or array of the batch shape
        Energy in J that the bodies lose in shear, summed over the steps.
    """

    force: Array
    friction_work: Real
    settled: Mask
    shear_loss: Real = 0.0


class SteppedTangentialLaw(TangentialLaw):
    """Base of tangential laws that answer to a step, as in the return mapping of plasticity.

    Contract
    --------
    1. ``start(scene, normal)`` returns the state at first touch. The state holds the memory of
       the law, and the numbers that the law needs of scene and normal motion: stiffness,
       friction coefficient, a grid that spans the largest contact.
    2. ``advance(state, increment, before, after)`` returns ``(TangentialResponse, state)``.
       The method does not change its argument ``state``, so an integrator may reject a step and
       try another one.
    3. ``before`` and ``after`` are the normal contact at the two ends of the step. Coulomb's
       limit uses their friction load, or the increment's; never the normal force, which may
       pull.
    4. A normal force that grows at displacement 0 makes no tangential force.
    5. ``fields(state)`` returns named arrays for the history and changes nothing.
    6. ``stiffness(scene, normal)`` is an upper bound of dF/dD in N/m, from which an integrator
       computes its largest stable step; 0 for a law whose force does not depend on
       displacement. A law that offers ``partial_slip`` damps the oscillation by microslip. For
       other laws integrators take more steps, as phase errors add up over all periods.
    7. A law whose ``needs_future`` is False takes nothing of the motion to come: ``advance``
       depends on its arguments only. Such a law runs where friction changes the approach. ``begin``
       returns its state there; ``normal`` is the approach without friction, from which a law may
       take scales; the motion that follows may be another, with a larger contact, or with several
       compressions. ``stiffness`` is an upper bound for the contacts of the approach alone.
    8. With the word ``vectors`` a law without future takes displacements and slip velocities of
       shape (..., 2) from the state of ``begin(..., vectors=True)``, and returns a force of this
       shape; friction work has the batch shape. A rotation of all vectors rotates the forces; the
       length of the force does not exceed mu times the friction load.

    Parameters of methods
    ---------------------
    state : object
        The state that ``start``, ``begin`` or the last step returned.
    """

    needs_future: ClassVar[bool] = True

    @abstractmethod
    def start(self, scene: Scene, normal: NormalMotion) -> Any:
        """Return the state at first touch."""

    def begin(self, scene: Scene, normal: NormalMotion, *, vectors: bool = False) -> Any:
        """Return the state at first touch of a motion to come; by default that of ``start``.

        Parameters
        ----------
        vectors : bool
            True if displacements are vectors of the tangent plane.
        """
        return self.start(scene, normal)

    @abstractmethod
    def advance(
        self, state: Any, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, Any]:
        """Return the response at the end of the step, and the new state.

        Parameters
        ----------
        increment : Increment
            Displacement, slip velocity, mean friction load and duration of the step.
        before, after : NormalContact
            The normal contact at the two ends of the step, friction load included.
        """

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return an upper bound of the tangential stiffness, in N/m, of the batch shape."""
        return 0.0

    def path_cautions(self) -> tuple[str, ...]:
        """Return one sentence for each doubt about the law along a prescribed path; none here."""
        return ()

    def fields(self, state: Any) -> Mapping[str, AnyArray]:
        """Return named arrays of ``state`` for the history (traction, stuck, ...)."""
        return {}


class AllStepsTangentialLaw(SteppedTangentialLaw):
    """Base of stepped laws that can also take all steps in one call, which is faster.

    Contract
    --------
    1. ``advance_all(scene, normal, steps)`` returns, to rounding, the forces that ``advance``
       returns step by step when each step reduces the slip velocity by force times kick over
       tangential mass.
    2. ``scene`` is one impact or a batch. Forces of a batch have shape (K, ...).
    3. ``advance_all`` may return None; the impacts are then marched step by step. A law that
       implements single impacts only returns None if ``scene.shape`` is not empty.
    """

    @abstractmethod
    def advance_all(
        self, scene: Scene, normal: NormalMotion, steps: Steps
    ) -> AllStepsResponse | None:
        """Return the forces of all steps, of one impact or of each of a batch.

        Parameters
        ----------
        steps : Steps
            The steps, with the normal contact at each.
        """
