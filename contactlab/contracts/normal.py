"""The contract of normal laws: force, contact radius and friction load from the approach."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Any, ClassVar

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import ClosedFormMotion, NormalMotion
from contactlab.impact.cautions import large_contact, named, size_of_contact, yielding
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real


class NormalLaw(Law):
    """Base of normal laws, which return the normal force of a contact.

    Contract
    --------
    1. ``start(scene)`` returns the state before first touch: any value, ``None`` for a law
       without memory.
    2. ``respond(state, approach, rate)`` returns ``(NormalContact, state)``. The method is pure:
       it returns a new state and does not change its argument, so that a step may be tried and
       rejected. Repeating a call with the same approach leaves the state unchanged: in a batch
       some impacts move while others stand still.
    3. ``approach`` (m) grows in compression and is zero at first touch; ``rate`` (m/s) is its
       time derivative, positive in compression. Both are floats for one impact, or arrays
       of the batch shape; one code path should serve both.
    4. If an argument is NaN, the answer is NaN, never "no contact".
    5. The normal motion is integrated from ``respond``, before any friction, to the tolerance
       ``contactlab.compose.motion_solver.TOLERANCE``. A ``ClosedFormNormalLaw`` returns its
       motion itself, and has the word ``closed_form``.
    6. ``cautions`` returns doubts about the model when a plan is read, as those of a
       ``TangentialLaw``. ``plastic`` is True for a law whose bodies
       yield; such a law has no caution about yield.
    7. ``dissipation`` is the energy that the law takes from a motion. It is asked of a motion that
       friction has changed, whose loss of kinetic energy is not the law's alone.
    8. ``viscous`` is True for a law whose force is Hertz's plus a viscous one over Hertz's radius
       b² = R z: P = b³ in Hertz's units where the rate is 0, and more while the bodies approach.
       Tangential laws may then share its loss: the relaxation time of the contact follows from
       force, radius, approach and rate. Such a law has no memory.
    9. ``similar`` is True if motions of all impacts are one in units of Hertz's impact, as those of
       a law that is given by its restitution: then one of a batch is integrated.

    Parameters of methods
    ---------------------
    scene : Scene
        One impact or a batch.
    motion : NormalMotion
        A motion under this law of all impacts; friction may have changed it.
    """

    kind: ClassVar[str] = "normal"
    plastic: ClassVar[bool] = False
    closed_form: ClassVar[bool] = False

    @abstractmethod
    def start(self, scene: Scene) -> Any:
        """Return the state before first touch."""

    @abstractmethod
    def respond(self, state: Any, approach: Real, rate: Real) -> tuple[NormalContact, Any]:
        """Return the contact at ``approach`` (m) and ``rate`` (m/s), and the new state.

        Parameters
        ----------
        state : object
            The state that ``start`` or the last call returned.
        approach : float or array, shape (...,)
            Approach in m, positive in compression.
        rate : float or array, shape (...,)
            Time derivative of the approach in m/s, positive in compression.
        """

    @property
    def viscous(self) -> bool:
        """True if Hertz's force and a viscous one act over Hertz's radius (clause 8)."""
        return False

    @property
    def similar(self) -> bool:
        """True if all motions are one in units of Hertz's impact (clause 9)."""
        return False

    def dissipation(self, motion: NormalMotion) -> Real:
        """Return the energy in J that the law dissipates along a motion, of the batch shape.

        NaN, the default, means not declared. An elastic law returns 0.
        """
        return math.nan

    def cautions(self, scene: Scene, motion: NormalMotion) -> tuple[str, ...]:
        """Return one sentence for each doubt about the model."""
        if not named(scene):
            return ()
        cautions = () if self.plastic else yielding(scene)
        return (*cautions, *large_contact(size_of_contact(scene, motion.maximum_radius)))


class ClosedFormNormalLaw(NormalLaw):
    """Base of normal laws that return their motion in closed form, without integration."""

    closed_form: ClassVar[bool] = True

    @abstractmethod
    def motion(self, scene: Scene) -> ClosedFormMotion:
        """Return the motion from first touch to separation.

        Returns
        -------
        ClosedFormMotion
            Its ``scene`` is this very object; with another, the impact has a status LAW_RAISED.
        """
