"""The contract of integrators."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Any, ClassVar

from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import NormalLaw
from contactlab.contracts.tangential import TangentialLaw
from contactlab.contracts.tangential_motion import Observer, TangentialMotion
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real

#: Impacts of a sweep that an integrator receives at a time, by default.
CHUNK = 1000


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
    8. An integrator with the word ``together`` also has ``integrate_together``, which marches the
       normal law and a tangential law that needs no future at once, where friction changes the
       approach; ``errors_together`` are the errors, and ``seconds_together`` is about the time
       that this takes, from the declarations of the tangential law.
    9. ``resolution`` is the name of the option, steps or tolerance, that controls the error. If
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
    together: ClassVar[bool] = False

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

    def errors_together(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
    ) -> tuple[Real, Real]:
        """Return declared bounds of the errors of psi2 and of the normal restitution (clause 8).

        NaN, the default, means not declared.
        """
        return math.nan, math.nan

    def seconds_together(
        self, normal: NormalMotion, tangential: TangentialLaw, scene: Scene
    ) -> float:
        """Return about how many seconds the march takes (clause 8); NaN, the default: not known."""
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

    def integrate_together(
        self,
        normal: NormalMotion,
        tangential: TangentialLaw,
        scene: Scene,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion of impacts in which friction changes the approach (clause 8).

        Parameters
        ----------
        normal : NormalMotion
            The approach without friction: its law is marched, its duration counts the steps.
        tangential : SteppedTangentialLaw
            A law that needs no future; one that takes vectors if the scene has vectors.
        scene : Scene
            One impact or a batch, with its inverse mass.
        observer : callable, optional
            Called with every sample.
        """
        raise NotImplementedError(f"{type(self).__name__} has not the word 'together'")
