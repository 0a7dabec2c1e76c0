"""The contract of integrators."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from contactlab.contracts.law import Law, claims, resolution_of
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.tangential import Errors, TangentialLaw
from contactlab.contracts.tangential_motion import Observer, TangentialMotion
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real


class Integrator(Law, kind="integrator"):
    """Base of integrators, which follow the tangential motion along a normal motion.

    Contract
    --------
    1. ``needs`` are the contracts of the laws that it runs, one of them of tangential laws.
    2. ``integrate`` is pure and every loop is bounded. It never raises, whatever a law does: it
       returns a status, the motion so far, and a sentence that names the law, as
       ``faults.sentence(law, what, step)`` makes it. An observer changes no result.
    3. A batch gives the same results as its impacts one by one. Impacts that end with
       the status of a law's fault run again apart, so that it may give a batch up by one.
    4. With a count as ``resolution`` it is of second order in the step, for smooth laws.

    Parameters of methods
    ---------------------
    normal : NormalMotion
        Normal motion of all impacts of ``scene``.
    tangential : TangentialLaw
        The law that is run.
    scene : Scene
        One impact or a batch.
    """

    def errors(self, scene: Scene, normal: NormalMotion, tangential: TangentialLaw) -> Errors:
        """Return declared bounds of the numerical errors; NaN, the default: not declared.

        An integrator that raises its resolution for some impacts tells what each takes.
        """
        return Errors()

    def cautions(
        self, scene: Scene, normal: NormalMotion, tangential: TangentialLaw
    ) -> tuple[str, ...]:
        """Return one sentence for each doubt about the resolution of these impacts."""
        return ()

    @abstractmethod
    def integrate(
        self,
        scene: Scene,
        normal: NormalMotion,
        tangential: TangentialLaw,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the tangential motion from first touch to separation.

        Parameters
        ----------
        observer : callable, optional
            Called with a ``Sample`` at increasing times.
        """


class CoupledIntegrator(Integrator, way="marcher"):
    """Base of integrators that also march a normal and a causal tangential law at once."""

    @abstractmethod
    def integrate_coupled(
        self,
        scene: Scene,
        normal: NormalMotion,
        tangential: TangentialLaw,
        observer: Observer | None = None,
    ) -> TangentialMotion:
        """Return the motion of impacts in which friction changes the approach.

        Parameters
        ----------
        normal : NormalMotion
            The approach without friction: its law is marched, its duration counts the steps.
        tangential : CausalTangentialLaw
        scene : Scene
            One impact or a batch, with its inverse mass.
        observer : callable, optional
        """


def resolution_for(
    integrator: Integrator, scene: Scene, normal: NormalMotion, tangential: TangentialLaw
) -> Real:
    """Return the resolution of each impact, from the declared errors or the option; 0 without one.

    Parameters
    ----------
    integrator : Integrator
    scene : Scene
    normal : NormalMotion
    tangential : TangentialLaw
    """
    if not integrator.resolution:
        return 0.0
    taken = integrator.errors(scene, normal, tangential).resolution
    return np.where(np.isnan(taken), float(resolution_of(integrator)), taken)


def accuracy_of(integrator: Law) -> float | None:
    """Return the controlled error of psi2 over max(1, abs(psi1)); None without control.

    Parameters
    ----------
    integrator : Integrator
    """
    return float(resolution_of(integrator)) if "controls_error" in claims(integrator) else None
