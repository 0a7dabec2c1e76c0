"""The memory of many impacts: locked pieces of profile in one growing table.

A piece is a row, and knows the row of the next piece inside it, so that a profile is the
number of its outermost piece. Rows are never changed: pieces swept away are just left behind.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

LAID = 0.0  # stands for the sign of a piece that was laid down while all stuck
NO_PIECE = -1
#: Columns of every piece, then those of a piece laid down between two phases.
COLUMNS = (
    "sign",  # of the slip out of which it locked, or LAID
    "inner_q",
    "inner_f",
    "base",  # locked: I(c) = base + sign c³
    "start",  # laid: phases at its inner and outer end
    "stop",
    "origin",  # laid: phase and length of the panel whose polynomials it keeps
    "length",
    "began",  # laid: sign of the slip that stopped at its inner end, or 0
    "ended",  # laid: sign of the slip that begins at its outer end, or 0
    "outer_q",
    "outer_f",
)


class Pieces:
    """Pieces by row: w(q) = f(q) + D in each, q = s² the place of a spring (theory §5).

    Parameters
    ----------
    terms : int
        Number of coefficients of the polynomials of a piece laid down, for D and for F.
    room : int
        Rows to begin with; the table doubles when they are used up.
    """

    def __init__(self, terms: int, room: int) -> None:
        self.terms = terms
        self.used = 0
        self.columns = {name: np.zeros(room) for name in COLUMNS}
        self.inside = np.full(room, NO_PIECE, dtype=np.intp)
        self.slip = np.zeros((0, terms))
        self.force = np.zeros((0, terms))
        self.polynomial = np.zeros(room, dtype=np.intp)
        self.polynomials = 0

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    def add(self, count: int, inside: Rows, **values: Any) -> Rows:
        """Append ``count`` pieces and return their rows."""
        first, last = self.used, self.used + count
        while last > self.inside.size:
            self.columns = {name: _doubled(old) for name, old in self.columns.items()}
            self.inside = _doubled(self.inside)
            self.polynomial = _doubled(self.polynomial)
        self.inside[first:last] = inside
        for name, given in values.items():
            self.columns[name][first:last] = given
        self.used = last
        return np.arange(first, last)

    def keep_polynomials(self, rows: Rows, slip: Array, force: Array) -> None:
        """Keep the coefficients (terms, pieces) of D and F of pieces just laid down."""
        first, last = self.polynomials, self.polynomials + rows.size
        while last > len(self.slip):
            room = max(2 * len(self.slip), 2 * rows.size)
            self.slip = np.resize(self.slip, (room, self.terms))
            self.force = np.resize(self.force, (room, self.terms))
        self.slip[first:last] = slip.T
        self.force[first:last] = force.T
        self.polynomial[rows] = np.arange(first, last)
        self.polynomials = last


def _doubled(old: NDArray[Any]) -> NDArray[Any]:
    return np.concatenate((old, np.zeros_like(old)))
