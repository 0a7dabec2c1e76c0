"""The contracts of eccentric impacts, in which friction changes the approach (theory §14)."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

import attrs

from contactlab.contracts.batch_motion import BatchMotion
from contactlab.contracts.contact import NormalContact
from contactlab.contracts.integrator import Integrator
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.tangential import SteppedTangentialLaw, TangentialLaw
from contactlab.impact.eccentric import EccentricScene
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real


@attrs.frozen(kw_only=True, eq=False)
class EccentricMotion(BatchMotion):
    """The motion of an eccentric impact; entries have the batch shape.

    Attributes
    ----------
    velocity_change : array, shape (..., 3)
        Change of approach and slip velocities along n, t1 and t2, in m/s.
    friction_work : float or array
        Friction work in J, added up by the law from traction and slip.
    normal_loss : float or array
        Energy in J that the normal law took; 0 for an elastic law.
    duration : float or array
        Time of contact in s.
    maximum_radius, maximum_approach, maximum_force : float or array
        Greatest contact radius (m), approach (m) and normal force (N).
    compressions : int or array
        How often the approach grew: 1, or more where friction presses the bodies together again.
    status : Status or array of Status
    detail : str or array of str
        What failed; empty on success.
    counters : mapping of str to int
    """

    velocity_change: Any = attrs.field(metadata={"ends": (3,)})
    friction_work: Real
    normal_loss: Real
    duration: Real
    maximum_radius: Real
    maximum_approach: Real
    maximum_force: Real
    compressions: Any = attrs.field(default=1, metadata={"kind": int})

    @property
    def slip_velocity_change(self) -> Any:
        """Change of the slip velocity along t1 and t2 in m/s, shape (..., 2)."""
        return self.velocity_change[..., 1:]


class EccentricSample(NamedTuple):
    """One instant of an eccentric impact, as passed to an observer.

    Attributes
    ----------
    time : float or array, shape (...,)
        Time in s, 0 at first touch.
    approach, normal_velocity : float or array
        Approach in m and its rate in m/s.
    contact : NormalContact
        The normal contact.
    slip_velocity, tangential_force : array, shape (..., 2)
        Along t1 and t2, in m/s and N; a force that opposes the slip is positive.
    """

    time: Real
    approach: Real
    normal_velocity: Real
    contact: NormalContact
    slip_velocity: Any
    tangential_force: Any


EccentricObserver: TypeAlias = Callable[[EccentricSample], None]


class IncrementalTangentialLaw(SteppedTangentialLaw):
    """Base of stepped laws that need nothing of the motion to come.

    Contract
    --------
    1. ``begin(scene, normal)`` returns the state at first touch. ``scene`` is the central impact
       with the same approach, ``normal`` the approach without friction, from which a law may take
       scales; the motion that follows may be another, with a larger contact, or with several
       compressions.
    2. ``advance`` depends on its arguments only: the contact before and after, and the step.
    3. ``stiffness`` is an upper bound for the contacts of the approach without friction.
    """

    def begin(self, scene: Scene, normal: NormalMotion) -> Any:
        """Return the state at first touch; by default that of ``start``."""
        return self.start(scene, normal)


class VectorTangentialLaw(IncrementalTangentialLaw):
    """Base of laws whose displacement may be a vector of the tangent plane.

    Contract
    --------
    1. From the state of ``begin_vectors``, ``advance`` takes displacements and slip velocities of
       shape (..., 2) and returns a force of this shape; friction work has the batch shape.
    2. A rotation of all vectors in the tangent plane rotates the forces.
    3. The length of the force does not exceed mu times the friction load.
    """

    @abstractmethod
    def begin_vectors(self, scene: Scene, normal: NormalMotion) -> Any:
        """Return the state at first touch for displacements that are vectors, as ``begin``."""


class EccentricTangentialLaw(TangentialLaw):
    """Base of tangential laws that answer eccentric impacts as a whole; no integrator is used.

    Parameters of methods
    ---------------------
    scene : EccentricScene
        One impact or a batch.
    normal : NormalMotion
        The approach without friction, with its law.
    accuracy : float or None
        Error of psi2 over max(1, psi1) that is aimed at; None for the law's own.
    observer : callable, optional
        Called with the instants of a single impact.
    """

    @abstractmethod
    def refuses_eccentric(self, scene: EccentricScene) -> str | None:
        """Return why the law has no answer to ``scene``; None if it has one."""

    @abstractmethod
    def eccentric_impacts(
        self,
        scene: EccentricScene,
        normal: NormalMotion,
        accuracy: float | None,
        observer: EccentricObserver | None = None,
    ) -> EccentricMotion:
        """Return the motion of every impact of ``scene``."""


class EccentricIntegrator(Integrator):
    """Base of integrators that march normal and incremental tangential laws together."""

    @abstractmethod
    def integrate_eccentric(
        self,
        scene: EccentricScene,
        normal: NormalMotion,
        tangential: IncrementalTangentialLaw,
        observer: EccentricObserver | None = None,
    ) -> EccentricMotion:
        """Return the motion of every impact of ``scene``.

        Parameters
        ----------
        scene : EccentricScene
            One impact or a batch.
        normal : NormalMotion
            The approach without friction: its law is marched, its duration counts the steps.
        tangential : IncrementalTangentialLaw
            A ``VectorTangentialLaw`` for a scene in space.
        observer : callable, optional
            Called with every sample.
        """
