"""A solved panel of the motion: values at Lobatto nodes, and what is read between them."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import ClosedFormMotion, ScaledContact, Stretch
from contactlab.numeric.lobatto import Array, lobatto, rows

NODES = lobatto(32)
#: Rings in which stick and slip are shown; the solution itself knows no rings.
RINGS = 200
#: Moves of Newton's method from x to the coordinate of the nodes.
INVERSIONS = 4


class Panel(NamedTuple):
    """The motion at the nodes; margin, lack and gone are k, J and m of theory §5.

    Attributes
    ----------
    x : array, shape (nodes,)
    contact : ScaledContact
        The normal contact there.
    weights : array, shape (nodes, nodes)
        Integration over T from the panel's start to each node.
    margin, lack, gone : array, shape (nodes,)
    radius, depth, place : array, shape (nodes,)
        c, zeta - c², and the front's place on its piece.
    """

    x: Array
    contact: ScaledContact
    weights: Array
    margin: Array
    lack: Array
    gone: Array
    radius: Array
    depth: Array
    place: Array


@attrs.frozen(eq=False)
class FrontStretch(Stretch):
    """A stretch within whose ``front`` all sticks, and outside which all slips one way."""

    sign: int
    start: float
    stop: float
    change: float
    work: float
    solves: int

    @abstractmethod
    def front(self, contact: ScaledContact) -> float:
        """Return the radius of the front at one instant."""

    def fields(
        self, normal: ClosedFormMotion, contact: ScaledContact, factor: float
    ) -> Mapping[str, NDArray[Any]]:
        """Return rings of equal width: radius (m), stuck, and the sign of slipping traction.

        ``front`` (m) is the radius within which the contact sticks.
        """
        ring, largest = (np.arange(RINGS) + 0.5) / RINGS, float(normal.maximum_radius)
        front = self.front(contact)
        touching, inside = ring < contact.radius, ring < front
        shown = self.sign if factor > 0.0 else -self.sign
        return {
            "radius": largest * ring,
            "front": np.array(largest * front),
            "stuck": touching & inside,
            "slipping": np.where(touching & ~inside, shown, 0).astype(np.int8),
        }


@attrs.frozen(eq=False)
class PanelStretch(FrontStretch):
    """A stretch of stick or of slip at the edge, as its panel has it.

    ``columns`` holds x, change of velocity, force, and radius of the front at the nodes.
    """

    columns: Array

    def _at(self, x: Array) -> Array:
        """Return change of velocity, force and radius of the front at each x."""
        known = self.columns[0]
        tau, slope = np.interp(x, known, NODES.points), NODES.derivative @ known
        for _ in range(INVERSIONS):
            weights = rows(NODES, tau)
            tau = np.clip(tau - (weights @ known - x) / (weights @ slope), 0.0, 1.0)
        return np.asarray((rows(NODES, tau) @ self.columns[1:].T).T)

    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return (change of velocity since first touch, force)."""
        change, force, _ = self._at(contact.phase)
        return change, force

    def front(self, contact: ScaledContact) -> float:
        """Return the radius of the front at one instant."""
        return max(0.0, float(self._at(np.array([contact.phase]))[2, 0]))


@attrs.frozen(eq=False)
class GrossStretch(FrontStretch):
    """Gross slip: psi falls in proportion to V, under Coulomb's force.

    ``ratio`` is 2 chi, ``rate`` the V at the end.
    """

    rate: float
    ratio: float

    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return (change of velocity since first touch, force)."""
        left = (self.sign * self.ratio) * (contact.rate - self.rate)
        return self.change + left, self.sign * contact.force

    def front(self, contact: ScaledContact) -> float:
        """Return 0: the front is at the centre."""
        return 0.0
