"""Tractions on rings as sums of hemispheres, and the displacements that they make, theory §9.

The mode n of a traction is c(r) = sum a_i (r/e_i)^n sqrt(e_i² - r²) over the outer edges e_i of the
rings. Its values are given at the inner edge of every ring. So a pressure by Hertz, and a traction
by Cattaneo and Mindlin whose front is an edge, are exact. The mode n begins at the nth point, as
closer to the centre r^n would grow too fast from one point to the next. Lengths are in units of the
largest contact radius; displacements are in units of its square over R.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from contactlab.numeric.types import Array
from contactlab_halfspace.hemispheres import displacement

#: Power by which rings become narrower towards the edge of the largest contact. Of the powers 1 to
#: 2 and of a sine this one leaves the least error of psi2 at equal numbers of rings.
CROWDING = 1.5


def edge_at(place: Array) -> Array:
    """Return the radius at ``place``, a number of rings over all rings, from 0 to 1."""
    return np.asarray(1.0 - (1.0 - place) ** CROWDING)


class Basis(NamedTuple):
    """Matrices of rings for the modes of orders 0, 1, ...

    The leading blocks of each matrix are the matrices of a smaller contact.

    Attributes
    ----------
    edges : array, shape (rings + 1,)
        Radii of the edges, the first 0.
    coefficients : tuple of array, shape (rings, rings)
        For each order the a_i for a unit of traction at each inner edge.
    work : tuple of array, shape (rings, rings)
        For each order: slip @ work @ traction is the integral of both times r. Slip over r^n is
        linear in r² between the inner edges. The integral is exact.
    force : array, shape (rings,)
        Force for a unit of traction of order 0, over the force of the largest Hertz contact.
    """

    edges: Array
    coefficients: tuple[Array, ...]
    work: tuple[Array, ...]
    force: Array

    def compliance(self, order: int, source: int) -> Array:
        """Return the displacement of ``order`` at inner edges for a unit traction of ``source``."""
        fields = displacement(order, source, self.edges[:-1, None], self.edges[None, 1:])
        matrix = np.asarray(fields @ self.coefficients[source])
        begin = min(order, len(matrix) - 1)
        if order == source and begin:
            # Where the mode is left out a traction of it yields as the point does by itself, or
            # nothing would tell how large it is.
            places = np.arange(begin)
            matrix[places, places] = np.diag(self.compliance(0, 0))[:begin]
        return matrix


@lru_cache(maxsize=16)
def basis(rings: int, orders: int, spare: float = 0.0) -> Basis:
    """Return the basis of ``rings`` rings up to radius 1, and of rings to 1 + ``spare`` beyond."""
    edges = edge_at(np.arange(rings + 1) / rings)
    if spare:
        more = min(max(int(np.ceil(spare / (edges[-1] - edges[-2]))), 1), MOST_SPARE)
        edges = np.append(edges, 1.0 + spare * np.arange(1, more + 1) / more)
    points, ends = edges[:-1], edges[1:]
    roots = np.sqrt(np.maximum(ends**2 - points[:, None] ** 2, 0.0))
    coefficients = tuple(_coefficients(points, ends, roots, order) for order in range(orders))
    work = tuple(_moments(edges, order) @ each for order, each in enumerate(coefficients))
    return Basis(edges, coefficients, work, ends**3 @ coefficients[0])


#: Most rings beyond radius 1.
MOST_SPARE = 4


def _coefficients(points: Array, ends: Array, roots: Array, order: int) -> Array:
    """Return the coefficients for unit tractions; a mode begins at the point of its order."""
    first = min(order, len(points) - 1)
    inverse = np.zeros(roots.shape)
    inside = np.asarray(np.linalg.inv(roots[first:, first:]), float)
    inverse[first:, first:] = ends[first:, None] ** order * inside * points[first:] ** -float(order)
    return inverse


def _moments(edges: Array, order: int) -> Array:
    """Return the integrals of r times basis functions times slips, shape (slips, functions)."""
    # With w² = e² - r² the integrand is a polynomial in w: Gauss's rule is exact.
    nodes, weights = np.polynomial.legendre.leggauss(order + 3)
    squares, count = edges**2, len(edges) - 1
    begin = min(order, count - 1)
    moments = np.zeros((count, count))
    for ring in range(count):
        near, far, ends = squares[ring], squares[ring + 1], squares[ring + 1 :, None]
        first, last = np.sqrt(ends - near), np.sqrt(ends - far)
        w = 0.5 * (first + last) + 0.5 * (first - last) * nodes
        square = ends - w * w
        share = (square - near) / (far - near)
        whole = 0.5 * (first - last) * weights * w * w * (square / ends) ** (0.5 * order)
        whole *= square ** (0.5 * order)
        if ring < begin:  # slip over r^n is constant up to the first point
            moments[begin, ring:] += whole.sum(axis=1)
        elif ring == count - 1:
            moments[ring, ring:] += whole.sum(axis=1)
        else:
            moments[ring, ring:] += (whole * (1.0 - share)).sum(axis=1)
            moments[ring + 1, ring:] += (whole * share).sum(axis=1)
    moments[begin:] /= edges[begin:-1, None] ** order
    return moments
