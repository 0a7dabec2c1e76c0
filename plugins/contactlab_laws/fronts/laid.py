"""A piece of profile laid down by the growing edge of a contact that sticks."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np

from contactlab.contracts import DenseOutput, ScaledContact
from contactlab.numeric.checks import Real
from contactlab.numeric.lobatto import Array
from contactlab_laws.fronts.profile import Front, Memo, ProfilePiece

#: Moves of Newton's method: from the first guess of a front, and of many impacts later on, when
#: their panels iterate by themselves. The front of one impact is found within its panel's move.
FIRST_MOVES, LATER_MOVES = 6, 1
MOST_MOVES = 60
#: Moves before a front is kept between bounds: where the edge almost slipped the level is nearly
#: stationary, and Newton's method leaps.
FREE_MOVES = 3
#: Squared length of moves, in parts of the piece, that need no further look: what is left of the
#: front is their square, and of the force the square of that.
SMALL_MOVE = 1e-12
#: A front may leave its piece a little while a panel reaches beyond it, in parts of the piece.
LEEWAY, LEAST_PART = 0.2, 1e-6
#: A slope of the angle below this part of its mean may be rounding error at the very end of the
#: piece. It is small too where the level is stationary just beyond an end: a front as near to that
#: as this, in parts of the piece, is not found closer, and the force is off by the cube.
STEEP_PART = 1e-4
TINY = 1e-300


@attrs.frozen(eq=False)
class Laid(ProfilePiece):
    """Laid down while x went from start to stop: f(q) = -D at the moment when zeta was q.

    ``began`` is the sign of slip that had stopped at ``start``, ``ended`` that of the slip
    which began at ``stop``; 0 for none.
    """

    output: DenseOutput
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
    def along(cls, output: DenseOutput, start: Real, stop: Real, began: Real, ended: Real) -> Laid:
        """Return the piece laid down along a panel of sticking.

        Parameters
        ----------
        output : DenseOutput
            Of the panel.
        start, stop : float or ndarray
            In x.
        began, ended : float or ndarray
            As in the class.
        """
        slip, _, q, *_ = output.fields(np.array([start, stop]))
        # at the centre rounding leaves a little of q
        ends: Any = np.array([q[0] * (start != 0.0), -slip[0], q[1], -slip[1]])
        return cls(output, start, stop, began, ended, *(ends if ends.ndim > 1 else ends.tolist()))

    def front(self, sign: Any, contact: ScaledContact, slip: Array, memo: Memo) -> Front:
        """Return the front, by Newton's method for the phase y at which the edge was there.

        There s D - zeta had its present value, the level. It falls with y, and is stationary at an
        end where slip of this sign stopped or begins. The angle of which it is the cosine, 0 at
        the highest level and pi at the lowest, is linear in y at such ends; ends that are not
        stationary are put inside this range.
        """
        level = sign * slip
        level -= contact.approach
        start, stop = self.start, self.stop
        length = stop - start
        high = -(sign * self.inner_f + self.inner_q)
        low = -(sign * self.outer_f + self.outer_q)
        drop = abs(high - low) + TINY
        outer, inner = sign == self.ended, self.singular_inner_end(sign)  # stationary or not
        mean = 0.5 * (high + low + drop * (1.0 * outer - inner))
        parts = 3.0 - outer - inner
        half = 0.5 * drop * parts
        lowest = start + (LEAST_PART * inner - LEEWAY * (1.0 - inner)) * length
        level -= mean
        level /= half
        target = np.arccos(_within(level, -1.0, 1.0))
        if memo:
            y = memo[1]
        else:
            first = np.arccos(1.0 - 2.0 * (1.0 - inner) / parts)
            last = np.arccos(2.0 * (1.0 - outer) / parts - 1.0)
            y = _within(start + (target - first) * (length / (last - first)), lowest, stop)
        many = slip.ndim > 1
        moves = (LATER_MOVES if memo else FIRST_MOVES) if many else MOST_MOVES
        least, most = lowest, stop
        for count in range(moves):
            old_slip, old_force, q, c, slip_rate, q_rate = self.output.fields(y)
            here = sign * old_slip
            here -= q
            here -= mean
            here /= half
            _within(here, -1.0, 1.0)
            slope = sign * slip_rate
            slope -= q_rate
            slope /= half * np.sqrt((1.0 - here) * (1.0 + here)) + TINY
            move = np.arccos(here)
            move -= target
            move /= np.minimum(slope, -STEEP_PART / length)
            move += y
            new = _within(move, lowest, stop)
            if count >= FREE_MOVES:
                ahead = here > level
                least, most = np.where(ahead, y, least), np.where(ahead, most, y)
                outside = ((new <= least) | (new >= most)) & (new != y)
                new = np.where(outside, 0.5 * (least + most), new)
            move, y = new - y, new
            if not many and move.dot(move) < SMALL_MOVE * length * length:
                break
        gap = contact.radius - c
        force = slip - old_slip
        force *= 1.5 * c
        force += old_force
        force += (0.5 * sign) * gap * gap * (contact.radius + contact.radius + c)
        # s (D - D when the front was the edge) is zeta - q there
        depth = sign * (slip - (old_slip + slip_rate * move))
        return Front(c, force, (depth, y))

    def singular_inner_end(self, sign: Any) -> Any:
        """Return whether it is the centre, or the piece began when slip of this sign stopped."""
        return (self.inner_q == 0.0) | (sign == self.began)

    def length_guess(self, sign: int) -> float | None:
        """Return the length of the piece: a front goes in about as fast as the edge came out."""
        return float(self.stop - self.start) if sign == self.ended else None


def _within(values: Array, least: Any, most: Any) -> Array:
    """Return ``values``, changed in place, between two bounds."""
    np.maximum(values, least, out=values)
    return np.asarray(np.minimum(values, most, out=values))
