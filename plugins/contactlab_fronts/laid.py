"""A piece of profile laid down by the growing edge of a contact that sticks."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.checks import Real
from contactlab.contracts import Path, ScaledContact
from contactlab_fronts.profile import Front, Memo, Piece

Array = NDArray[np.float64]

#: Moves of Newton's method from the first guess of a front, kept between bounds: where the edge
#: almost slipped the level is nearly stationary. Of many impacts each later call takes one move:
#: their panels iterate by themselves. Of one impact it is exact: its panel takes Newton's method.
FIRST_MOVES, LATER_MOVES = 6, 1
EXACT_MOVES = 60
#: Squared length of moves that need no further look; at 1e-7 psi2 would lose 1e-8.
EXACT_MOVE = 1e-12
#: A front may leave its piece a little while a panel reaches beyond it, in parts of the piece.
LEEWAY, LEAST_PART = 0.2, 1e-6
#: A root's slope below this part of its mean is rounding error at the very end of the piece.
STEEP_PART = 0.1
#: Part of a piece, in the guess of a front, by which an end is pushed out of the way.
ONE_STEEP, BOTH_STEEP = 0.5, 1.0 / (1.0 + 2.0**0.5)
TINY = 1e-300


@attrs.frozen(eq=False)
class Laid(Piece):
    """Laid down while x went from start to stop: f(q) = -D at the moment when zeta was q.

    ``began`` is the sign of slip that had stopped at ``start``, ``ended`` that of the slip
    which began at ``stop``; 0 for none.
    """

    path: Path
    start: Real
    stop: Real
    began: Real
    ended: Real
    inner_q: Real
    inner_f: Real
    outer_q: Real
    outer_f: Real

    sign = 0.0

    @classmethod
    def along(cls, path: Path, start: float, stop: float, began: int, ended: int) -> Laid:
        """Return the piece laid down along ``path``."""
        slip, _, q = path.fields(np.array([start, stop]))[:3].tolist()
        centre = start == 0.0  # where rounding leaves a little of q
        inner_q = 0.0 if centre else q[0]
        return cls(path, start, stop, began, ended, inner_q, -slip[0], q[1], -slip[1])

    def front(self, sign: Any, contact: ScaledContact, slip: Array, memo: Memo) -> Front:
        """Find, by Newton's method, the phase y at which the edge was where the front is now.

        There s D - zeta had its present value, the level. At an end where slip of this sign
        stopped or begins that is flat in y, so that moves are made in the square root of its
        distance from the nearer end; a steep end is pushed out of the way.
        """
        level = sign * slip
        level -= contact.approach
        start, stop = self.start, self.stop
        length = stop - start
        high = -(sign * self.inner_f + self.inner_q)
        low = -(sign * self.outer_f + self.outer_q)
        drop = np.maximum(high - low, TINY)
        turning, flat = sign == self.ended, self.flat(sign)
        low, high = np.where(turning, low, low - drop), np.where(flat, high, high + drop)
        lowest = start + np.where(flat, LEAST_PART, -LEEWAY) * length
        below, above = _root(level - low), _root(high - level)
        inside, steep = above < below, -STEEP_PART * drop**0.5 / length
        if memo:
            y = np.minimum(np.maximum(memo[1], lowest), stop)
        else:
            first = np.where(flat, 0.0, np.where(turning, ONE_STEEP, BOTH_STEEP))
            last = np.where(turning, 1.0, 1.0 - np.where(flat, ONE_STEEP, BOTH_STEEP))
            part = (above / (above + below + TINY) - first) / (last - first)
            y = np.minimum(np.maximum(start + length * part, lowest), stop)
        inner, outer = lowest, stop
        many = slip.ndim > 1
        if many:
            moves = LATER_MOVES if memo else FIRST_MOVES
        for _ in range(moves if many else EXACT_MOVES):
            old_slip, old_force, q, c, slip_rate, q_rate = self.path.fields(y)
            here = sign * old_slip
            here -= q
            fall = sign * slip_rate - q_rate
            under, over = _root(here - low), _root(high - here)
            root = np.where(inside, over, under)
            move = np.where(inside, over - above, below - under)
            move *= 2.0 * root
            move /= np.minimum(fall, steep * root - TINY)
            new = y + move
            if not (many and memo):  # the level falls with y: stay between what was seen so far
                ahead = here > level
                inner, outer = np.where(ahead, y, inner), np.where(ahead, outer, y)
                outside = (new < inner) | (new > outer)
                new = np.where(outside, 0.5 * (inner + outer), new)
            np.minimum(np.maximum(new, lowest, out=new), stop, out=new)
            move, y = new - y, new
            if not many and move.dot(move) < EXACT_MOVE:
                break
        gap = contact.radius - c
        force = slip - old_slip
        force *= 1.5 * c
        force += old_force
        force += (0.5 * sign) * gap * gap * (contact.radius + contact.radius + c)
        # s (D - D when the front was the edge) is zeta - q there
        depth = sign * (slip - (old_slip + slip_rate * move))
        return Front(c, force, (depth, y))

    def flat(self, sign: Any) -> Any:
        """Name the centre, and a piece that began when slip of this sign stopped."""
        return (self.inner_q == 0.0) | (sign == self.began)

    def span(self, sign: int) -> float | None:
        """Take a front from the outer end to go in about as fast as the edge came out."""
        return float(self.stop - self.start) if sign == self.ended else None


def _root(value: Array) -> Array:
    """Return the square root, 0 of what is negative."""
    np.maximum(value, 0.0, out=value)
    return np.asarray(np.sqrt(value, out=value))
