"""The contract of normal laws: force, contact radius and friction load from the approach."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Any

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law, claims
from contactlab.contracts.motion import ClosedFormMotion, NormalMotion
from contactlab.impact.cautions import large_contact, name_bodies, size_of_contact, yielding
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real


class NormalLaw(Law, kind="normal"):
    """Base of normal laws, which return the normal force of a contact.

    Contract
    --------
    1. ``respond`` is pure: it returns a new state, so that a step may be rejected. With the same
       approach again it leaves the state unchanged: in a batch some impacts stand still.
    2. Approach and rate are floats for one impact, or arrays of the batch shape; one code path
       should serve both. If an argument is NaN, the answer is NaN, never "no contact".
    3. The normal motion is integrated from ``respond``, before any friction; a
       ``ClosedFormNormalLaw`` returns its motion itself.

    Parameters of methods
    ---------------------
    scene : Scene
        One impact or a batch.
    motion : NormalMotion
        A motion under this law of all impacts; friction may have changed it.
    """

    @abstractmethod
    def start(self, scene: Scene) -> object:
        """Return the state before first touch; None for a law without memory."""

    @abstractmethod
    def respond(self, state: Any, approach: Real, rate: Real) -> tuple[NormalContact, Any]:
        """Return the contact at ``approach`` (m) and ``rate`` (m/s), and the new state.

        Parameters
        ----------
        state : object
            The state that ``start`` or the last call returned.
        approach, rate : float or array, shape (...,)
            Approach in m, 0 at first touch, and its rate in m/s; positive in compression.
        """

    def dissipation(self, motion: NormalMotion) -> Real:
        """Return the energy in J that the law takes from a motion, which friction may have changed.

        NaN, the default, means not declared. An elastic law returns 0.
        """
        return math.nan

    def cautions(self, scene: Scene, motion: NormalMotion) -> tuple[str, ...]:
        """Return one sentence for each doubt about the model; asked when a plan is read."""
        if not name_bodies(scene):
            return ()
        cautions = () if "plastic" in claims(self) else yielding(scene)
        return (*cautions, *large_contact(size_of_contact(scene, motion.maximum_radius)))


class ClosedFormNormalLaw(NormalLaw, way="closed"):
    """Base of normal laws that return their motion in closed form, without integration."""

    @abstractmethod
    def motion(self, scene: Scene) -> ClosedFormMotion:
        """Return the motion from first touch to separation, of this very ``scene``."""


class UnfollowedNormalLaw(NormalLaw, way="unfollowed"):
    """Base of normal laws with motions that no step can follow, as for clay.

    The friction load of such a motion does not pull. Tangential laws may answer it as a whole;
    impacts that would be marched are refused.
    """

    @abstractmethod
    def unfollowed_rate(self, scene: Scene) -> Real | None:
        """Return the rate of approach at separation, in m/s, of motions that no step can follow.

        NaN marks an impact that steps can follow; None says that they can follow all.
        """


def unfollowed_rate(law: Law, scene: Scene) -> Real | None:
    """Return the rate at separation of motions that no step can follow; None if each can.

    Parameters
    ----------
    law : Law
    scene : Scene
        One impact or a batch.
    """
    return law.unfollowed_rate(scene) if isinstance(law, UnfollowedNormalLaw) else None
