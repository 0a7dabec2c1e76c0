"""The state of many impacts, and the phase after each event: theory §5.

The phases and their formulas are those of one impact: ``contactlab_laws.fronts.phases``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import ClosedFormMotion
from contactlab.numeric.lobatto import Array, Nodes
from contactlab_laws.fronts.gross import Slide
from contactlab_laws.fronts.many.pieces import NO_PIECE, PieceTable, Rows
from contactlab_laws.fronts.profile import Locked

STUCK, EDGE_SLIP, GROSS_SLIP, DONE = range(4)


class Impacts:
    """Impacts of scaled velocity > 0 that do not slip throughout; one element each.

    Parameters
    ----------
    velocity, inertia : ndarray, shape (impacts,)
        In the units of ``contactlab.contracts.phases``.
    motion : ClosedFormMotion
    nodes : Nodes
        Of panels in which all sticks.
    """

    def __init__(
        self, velocity: Array, inertia: Array, motion: ClosedFormMotion, nodes: Nodes
    ) -> None:
        count = velocity.size
        self.first, self.inertia, self.motion = velocity, inertia, motion
        # x, D, the change of psi since first touch, F/(mu P_max), friction work
        self.phase, self.slip, self.change, self.force, self.work = np.zeros((5, count))
        self.panels = np.zeros(count, dtype=np.intp)
        self.regime = np.where(velocity > 1.0, GROSS_SLIP, STUCK)
        self.sign = np.ones(count)  # of the slip, if any
        self.began = np.zeros(count)  # sign of the slip that stopped as sticking began, or 0
        self.outermost = np.full(count, NO_PIECE, dtype=np.intp)
        self.pieces = PieceTable(nodes, 2 * count + 64)
        # how the next panel is to be taken
        self.fitted = np.zeros(count, dtype=bool)  # up to the event at the end of the piece
        self.longest = np.full(count, np.inf)  # no longer than this
        self.estimated_length = np.full(count, np.inf)  # asked for by the last error estimate
        self.attempts = np.zeros(count, dtype=np.intp)  # refused in a row

    def velocity(self, who: Rows) -> Array:
        """Return psi."""
        return self.first[who] + self.change[who]

    def laid(self, who: Rows) -> NDArray[np.bool_]:
        """Return whether the outermost piece was laid down while all stuck."""
        return np.asarray(self.pieces["sign"][self.outermost[who]] == 0.0)

    def slide_through(self, who: Rows) -> None:
        """Take gross slip, in closed form, until it sticks again or the impact ends."""
        sign, first = self.sign[who], self.motion.scaled(self.phase[who])
        slide = Slide.along(self.motion, self.inertia[who], sign, first, self.velocity(who))
        self.change[who] += slide.gained
        self.work[who] += slide.work
        self.regime[who] = DONE
        again = who[slide.stops]
        self.phase[again] = slide.end[slide.stops]
        self.force[again] = sign[slide.stops] * self.motion.scaled(self.phase[again]).force
        self.outermost[again] = NO_PIECE
        self.lock(again, np.zeros(again.size))

    def lock(self, who: Rows, front: Array) -> None:
        """Stick again: the slip zone outside ``front`` (q) becomes a locked piece."""
        now, sign = self.motion.scaled(self.phase[who]), self.sign[who]
        front = np.minimum(front, now.approach)
        locked = Locked.between(front, sign, now, self.slip[who], self.force[who])
        self.outermost[who] = self.pieces.add(self.outermost[who], locked)
        loading = now.rate > 0.0
        grows, shrinks = who[loading], who[~loading]
        self.regime[grows] = STUCK
        self.began[grows] = self.sign[grows]
        self.sign[shrinks] *= -1.0  # the shrinking edge slips back at once
        self.regime[shrinks] = EDGE_SLIP

    def slip_on(self, who: Rows) -> None:
        """Slip through the outermost piece: pieces locked by slip of this sign go at once."""
        self.regime[who] = EDGE_SLIP
        while who.size:
            outermost = self.outermost[who]
            bare = outermost == NO_PIECE
            self.regime[who[bare]] = GROSS_SLIP
            who, outermost = who[~bare], outermost[~bare]
            slips = self.pieces["sign"][outermost] == self.sign[who]
            who = who[slips]
            self.outermost[who] = self.pieces.inside[outermost[slips]]

    def leave_piece(self, who: Rows) -> None:
        """Take the front into the next piece."""
        self.outermost[who] = self.pieces.inside[self.outermost[who]]
        self.slip_on(who)

    def slip_back(self, who: Rows) -> None:
        """Let the edge slip the other way."""
        self.sign[who] *= -1.0
        self.slip_on(who)
