"""A piece of profile laid down by the growing edge of a contact that sticks."""

from __future__ import annotations

from typing import NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import Path, ScaledContact
from contactlab_fronts.profile import Front, Piece

Array = NDArray[np.float64]

FRONT_CAP = 12
HALVING_CAP = 60
#: Newton's method dances on rounding error near an end; moving more than this it is lost.
LOST_PART = 1e-4
#: Squared length of a Newton move that needs no second look; at 1e-7 psi2 would lose 1e-8.
FRONT_MOVE = 1e-12
#: A root's slope below this part of its mean is rounding error at the very end of the piece.
STEEP_PART = 0.1
TINY = 1e-300


class _Edge(NamedTuple):
    """One end of the piece: slip and approach when the edge of contact was there."""

    slip: float
    approach: float


@attrs.frozen(eq=False)
class Laid(Piece):
    """Laid down while x went from start to stop: f(q) = -D at the moment when zeta was q.

    ``began`` is the sign of slip that had stopped at ``start``, ``ended`` that of the slip
    which began at ``stop``; 0 for none.
    """

    path: Path
    start: float
    stop: float
    began: int
    ended: int
    inner: _Edge
    outer: _Edge
    inner_q: float
    inner_f: float

    @classmethod
    def along(cls, path: Path, start: float, stop: float, began: int, ended: int) -> Laid:
        """Return the piece laid down along ``path``."""
        ends = path.fields(np.array([start, stop])).T.tolist()
        inner, outer = (_Edge(end[0], end[2]) for end in ends)
        inner_q = inner.approach if start > 0.0 else 0.0
        return cls(path, start, stop, began, ended, inner, outer, inner_q, -inner.slip)

    def front(
        self, sign: int, contact: ScaledContact, slip: Array, memo: tuple[Array, ...]
    ) -> Front:
        """Find, by Newton's method, the x at which the edge was where the front is now."""
        level = sign * slip
        level -= contact.approach
        low = sign * self.outer.slip - self.outer.approach
        high = sign * self.inner.slip - self.inner.approach
        start, stop = self.start, self.stop
        length = stop - start
        drop = max(high - low, TINY)
        turning, flat = sign == self.ended, self.flat(sign)
        # Where the level has a double root at an end, its square root from there is solved for.
        steep = STEEP_PART * drop**0.5 / length
        if turning:
            below = np.sqrt(np.maximum(level - low, 0.0))
        if flat:
            above = np.sqrt(np.maximum(high - level, 0.0))
        if memo:
            y = memo[0]
        elif turning and flat:
            upper = above / (above + below + TINY)
            y = stop - length * (1.0 - upper)
        elif turning:
            y = stop - (length / drop**0.5) * below
        elif flat:
            y = start + (length / drop**0.5) * above
        else:
            y = start + length * ((high - level) / drop)
        floor = start + 1e-6 * length if flat else start - 0.2 * length
        y = np.minimum(np.maximum(y, floor), stop)
        for _ in range(FRONT_CAP):
            old_slip, old_force, q, c, slip_rate, q_rate = self.path.fields(y)
            here = sign * old_slip - q
            fall = sign * slip_rate - q_rate
            if turning:
                root = np.sqrt(np.maximum(here - low, 0.0))
                move = (below - root) * (root + root) / np.minimum(fall, -steep * root - TINY)
            if flat:
                root = np.sqrt(np.maximum(high - here, 0.0))
                other = (root - above) * (root + root) / np.minimum(fall, -steep * root - TINY)
                move = np.where(above < below, other, move) if turning else other
            elif not turning:
                move = (level - here) / (fall - TINY)
            new = y + move
            np.maximum(new, floor, out=new)
            np.minimum(new, stop, out=new)
            move = new - y
            y = new
            if move.dot(move) < FRONT_MOVE:
                break
        else:
            lost = np.abs(move) > LOST_PART * length
            if lost.any():
                y = np.where(lost, self._halving(sign, level, floor), y)
                old_slip, old_force, q, c, slip_rate, q_rate = self.path.fields(y)
                move = np.where(lost, 0.0, move)
        gap = contact.radius - c
        force = slip - old_slip
        force *= 1.5 * c
        force += old_force
        force += (0.5 * sign) * gap * gap * (contact.radius + contact.radius + c)
        return Front(c, force, (y, old_slip + slip_rate * move))

    def _halving(self, sign: int, level: Array, floor: float) -> Array:
        """Find the same x by halving, between Newton steps: slower, and always right.

        Needed where the edge almost began to slip as the piece was laid down: the level is
        nearly stationary there, and Newton's method leaps.
        """
        low, high = np.full_like(level, floor), np.full_like(level, self.stop)
        y = 0.5 * (low + high)
        for _ in range(HALVING_CAP):
            slip, _, q, _, slip_rate, q_rate = self.path.fields(y)
            ahead = sign * slip - q - level
            low, high = np.where(ahead > 0.0, y, low), np.where(ahead > 0.0, high, y)
            new = y - ahead / (sign * slip_rate - q_rate - TINY)
            new = np.where((new > low) & (new < high), new, 0.5 * (low + high))
            move, y = new - y, new
            if move.dot(move) < FRONT_MOVE**2:
                break
        return y

    def depth(
        self, sign: int, contact: ScaledContact, slip: Array, memo: tuple[Array, ...]
    ) -> Array:
        """Return s (D - D when the front was the edge), which is zeta - q there."""
        return np.asarray(sign * (slip - memo[1]))

    def swept(self, sign: int) -> bool:
        """Springs laid down one by one slip one by one."""
        return False

    def flat(self, sign: int) -> bool:
        """Name the centre, and a piece that began when slip of this sign stopped."""
        return self.inner_q == 0.0 or sign == self.began

    def span(self, sign: int) -> float | None:
        """Take a front from the outer end to go in about as fast as the edge came out."""
        return self.stop - self.start if sign == self.ended else None
