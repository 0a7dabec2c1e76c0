"""The state of many impacts, and what follows each event: theory §5.

The phases are those of one impact: ``contactlab_fronts.phases``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab_fronts.many.hertz import contact, phase_of_rate
from contactlab_fronts.many.pieces import NO_PIECE, Pieces

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

STUCK, EDGE_SLIP, GROSS_SLIP, DONE, UNSOLVED = range(5)

#: Less than this of the normal velocity counts as maximum compression, which is a moment away.
LEAST_RATE = 1e-7


class Impacts:
    """Impacts with |psi1| < max(1, 4 chi - 1), psi1 > 0; scaled (theory §1), one element each.

    Parameters
    ----------
    psi1, chi : ndarray, shape (impacts,)
    terms : int
        See ``Pieces``.
    """

    def __init__(self, psi1: Array, chi: Array, terms: int) -> None:
        count = psi1.size
        self.psi1 = psi1
        self.chi = chi
        self.phase = np.zeros(count)
        self.slip = np.zeros(count)  # D
        self.change = np.zeros(count)  # psi - psi1
        self.force = np.zeros(count)
        self.doing = np.where(psi1 > 1.0, GROSS_SLIP, STUCK)
        self.sign = np.ones(count)  # of the slip, if any
        self.began = np.zeros(count)  # sign of the slip that stopped as sticking began, or 0
        self.outermost = np.full(count, NO_PIECE, dtype=np.intp)
        self.pieces = Pieces(terms, 2 * count + 64)
        # how the next panel is to be taken
        self.fitted = np.zeros(count, dtype=bool)  # up to the event at the end of the piece
        self.most = np.full(count, np.inf)  # no longer than this
        self.usual = np.full(count, np.inf)  # the length that the last error estimate asks for
        self.attempts = np.zeros(count, dtype=np.intp)  # refused in a row
        self.idle = np.zeros(count, dtype=np.intp)  # events in a row without progress

    def velocity(self, who: Rows) -> Array:
        """Return psi."""
        return self.psi1[who] + self.change[who]

    def slide_through(self, who: Rows) -> None:
        """Follow gross slip, in closed form, until it sticks again or the impact ends."""
        sign, ratio = self.sign[who], 2.0 * self.chi[who]
        rate = np.where(self.phase[who] == 0.0, 1.0, contact(self.phase[who]).rate)
        ahead = sign * self.velocity(who)
        # s psi = V, both linear in V; below ratio 1 slip only gains on it
        spread = np.where(ratio > 1.0, ratio - 1.0, 1.0)
        stop = np.minimum((ratio * rate - ahead) / spread, rate)
        sticks = (ratio > 1.0) & (stop > -1.0)
        stop = np.where(sticks, stop, -1.0)
        self.change[who] += sign * ratio * (stop - rate)
        self.doing[who] = DONE
        again = who[sticks]
        if again.size:
            phase = np.maximum(phase_of_rate(stop[sticks]), self.phase[again])
            self.phase[again] = phase
            self.force[again] = sign[sticks] * contact(phase).radius ** 3
            self.outermost[again] = NO_PIECE
            self.lock(again, np.zeros(again.size))

    def lock(self, who: Rows, front: Array) -> None:
        """Stick again: the slip zone outside ``front`` (q) becomes a locked piece."""
        if not who.size:
            return
        now = contact(self.phase[who])
        sign = self.sign[who]
        front = np.minimum(front, now.approach)
        self.outermost[who] = self.pieces.add(
            who.size,
            self.outermost[who],
            sign=sign,
            inner_q=front,
            inner_f=sign * (now.approach - front) - self.slip[who],
            base=self.force[who] - sign * now.approach * now.radius,
        )
        loading = now.rate > LEAST_RATE
        grows, shrinks = who[loading], who[~loading]
        self.doing[grows] = STUCK
        self.began[grows] = self.sign[grows]
        self.sign[shrinks] *= -1.0  # the shrinking edge slips back at once
        self.doing[shrinks] = EDGE_SLIP

    def slip_on(self, who: Rows) -> None:
        """Slip through the outermost piece: pieces locked by slip of this sign go at once."""
        self.doing[who] = EDGE_SLIP
        while who.size:
            outermost = self.outermost[who]
            bare = outermost == NO_PIECE
            self.doing[who[bare]] = GROSS_SLIP
            who, outermost = who[~bare], outermost[~bare]
            swept = self.pieces["sign"][outermost] == self.sign[who]
            who = who[swept]
            self.outermost[who] = self.pieces.inside[outermost[swept]]

    def leave_piece(self, who: Rows) -> None:
        """Take the front into the next piece."""
        self.outermost[who] = self.pieces.inside[self.outermost[who]]
        self.slip_on(who)

    def slip_back(self, who: Rows) -> None:
        """Let the edge slip the other way."""
        self.sign[who] *= -1.0
        self.slip_on(who)
