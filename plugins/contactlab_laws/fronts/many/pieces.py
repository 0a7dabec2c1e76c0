"""The memory of many impacts: pieces of locked profiles in one growing table.

A piece is a row, and knows the row of the next piece inside it, so that a profile is the
number of its outermost piece. Rows are never changed: pieces that slip are just left behind.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.lobatto import Array, Nodes
from contactlab_laws.fronts.laid import Laid
from contactlab_laws.fronts.profile import Locked, ProfilePiece

Rows = NDArray[np.intp]

NO_PIECE = -1
LAID = tuple(field.name for field in attrs.fields(Laid) if field.name != "output")
LOCKED = tuple(field.name for field in attrs.fields(Locked))


class Polynomials(NamedTuple):
    """Panels in which pieces were laid down, as polynomials: the ``DenseOutput`` of each piece.

    ``terms``, shape (3, terms, impacts), are coefficients of slip, force and d(slip)/dx by powers
    of a coordinate that goes from -1 at ``origin`` to 1.
    """

    origin: Array
    scale: Array
    terms: Array

    def fields(self, x: Array) -> Any:
        """Return slip, force, approach, radius, d(slip)/dx, d(approach)/dx at each x."""
        spot = (x - self.origin) * self.scale
        spot -= 1.0
        terms = self.terms[:, :, None, :]
        total = terms[:, -1] * spot
        for power in range(terms.shape[1] - 2, 0, -1):  # Horner's rule
            total += terms[:, power]
            total *= spot
        total += terms[:, 0]
        c = np.sin(x)
        return total[0], total[1], c * c, c, total[2] * self.scale, 2.0 * c * np.cos(x)


class PieceTable:
    """Pieces by row: w(q) = f(q) + D in each, q = s² of a spring (theory §5).

    Parameters
    ----------
    nodes : Nodes
        Of the panels in which pieces are laid down.
    room : int
        Rows to begin with; the table doubles when they are used up.
    """

    def __init__(self, nodes: Nodes, room: int) -> None:
        self.nodes, self.used = nodes, 0
        self.inside = np.full(room, NO_PIECE, dtype=np.intp)
        self.columns = {name: np.zeros(room) for name in (*LAID, *LOCKED, "origin", "scale")}
        self.columns["terms"] = np.zeros((room, 3, len(nodes.points)))

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    def add(self, inside: Rows, piece: Laid | Locked) -> Rows:
        """Append a piece outside each row of ``inside``; return their rows."""
        if isinstance(piece, Laid):
            assert isinstance(piece.output, Polynomials)
            names, values = LAID, piece.output._asdict()
            values["terms"] = values["terms"].transpose(2, 0, 1)
        else:
            names, values = LOCKED, {}
        first, last = self.used, self.used + inside.size
        while last > self.inside.size:
            self.columns = {name: _doubled(old) for name, old in self.columns.items()}
            self.inside = _doubled(self.inside)
        self.inside[first:last] = inside
        for name, given in (values | {name: getattr(piece, name) for name in names}).items():
            self.columns[name][first:last] = given
        self.used = last
        return np.arange(first, last)

    def output(self, start: Array, length: Array, at_nodes: tuple[Array, Array]) -> Polynomials:
        """Return panels from ``start`` on, from slip and force at their nodes."""
        nodes = self.nodes
        terms = np.zeros((3, len(nodes.points), start.size))
        for column, values in enumerate(at_nodes):
            terms[column] = nodes.powers @ (nodes.legendre @ values)
        terms[2, :-1] = terms[0, 1:] * np.arange(1, len(nodes.points))[:, None]
        return Polynomials(start, 2.0 / length, terms)

    def piece(self, rows: Rows, *, laid: bool) -> ProfilePiece:
        """Return the pieces of some rows, all laid down or all locked, as one."""
        if not laid:
            return Locked(*(self[name][rows] for name in LOCKED))
        terms = np.ascontiguousarray(self["terms"][rows].transpose(1, 2, 0))
        output = Polynomials(self["origin"][rows], self["scale"][rows], terms)
        return Laid(output, *(self[name][rows] for name in LAID))


def _doubled(old: NDArray[Any]) -> NDArray[Any]:
    return np.concatenate((old, np.zeros_like(old)))
