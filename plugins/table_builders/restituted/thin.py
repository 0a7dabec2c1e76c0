"""The rebound with one loss for pressure and shear, thinned to 1e-4 for the kernels of games."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from contactlab.numeric.types import Array
from contactlab_laws.viscoelastic.batch import extrapolate_steps
from contactlab_laws.viscoelastic.relaxation import number_of
from table_builders.elastic import thin

#: How the table begins in each kernel.
FILES = {"contactlab_bounce.mjs": "const LOSSY = [", "contactlab_bounce.h": "_lossy[] = {"}
#: Springs and steps of the impacts.
SPRINGS, STEPS = 300, 1500
#: Sum of the terms left out of a leaf, and the unit of those that stay.
LEFT_OUT, UNIT = 4e-5, 1e-6
#: Numbers of a leaf above which it is split: fewer take less time, and more room.
LARGEST = 220
#: Word of a leaf where a fork has its axis.
LEAF = 3


class Piece(NamedTuple):
    """A box of (u, chi, e), each coordinate mapped on [0, 1], e as it is.

    Attributes
    ----------
    slips : bool
        False where psi1 = u; else psi1 goes from 1 to where slip lasts (theory §15).
    lower, upper : float
        chi.
    shape : tuple of int
        Nodes along the axes.
    """

    slips: bool
    lower: float
    upper: float
    shape: tuple[int, int, int]


PIECES = (
    Piece(False, 0.5, 1.0, (12, 10, 14)),
    Piece(False, 1.0, 1.5, (12, 10, 14)),
    Piece(False, 1.5, 2.0, (16, 20, 18)),
    Piece(True, 0.5, 1.0, (30, 14, 18)),
    Piece(True, 1.0, 1.5, (30, 16, 20)),
    Piece(True, 1.5, 2.0, (44, 20, 24)),
)


def thin_table() -> list[str]:
    """Return the numbers of the table.

    First where the tree of each piece begins. A fork is its axis, how many numbers its lower half
    has, the lower half, the upper. A leaf is LEAF; how many powers of u it has; for each of them
    how many of chi; and for each of these how many of e, and the terms by Chebyshev polynomials of
    2x - 1 on the leaf, in units of UNIT. The value is psi2/psi1, or where psi1 > 1 psi2 less that
    of slip throughout.
    """
    trees = [tree(piece) for piece in PIECES]
    starts = len(PIECES) + np.cumsum([0, *map(len, trees[:-1])])
    return [str(each) for each in (*starts, *(number for each in trees for number in each))]


def tree(piece: Piece) -> list[int]:
    """Return the numbers of a piece, whose impacts take up to two minutes."""
    return list(_tree(_terms(_values(piece))))


def write(folder: Path | None = None) -> list[Path]:
    """Write the table into the kernels of a folder, by default contactlab's; return the files."""
    return thin.put(thin_table(), FILES, folder)


def nodes(count: int) -> Array:
    """Return Chebyshev's nodes in [0, 1]."""
    return np.asarray(0.5 + 0.5 * np.cos((np.arange(count) + 0.5) * np.pi / count))


def _values(piece: Piece) -> Array:
    """Return the values at the nodes of a piece."""
    u, place, e = (nodes(count) for count in piece.shape)
    u, chi = np.meshgrid(u, piece.lower + place * (piece.upper - piece.lower), indexing="ij")
    return np.stack([_slice(piece.slips, u, chi, float(each)) for each in e], axis=-1)


def _slice(slips: bool, u: Array, chi: Array, e: float) -> Array:
    """Return the values at one restitution, shape of ``u``."""
    psi1 = 1.0 + (2.0 * chi - 1.0) * (1.0 + e) * u * (2.0 - u) if slips else u
    a = number_of(e)
    psi2 = extrapolate_steps(psi1.ravel(), chi.ravel(), a, springs=SPRINGS, steps=STEPS).reshape(
        u.shape
    )
    return psi2 - psi1 + 2.0 * chi * (1.0 + e) if slips else psi2 / psi1


def _along(matrix: Array, terms: Array, axis: int) -> Array:
    """Return the product of a matrix with every row along an axis."""
    return np.moveaxis(np.tensordot(matrix, terms, (1, axis)), 0, axis)


def _terms(values: Array) -> Array:
    """Return Chebyshev terms of values at the nodes of a box."""
    for axis, count in enumerate(values.shape):
        values = _along(_back(count), values, axis)
    return values


def _back(count: int) -> Array:
    """Return the matrix from values at the nodes to Chebyshev terms."""
    return np.asarray(np.linalg.inv(chebvander(2.0 * nodes(count) - 1.0, count - 1)), float)


def _halves(terms: Array, axis: int) -> list[Array]:
    """Return the terms on both halves of a box."""
    count = terms.shape[axis]
    x = nodes(count)
    matrices = [_back(count) @ chebvander(x + shift, count - 1) for shift in (-1.0, 0.0)]
    return [_along(matrix, terms, axis) for matrix in matrices]


def _tree(terms: Array) -> Iterator[int]:
    """Yield the numbers of a box: a leaf, or two halves along the axis that leaves the fewest."""
    leaf = _leaf(terms)
    if len(leaf) <= LARGEST:
        yield from leaf
        return
    options = [_halves(terms, axis) for axis in range(3)]
    sizes = [sum(len(_leaf(half)) for half in halves) for halves in options]
    axis = int(np.argmin(sizes))
    lower, upper = (list(_tree(half)) for half in options[axis])
    yield from (axis, len(lower), *lower, *upper)


def _leaf(terms: Array) -> list[int]:
    sizes = np.sort(np.abs(terms), axis=None)
    least = sizes[np.searchsorted(sizes.cumsum(), LEFT_OUT)]
    units = np.where(np.abs(terms) < least, 0.0, np.rint(terms / UNIT)).astype(int)
    depths, columns = _last(units), _last(_last(units))
    rows = int(_last(columns))
    numbers = [LEAF, rows]
    for i in range(rows):
        numbers.append(int(columns[i]))
        for j in range(columns[i]):
            numbers += [int(depths[i, j]), *units[i, j, : depths[i, j]].tolist()]
    return numbers


def _last(units: NDArray[np.int_]) -> NDArray[np.int_]:
    """Return how many numbers along the last axis reach to the last that is not 0."""
    count = units.shape[-1]
    return np.asarray(np.where(units != 0, np.arange(1, count + 1), 0).max(axis=-1, initial=0))
