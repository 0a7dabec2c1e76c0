"""The contract of a normal law: force, contact radius and friction load from the approach."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, ClassVar

import numpy as np

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import ClosedFormMotion, NormalMotion
from contactlab.impact.scene import Scene
from contactlab.impact.yielding import yielding
from contactlab.numeric.checks import Real

#: Above this ratio of contact radius to R the picture of half-spaces is doubtful (theory §8).
DOUBTFUL_SIZE_RATIO = 0.1


class NormalLaw(Law):
    """Normal force of a contact.

    Contract
    --------
    1. ``start(scene)`` returns the state before first touch: any value, ``None`` for a law
       without memory.
    2. ``respond(state, approach, rate)`` returns ``(NormalContact, state)``. It is pure:
       the state that goes in is not changed, a new one comes out, so that a step may be
       tried and thrown away. Asked again where it stands, a law leaves its state as it is: in a
       batch some impacts move while others stand still.
    3. ``approach`` (m) grows in compression and is zero at first touch; ``rate`` (m/s) is its
       time derivative, positive in compression. Both are floats for one impact, or arrays
       of the batch shape; arithmetic that serves both keeps one code path.
    4. NaN in gives NaN out, never "no contact".
    5. The motion from first touch to separation is made from ``respond``, before any friction,
       to ``contactlab.compose.normal_motion.TOLERANCE``; see ``ClosedFormNormalLaw`` for the
       exception.
    6. ``cautions`` says where the model itself is doubtful. ``plastic`` is True for a law whose
       bodies yield: it is not cautioned about yield.
    """

    kind: ClassVar[str] = "normal"
    plastic: ClassVar[bool] = False

    @abstractmethod
    def start(self, scene: Scene) -> Any:
        """Return the state before first touch.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        """

    @abstractmethod
    def respond(self, state: Any, approach: Real, rate: Real) -> tuple[NormalContact, Any]:
        """Return the contact at ``approach`` (m) and ``rate`` (m/s), and the new state.

        Parameters
        ----------
        state : object
            What ``start`` or the last call returned.
        approach : float or array, shape (...,)
            In m, positive in compression.
        rate : float or array, shape (...,)
            Its time derivative in m/s, positive inward.
        """

    def cautions(self, scene: Scene, motion: NormalMotion) -> tuple[str, ...]:
        """Return what to be wary of in the model, a sentence each.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        motion : NormalMotion
            Of all its impacts.
        """
        if scene.sphere is None:
            return ()
        found = () if self.plastic else yielding(scene)
        largest = float(np.max(motion.maximum_radius / scene.pair.radius))
        if not largest > DOUBTFUL_SIZE_RATIO:
            return found
        return (
            *found,
            f"C = {largest:.3g}, contact radius over R: the contact is not small against the "
            f"radius, the theory of half-spaces is doubtful above {DOUBTFUL_SIZE_RATIO}",
        )


class ClosedFormNormalLaw(NormalLaw):
    """A normal law whose motion is known in closed form: the integration is skipped."""

    @abstractmethod
    def motion(self, scene: Scene) -> ClosedFormMotion:
        """Return the motion from first touch to separation.

        Parameters
        ----------
        scene : Scene
            One impact or a batch.
        """
