"""The contract of a normal law: force, contact radius and friction load from the approach."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any, ClassVar, NamedTuple

import numpy as np

from contactlab.contracts.law import Law
from contactlab.contracts.motion import ClosedFormMotion, NormalMotion
from contactlab.impact.scene import Scene
from contactlab.impact.yielding import yielding
from contactlab.numeric.checks import Real

#: Above this ratio of contact radius to R the picture of half-spaces is doubtful (theory §8).
DOUBTFUL_SIZE_RATIO = 0.1
#: Overlap in m of a contact that presses at first touch: only its sign means something.
TOUCH = 1e-300


class NormalContact(NamedTuple):
    """The normal contact at one instant; every entry broadcasts to the batch shape.

    Attributes
    ----------
    force : float or array
        P in N, positive in compression, negative where the surfaces pull; 0 out of contact.
    radius : float or array
        b in m, the contact radius; 0 out of contact, and 0 from a law that has none.
    overlap : float or array
        Positive in contact, zero or negative out of contact: its sign tells where the impact
        ends. Any measure in m.
    friction_load : float or array, optional
        The normal force in N that Coulomb's limit is taken of, never negative. A normal law
        may leave it out: it is max(P, 0) then. A tangential law always finds it.
    """

    force: Real
    radius: Real
    overlap: Real
    friction_load: Any = None

    @property
    def complete(self) -> NormalContact:
        """The same contact with its friction load."""
        if self.friction_load is not None:
            return self
        force: Any = self.force
        # A product with the comparison keeps NaN a NaN, for floats and arrays alike.
        return self._replace(friction_load=force * (force > 0.0) + 0.0 if np.ndim(force) else (
            0.0 if force <= 0.0 else force
        ))  # fmt: skip


def without_tension(force: Real, radius: Real, approach: Real) -> NormalContact:
    """Return the contact of a law that does not pull: it has ended where ``force`` is not positive.

    Force and radius are 0 there, and the overlap is negative. NaN stays NaN.

    Parameters
    ----------
    force : float or array, shape (...,)
        In N, positive in compression.
    radius : float or array, shape (...,)
        Of the contact, in m.
    approach : float or array, shape (...,)
        In m, positive in compression.
    """
    pushing = np.logical_not(force <= 0.0)
    return NormalContact(
        force=force * pushing,
        radius=radius * pushing,
        overlap=(np.abs(approach) + TOUCH) * (2.0 * pushing - 1.0),
    )


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
