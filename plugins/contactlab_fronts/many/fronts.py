"""The front of slip in the outermost pieces of many impacts.

The formulas are those of one impact, ``contactlab_fronts.locked`` and ``.laid``. A front is
called again and again while a panel converges, and moves a little at each call.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab_fronts.many.hertz import Contact
from contactlab_fronts.many.impacts import Impacts

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

#: Newton's steps from the first guess of a front, kept between bounds: where the edge almost
#: slipped the level is nearly flat. Later each call takes one step.
FIRST_MOVES = 6
#: A front may leave its piece a little while a panel reaches beyond it, in parts of the piece.
LEEWAY = 0.2
TINY = 1e-300


class LockedFront:
    """Slip of sign s through pieces locked out of slip of sign -s: 2 q = zeta - s D + constant."""

    def __init__(self, impacts: Impacts, who: Rows) -> None:
        rows, pieces = impacts.outermost[who], impacts.pieces
        self.sign = impacts.sign[who]
        self.base = pieces["base"][rows]
        self.offset = pieces["inner_q"][rows] - self.sign * pieces["inner_f"][rows]

    def __call__(self, now: Contact, slip: Array) -> tuple[Array, Array]:
        """Return (q of the front, force): F = I(c) + s (P - c³), I(c) = base - s c³."""
        q = now.approach - self.sign * slip
        q += self.offset
        q *= 0.5
        np.maximum(q, 0.0, out=q)
        force = now.approach * now.radius
        force -= 2.0 * q * np.sqrt(q)
        force *= self.sign
        force += self.base
        return q, force


class LaidFront:
    """Slip through pieces laid down in loading: where the edge was when w was put down.

    Newton's method for the phase y at which s D - zeta had its present value. At an end where
    slip of this sign stopped or begins that level is flat in y, so that moves are made in the
    square root of its distance from the nearer end; a steep end is pushed out of the way.
    """

    def __init__(self, impacts: Impacts, who: Rows) -> None:
        rows, pieces = impacts.outermost[who], impacts.pieces
        self.sign = sign = impacts.sign[who]
        polynomial = pieces.polynomial[rows]
        self.slip_terms = np.ascontiguousarray(pieces.slip[polynomial].T)
        self.force_terms = np.ascontiguousarray(pieces.force[polynomial].T)
        self.origin, self.scale = pieces["origin"][rows], 2.0 / pieces["length"][rows]
        start, stop = pieces["start"][rows], pieces["stop"][rows]
        length = stop - start
        inner_q = pieces["inner_q"][rows]
        high = -(sign * pieces["inner_f"][rows] + inner_q)
        low = -(sign * pieces["outer_f"][rows] + pieces["outer_q"][rows])
        drop = np.maximum(high - low, TINY)
        flat = (inner_q == 0.0) | (pieces["began"][rows] == sign)
        turning = pieces["ended"][rows] == sign
        self.low = np.where(turning, low, low - drop)
        self.high = np.where(flat, high, high + drop)
        self.lowest = np.where(flat, start + 1e-6 * length, start - LEEWAY * length)
        self.stop = stop
        self.least_slope = 0.1 * np.sqrt(drop) / length
        self.y: Array | None = None
        self._guess = (start, length, high, drop, flat, turning)

    def __call__(self, now: Contact, slip: Array) -> tuple[Array, Array]:
        """Return (q of the front, force); the force is stationary in y."""
        level = self.sign * slip
        level -= now.approach
        below = np.sqrt(np.maximum(level - self.low, 0.0))
        above = np.sqrt(np.maximum(self.high - level, 0.0))
        first = self.y is None
        if self.y is None:
            self.y = self._first(level, below, above)
            inner, outer = self.lowest, self.stop
        for _ in range(FIRST_MOVES if first else 1):
            old = self.y
            place = (old - self.origin) * self.scale
            place -= 1.0
            old_slip, slope = _with_slope(self.slip_terms, place)
            slope *= self.scale
            c = np.sin(old)
            here = self.sign * old_slip
            here -= c * c
            fall = self.sign * slope
            fall -= 2.0 * c * np.cos(old)
            self.y = self._moved(old, here, fall, below, above)
            if first:  # the level falls with y: keep the front between what was seen so far
                inner = np.where(here > level, old, inner)
                outer = np.where(here > level, outer, old)
                out = (self.y < inner) | (self.y > outer)
                self.y = np.where(out, 0.5 * (inner + outer), self.y)
        # F = F_old(y) + 1.5 c (D - D_old(y)) + s (slip zone)
        force = _value(self.force_terms, place)
        rest = slip - old_slip
        rest *= c
        rest *= 1.5
        force += rest
        gap = now.radius - c
        c += 2.0 * now.radius
        c *= gap
        c *= gap
        c *= 0.5 * self.sign
        force += c
        front = np.sin(self.y)
        front *= front
        return front, force

    def _first(self, level: Array, below: Array, above: Array) -> Array:
        start, length, high, drop, flat, turning = self._guess
        part = np.where(
            turning & flat,
            above / (above + below + TINY),
            np.where(
                turning,
                1.0 - below / np.sqrt(drop),
                np.where(flat, above / np.sqrt(drop), (high - level) / drop),
            ),
        )
        return np.asarray(np.minimum(np.maximum(start + length * part, self.lowest), self.stop))

    def _moved(self, old: Array, here: Array, fall: Array, below: Array, above: Array) -> Array:
        under = np.sqrt(np.maximum(here - self.low, 0.0))
        over = np.sqrt(np.maximum(self.high - here, 0.0))
        inner = above < below
        root = np.where(inner, over, under)
        new = np.where(inner, over - above, below - under)
        new *= root
        new *= 2.0
        new /= np.minimum(fall, -self.least_slope * root - TINY)
        new += old
        np.maximum(new, self.lowest, out=new)
        np.minimum(new, self.stop, out=new)
        return np.asarray(new)


def _with_slope(terms: Array, place: Array) -> tuple[Array, Array]:
    """Return polynomials and their slopes by Horner's rule."""
    slope = np.broadcast_to(terms[-1], place.shape).copy()
    total = place * terms[-1]
    total += terms[-2]
    for term in terms[-3::-1]:
        slope *= place
        slope += total
        total *= place
        total += term
    return total, slope


def _value(terms: Array, place: Array) -> Array:
    total = place * terms[-1]
    for term in terms[-2:0:-1]:
        total += term
        total *= place
    total += terms[0]
    return np.asarray(total)
