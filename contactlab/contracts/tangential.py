"""The contracts of tangential laws: friction force from slip displacement and history."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, NamedTuple

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law, claims
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.tangential_motion import Observer, TangentialMotion
from contactlab.contracts.whole_impact import WholeImpact, no_force
from contactlab.impact import kinetics
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
    slip: Real
    force: Real
    mobility: Real


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
        The motion at the end of the step. Laws that share a loss are given it.
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


class Errors(NamedTuple):
    """Declared bounds of numerical errors, of the batch shape; NaN means not declared.

    Attributes
    ----------
    psi2 : float or array
        Bound of psi2; in space of the length of its error.
    restitution : float or array
        Bound of V2/v1, the normal restitution.
    resolution : float or array
        The integrator's, where it takes another than its option says; estimates refine it.
    """

    psi2: Real = math.nan
    restitution: Real = math.nan
    resolution: Real = math.nan


class Resolutions(NamedTuple):
    """Resolutions of impacts for which nobody named any, of the batch shape.

    Attributes
    ----------
    own, integrator : float or array
        Resolutions of the tangential law and of the integrator.
    reason : str
        Why these, for a plan.
    """

    own: Real
    integrator: Real
    reason: str


def shares_loss(tangential: Law, normal: Law) -> bool:
    """Return whether a tangential law loses energy in shear as a viscous normal law in pressure.

    Parameters
    ----------
    tangential, normal : Law
    """
    return "viscous" in claims(normal) and "shares_loss" in claims(tangential)


class TangentialLaw(Law, kind="tangential"):
    """Base of tangential laws, which return the tangential force of a contact.

    Contract
    --------
    1. Friction is Coulomb's: abs(F) <= mu times the friction load, and F = 0 out of contact; a
       discrete law may exceed this limit by its declared error. The law is odd in the slip.
    2. A subclass determines how the law is run: by steps (``SteppedTangentialLaw``), along its
       path between events (``PathTangentialLaw``), or as wholes (``WholeImpactTangentialLaw``);
       where friction changes the approach, by steps (``CausalTangentialLaw``) or by the law's own
       solution (``CoupledTangentialLaw``). A law may be derived from several of these classes.
    3. Impacts for which a whole-impact answer holds are not marched; the first that holds is used.
       A law that can be marched is marched where an answer has no course and a history is asked
       for, and where its error exceeds that which the integrator controls.

    Parameters of methods
    ---------------------
    scene : Scene
        One impact or a batch.
    normal : NormalMotion
        Normal motion of all impacts of ``scene``; without friction where friction changes it.
    """

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the whole-impact answers: by default for central impacts and for mu = 0."""
        slip: Real = scene.slip_velocity
        friction: Real = scene.friction_coefficient
        central, smooth = slip == 0.0, friction == 0.0
        if kinetics.turns(scene) and "normal_spin" in claims(self):
            central = central & (scene.normal_spin == 0.0)
        found: tuple[WholeImpact, ...] = ()
        if central is not False:  # one impact is a bool
            found = (no_force(scene, where=central, reason="central impact, no slip velocity"),)
        if smooth is not False:
            found += (no_force(scene, where=smooth, reason="friction coefficient 0"),)
        return found

    def errors(
        self, scene: Scene, normal: NormalMotion, steps: Real, accuracy: float | None = None
    ) -> Errors:
        """Return declared bounds of the numerical errors; NaN, the default: not declared.

        Parameters
        ----------
        steps : int or array
            Even steps of an integrator of second order; infinite steps add no error.
        accuracy : float, optional
            Error of psi2 that the integrator controls; None for the law's own.
        """
        return Errors()

    def books_bound(self, scene: Scene) -> Real:
        """Return the largest imbalance of the energy books, over the energy at the start.

        Infinite, the default, means not declared: the plan then cautions of one above 0.01. The
        error that an integrator controls is allowed in addition.
        """
        return math.inf

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return one sentence for each doubt about the model; by default on unlike bodies.

        Asked when a plan is read; after a run ``normal`` has the ends and maxima of the run.
        """
        from contactlab.impact.coupling import coupling  # only for words

        return coupling(scene)


class WholeImpactTangentialLaw(TangentialLaw, way="whole"):
    """Base of tangential laws whose whole-impact answers together hold for every impact."""

    @abstractmethod
    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return whole-impact answers that together hold for all impacts."""
        return super().whole_impacts(scene, normal)


class CoupledTangentialLaw(TangentialLaw, way="coupled"):
    """Base of tangential laws that find normal and tangential motion together, themselves."""

    @abstractmethod
    def solve_coupled(
        self,
        scene: Scene,
        normal: NormalMotion,
        accuracy: float | None,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion of impacts in which friction changes the approach, with its ends.

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
        """


class ResolvingTangentialLaw(TangentialLaw, way="resolving"):
    """Base of tangential laws that choose their resolution and the integrator's by the scene."""

    @abstractmethod
    def resolutions(self, scene: Scene, normal: Law, integrator: Law) -> Resolutions | None:
        """Return resolutions of law and integrator for each impact; None stands for the usual ones.

        Impacts with the same pair of numbers are solved together, so that few pairs are best.

        Parameters
        ----------
        normal, integrator : Law
            The laws beside it.
        """


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
    drift: Array
    kick: Array
    friction_load: Array
    time: Array
    approach: Array
    rate: Array


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


class SteppedTangentialLaw(TangentialLaw, way="stepped"):
    """Base of tangential laws that answer to a step, as in the return mapping of plasticity.

    Contract
    --------
    1. The state holds the memory of the law, and what it needs of scene and normal motion.
       ``advance`` does not change it, so that an integrator may reject a step.
    2. Coulomb's limit uses the friction load of the contact, or the increment's; never the normal
       force, which may pull. A normal force that grows at displacement 0 makes no force.
    """

    @abstractmethod
    def start(self, scene: Scene, normal: NormalMotion) -> Any:
        """Return the state at first touch."""

    @abstractmethod
    def advance(
        self, state: Any, increment: Increment, before: NormalContact, after: NormalContact
    ) -> tuple[TangentialResponse, Any]:
        """Return the response at the end of the step, and the new state.

        Parameters
        ----------
        state : object
            The state at first touch, or that of the last step.
        increment : Increment
            Displacement, slip velocity, mean friction load and duration of the step.
        before, after : NormalContact
            The normal contact at the two ends of the step, friction load included.
        """

    def stiffness(self, scene: Scene, normal: NormalMotion) -> Real:
        """Return an upper bound of dF/dD in N/m, which bounds a stable step; 0 if there is none.

        A law that offers ``partial_slip`` damps the oscillation; others take more steps.
        """
        return 0.0

    def fields(self, state: Any) -> Mapping[str, AnyArray]:
        """Return named arrays of the state for the history (traction, stuck, ...).

        Parameters
        ----------
        state : object
        """
        return {}

    def path_cautions(self) -> tuple[str, ...]:
        """Return one sentence for each doubt about forces and ``fields`` along a path; none here.

        Asked along a prescribed path, and where an impact's history has the fields.
        """
        return ()


class CausalTangentialLaw(SteppedTangentialLaw, way="causal"):
    """Base of stepped laws that need no knowledge of the later motion, which friction may change.

    After ``begin``, ``advance`` depends on its arguments only: the motion may have a larger
    contact than the approach without friction, or several compressions.
    """

    def begin(self, scene: Scene, normal: NormalMotion, *, vectors: bool = False) -> Any:
        """Return the state at first touch, without a motion to come; by default that of ``start``.

        Parameters
        ----------
        normal : NormalMotion
            The approach without friction, from which a law may take scales.
        vectors : bool
            True if displacements are vectors of the tangent plane; only of a law that offers them.
        """
        return self.start(scene, normal)


class AllStepsTangentialLaw(SteppedTangentialLaw):
    """Base of stepped laws that can also take all steps in one call, which is faster."""

    @abstractmethod
    def advance_all(
        self, scene: Scene, normal: NormalMotion, steps: Steps
    ) -> AllStepsResponse | None:
        """Return, to rounding, the forces that ``advance`` returns step by step.

        Each step reduces the slip velocity by force times kick over tangential mass. With None the
        impacts are marched step by step, as a batch is where the law takes single impacts only.

        Parameters
        ----------
        steps : Steps
            The steps, with the normal contact at each.
        """
