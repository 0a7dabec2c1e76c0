"""Slip along one line, or in the tangent plane: operations of viscous springs in both."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.arrays import shape_as
from contactlab.numeric.types import Array, Real
from contactlab_laws.springs.turning import TINY, Vectors, beyond, drag_springs, relax, stretch


class Line(NamedTuple):
    """Slip along one line: displacements and forces are real numbers."""

    def of(self, _: NDArray[np.intp]) -> Line:
        """Return the direction of some impacts."""
        return self

    def rows(self, value: Real, row: Callable[[Real], Array]) -> Vectors:
        """Return numbers of a batch in the arrangement of ``row``."""
        return row(value)

    def restore_shape(self, force: Vectors, shape: tuple[int, ...]) -> Real:
        """Return forces in the shape of the batch."""
        restored: Real = shape_as(force, shape)
        return restored

    def stretch(self, move: Vectors) -> Vectors:
        """Return displacements times the stiffness over that along the first axis."""
        return move

    def relax(self, force: Vectors) -> Vectors:
        """Return the displacements that ``stretch`` made forces of."""
        return force

    def product(self, first: Vectors, second: Vectors) -> Vectors:
        """Return force times displacement."""
        return first * second

    def cut(self, force: Vectors, limit: Array) -> Vectors:
        """Cut forces to their limit, in place, and return them."""
        np.minimum(force, limit, out=force)
        return np.maximum(force, -limit, out=force)

    def drag(
        self, w: Vectors, move: Vectors, _: Vectors, first: Array, last: Array, decay: Array
    ) -> Vectors:
        """Return w1 = clip(w0 + v h, w0 E - q, w0 E + q), theory §15, E = exp(-``decay``)."""
        # 1 - E is the share of w that relaxes, q may take its place; the limit moves evenly
        gone = -np.expm1(-decay)
        q = first * gone + (last - first) * (1.0 - gone / np.maximum(decay, TINY))
        free = w * (1.0 - gone)
        return np.asarray(np.minimum(np.maximum(w + move, free - q), free + q))


class Plane(NamedTuple):
    """Slip in the tangent plane: displacements and forces are complex numbers.

    ``cross`` is the stiffness along the second axis over that along the first, shape (items,); None
    where both are equal.
    """

    cross: Array | None

    def of(self, where: NDArray[np.intp]) -> Plane:
        """Return the direction of some impacts."""
        return self if self.cross is None else Plane(self.cross[where])

    def rows(self, value: Real, row: Callable[[Real], Array]) -> Vectors:
        """Return vectors of a batch, shape (..., 2), in the arrangement of ``row``."""
        value = np.asarray(value)
        return row(value[..., 0]) + 1j * row(value[..., 1])

    def restore_shape(self, force: Vectors, shape: tuple[int, ...]) -> Real:
        """Return forces in the shape of the batch, (..., 2)."""
        return np.stack((force.real, force.imag), axis=-1).reshape(*shape, 2)

    def stretch(self, move: Vectors) -> Vectors:
        """Return displacements times the stiffness over that along the first axis."""
        return stretch(move, self.cross)

    def relax(self, force: Vectors) -> Vectors:
        """Return the displacements that ``stretch`` made forces of."""
        return relax(force, self.cross)

    def product(self, first: Vectors, second: Vectors) -> Vectors:
        """Return the inner products of forces and displacements."""
        return (np.conj(first) * second).real

    def cut(self, force: Vectors, limit: Array) -> Vectors:
        """Cut forces to their limit, in place, and return them."""
        return np.subtract(force, beyond(force, limit, self.cross), out=force)

    def drag(
        self, w: Vectors, move: Vectors, pull: Vectors, first: Array, last: Array, decay: Array
    ) -> Vectors:
        """Return w of springs that stick or slip along their force, ``pull`` being A v."""
        return drag_springs(w, move, pull, first, last, decay, self.cross)


#: Where springs move.
Direction: TypeAlias = Line | Plane
