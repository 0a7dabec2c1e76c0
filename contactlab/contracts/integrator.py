"""The contract of integrators, and the tangential motion that they return."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar, NamedTuple, Self, TypeAlias

import attrs

from contactlab.contracts.batch_motion import BatchMotion
from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.sampled_motion import Ends
from contactlab.contracts.tangential import TangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real

#: Impacts of a sweep that an integrator receives at a time, by default.
CHUNK = 1000


class Sample(NamedTuple):
    """One instant of an impact, as passed to an observer.

    Attributes
    ----------
    time : float or array, shape (...,)
        Time in s, 0 at first touch.
    approach, normal_velocity : float or array
        Approach in m and its rate in m/s, positive in compression.
    contact : NormalContact
        The normal contact.
    slip_velocity : float or array
        v_x in m/s.
    tangential_force : float or array
        F in N, positive where it opposes a positive slip velocity.
    fields : callable
        Returns the law's arrays over the contact radius; observers call it only if they keep them.
    """

    time: Real
    approach: Real
    normal_velocity: Real
    contact: NormalContact
    slip_velocity: Real
    tangential_force: Real
    fields: Callable[[], Mapping[str, Any]]


#: Called with each instant; it must not change its argument. If its attribute ``stepwise`` is
#: False, it never calls ``Sample.fields``, and a law may take all steps in one call before.
Observer: TypeAlias = Callable[[Sample], None]


@attrs.frozen(kw_only=True, eq=False)
class TangentialMotion(BatchMotion):
    """The tangential motion that an integrator returns; entries have the batch shape.

    Attributes
    ----------
    slip_velocity_change : float or array
        Change of v_x in m/s. It is not added to v_x, which may be so large that the sum would
        lose digits of the change.
    friction_work : float or array
        Friction work in J, summed over the answers of the tangential law.
    status : Status or array of Status
        How the run of each impact ended.
    detail : str or array of str
        What failed, at which step and time; empty on success. An integrator may give one
        sentence for a batch, which goes to the impacts that failed.
    counters : mapping of str to int
        Operations counted: ``steps``, ``evaluations``, ``rejected``, ...
    normal : NormalMotion, Ends or None
        The normal motion that came of the friction, if the friction changes it. Restitution,
        duration and maxima of the result are then those of this motion, and the energy books take
        the dissipation that the normal law declares.
    """

    slip_velocity_change: Real
    friction_work: Real
    normal: NormalMotion | Ends | None = None

    @classmethod
    def merged(cls, parts: Sequence[tuple[Any, Self]], shape: tuple[int, ...]) -> Self:
        """Return one motion of ``shape``, with the ends of the normal motions of the parts.

        Parameters
        ----------
        parts, shape
            As of ``BatchMotion.merged``.
        """
        motion = super().merged(parts, shape)
        normals = [(where, part.normal) for where, part in parts]
        if all(normal is None for _, normal in normals):
            return motion
        return attrs.evolve(motion, normal=Ends.merged(normals, shape))


class Integrator(Law):
    """Base of integrators, which follow the tangential motion along a normal motion.

    Contract
    --------
    1. ``integrate(normal, tangential, scene, observer)`` returns a ``TangentialMotion``. The
       method is pure. It never raises for a numerical failure; it returns a status and the
       motion so far.
    2. Every loop is bounded.
    3. ``observer`` is None or is called at increasing times. An observer changes no result.
    4. ``order`` is the declared order of convergence in the step, for smooth laws; None if the
       integrator takes no steps.
    5. A batch gives the same results as its impacts one by one. If an impact fails, the
       integrator may give the batch up; the simulation then runs each impact alone. An
       integrator with ``own_statuses`` does not give the batch up: its statuses hold for each
       impact alone.
    6. ``tangential_contract`` and ``normal_contract`` are the classes of laws that the
       integrator accepts.
    7. ``psi2_error`` is a bound of the numerical error of psi2, from the declaration of the
       tangential law; NaN, the default, means not declared.
    8. ``resolution`` is the name of the option, steps or tolerance, that controls the error. If
       the integrator refines by itself, ``resolution_for`` returns the value used; errors are
       estimated by doubling that value, not the option.

    Parameters of methods
    ---------------------
    normal : NormalMotion
        Normal motion of all impacts of ``scene``.
    tangential : TangentialLaw
        The law that is run.
    scene : Scene
        One impact or a batch.
    """

    kind: ClassVar[str] = "integrator"
    tangential_contract: ClassVar[Any]  # a type; mypy allows no abstract one
    normal_contract: ClassVar[Any] = NormalLaw
    order: ClassVar[int | None] = None
    #: False if the impacts of a batch have different instants; batches then have no history.
    common_instants: ClassVar[bool] = True
    own_statuses: ClassVar[bool] = False

    @property
    def accuracy(self) -> float | None:
        """Controlled error of psi2 over max(1, abs(psi1)); None if no error is controlled."""
        return None

    def chunk(self, tangential: TangentialLaw) -> int:
        """Return the number of impacts that a sweep should pass at a time.

        Large chunks hide the cost of a call; small chunks lose little by an interruption.
        """
        return CHUNK

    def remarks(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
    ) -> tuple[str, ...]:
        """Return sentences for the plan of these impacts; empty by default."""
        return ()

    def resolution_for(self, normal: NormalMotion, tangential: TangentialLaw, scene: Scene) -> Real:
        """Return the resolution used for each impact: by default the value of the option.

        Returns
        -------
        float or array
            0 if the integrator has no resolution.
        """
        return float(getattr(self, self.resolution)) if self.resolution else 0.0

    def psi2_error(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
    ) -> Real:
        """Return the declared bound of the numerical error of psi2, of the batch shape.

        NaN, the default, means not declared.
        """
        return math.nan

    @abstractmethod
    def integrate(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the tangential motion from first touch to separation.

        Parameters
        ----------
        observer : callable, optional
            Called with a ``Sample`` at increasing times (clause 3).
        """
