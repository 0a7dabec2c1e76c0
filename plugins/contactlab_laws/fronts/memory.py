"""The memory of a bundle of springs: pieces of the curve that sticking draws (theory §5).

In the frame of the sign s in which the edge slips, or would,

    m = s D - zeta            how far the surface has gone, less the growth of the limit
    J = (2/3) (P - s F)       what the force lacks of Coulomb's limit

and while the front of slip is at the radius c, m and J are what they were when the edge was at c.
Memory is the curve (m, J, c), on which dJ = -c dm. In the frame of the other sign it is
(-m - 2c², (4/3) c³ - J, c).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts import ScaledContact
from contactlab.numeric.lobatto import Array, Nodes, basis

#: Moves of Newton's method before a front is kept between bounds, and at most: where the curve is
#: nearly stationary the method leaps.
FREE_MOVES, MOST_MOVES = 3, 60
#: Squared length of moves, in parts of the piece, that need no further look: what they leave is
#: their cube.
SMALL_MOVES = 1e-14
TINY = 1e-300


class Front(NamedTuple):
    """The front at several instants: J, radius, zeta - c², and where it is on the piece."""

    lack: Array
    radius: Array
    depth: Array
    place: Array


class Piece(ABC):
    """A piece of the curve between two places, ``inner`` and ``outer``, seen by slip of one sign.

    ``locked`` is the sign of the slip out of which the piece locked, 0 if it was drawn while all
    stuck; in the frame of that sign a locked piece is a single point of the curve.
    """

    frame: int
    locked: int
    inner: float
    outer: float
    #: m at both ends, and J at the outer one
    highest: float
    lowest: float
    lack: float
    radius: float

    @abstractmethod
    def curve(self, place: Array) -> tuple[Array, Array, Array, Array]:
        """Return m, J, the slope of m, and c at each place."""

    @abstractmethod
    def front(self, contact: ScaledContact, gone: Array, place: Array) -> Front:
        """Return the front where m is ``gone``, from a first guess of its place."""

    def front_at(self, contact: ScaledContact, gone: float, place: float) -> list[float]:
        """Return the front at one instant."""
        here = ScaledContact(*(np.array([value]) for value in contact))
        front = self.front(here, np.array([gone]), np.array([place]))
        return [part.item() for part in front]

    def cut(self, place: float) -> None:
        """Let the piece end at ``place``: all beyond it has slipped."""
        self.outer = place
        gone, lack, _, radius = self.curve(np.array([self.inner, place]))
        self.highest, self.lowest = gone.tolist()
        self.lack, self.radius = lack[1].item(), radius[1].item()


class Locked(Piece):
    """The zone that locks out of slip, all of one m and J; of the other sign it is a parabola.

    Places are radii.
    """

    def __init__(self, sign: int, gone: float, lack: float, inner: float, outer: float) -> None:
        self.frame, self.locked = -sign, sign
        self.gone, self.base, self.inner = -gone, -lack, inner
        self.cut(outer)

    def curve(self, place: Array) -> tuple[Array, Array, Array, Array]:
        """Return m = -2c² and J = (4/3) c³ from where they were."""
        square = place * place
        lack = self.base + (4.0 / 3.0) * square * place
        return self.gone - 2.0 * square, lack, -4.0 * place, place

    def front(self, contact: ScaledContact, gone: Array, place: Array) -> Front:
        """Return the front in closed form."""
        level = np.minimum(gone, self.highest)
        square = 0.5 * np.maximum(self.gone - level, 0.0)
        c = np.sqrt(square)
        old, lack, _, _ = self.curve(c)
        return Front(lack - c * (gone - old), c, contact.approach - square, c)


class Drawn(Piece):
    """Drawn along a panel of sticking, by polynomials; places are phases x of the edge.

    ``table`` holds m, J, the slope of m, and c at the nodes.
    """

    locked = 0

    def __init__(
        self,
        frame: int,
        span: tuple[float, float],
        nodes: Nodes,
        table: tuple[Array, Array, Array, Array],
        limit_rate: Array,
    ) -> None:
        self.frame, self.nodes, self.limit_rate = frame, nodes, limit_rate
        self.origin, self.length = span
        self.inner = self.origin
        slopes = (nodes.derivative @ np.array(table[2:]).T).T / self.length
        self.table = np.array([*table, *slopes, nodes.ones])

    def flipped(self) -> Drawn:
        """Return the piece in the frame of the other sign."""
        gone, lack, slope, c = self.table[:4]
        square = c * c
        lack = (4.0 / 3.0) * square * c - lack
        table = (-gone - 2.0 * square, lack, -slope - 2.0 * self.limit_rate, c)
        span = (self.origin, self.length)
        other = Drawn(-self.frame, span, self.nodes, table, self.limit_rate)
        other.cut(self.outer)
        return other

    def _rows(self, place: Array) -> Array:
        weights = basis(self.nodes, (place - self.origin) / self.length)
        values = self.table.dot(weights)
        values /= values[6]
        return np.asarray(values)

    def curve(self, place: Array) -> tuple[Array, Array, Array, Array]:
        """Return the interpolated curve."""
        gone, lack, slope, c, *_ = self._rows(place)
        return gone, lack, slope, c

    def front(self, contact: ScaledContact, gone: Array, place: Array) -> Front:
        """Return the front by moves to the root of a parabola, which knows stationary ends."""
        inner, outer = self.inner, self.outer
        level = np.minimum(np.maximum(gone, self.lowest), self.highest)
        place = np.minimum(np.maximum(place, inner), outer)
        small = SMALL_MOVES * (outer - inner) ** 2
        least: Any = inner
        most: Any = outer
        for count in range(MOST_MOVES):
            old, lack, slope, c, bend, c_slope, _ = self._rows(place)
            excess = old - level
            root = np.sqrt(np.maximum(slope * slope - 2.0 * bend * excess, 0.0))
            new = place - 2.0 * excess / (slope - root - TINY)
            if count < FREE_MOVES:
                new = np.minimum(np.maximum(new, inner), outer)
            else:
                ahead = excess > 0.0
                least, most = np.where(ahead, place, least), np.where(ahead, most, place)
                outside = ((new <= least) | (new >= most)) & (new != place)
                new = np.where(outside, 0.5 * (least + most), new)
            move, place = new - place, new
            if move.dot(move) <= small:
                break
        # J is carried on from the curve to the present m. J is stationary in c: a front that is off
        # by little carries on to the same J.
        carried = lack - c * (gone - old)
        carried += (0.5 * c_slope) * (move * excess)
        radius = c + c_slope * move
        depth = contact.approach - radius * radius
        return Front(carried, radius, depth, place)
