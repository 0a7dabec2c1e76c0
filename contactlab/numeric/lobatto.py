"""Lobatto collocation on [0, 1]: nodes, and the matrices that all panels share."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Added to distances from nodes so that none is zero; no other distance changes.
ON_NODE = 1e-290


class Nodes(NamedTuple):
    """Nodes, weights and matrices for n nodes.

    Attributes
    ----------
    points : array, shape (n,)
        The nodes tau, 0 and 1 included.
    integral : array, shape (n, n)
        ``integral[i] @ f`` is the integral of f from 0 to ``points[i]``.
    weights : array, shape (n,)
        Weights of barycentric interpolation.
    fine : array, shape (m,)
        Finer points, at which events are looked for.
    second : int
        Index of the first finer point at or after the second node.
    to_fine : array, shape (n, m)
        Values at nodes @ ``to_fine`` are values at the finer points.
    slope : array, shape (n,)
        ``slope @ f`` is f'(0).
    legendre, tail : arrays, shape (n, n) and (2, n)
        ``legendre @ f`` are the coefficients of Legendre's polynomials in 2 tau - 1; ``tail @ f``
        are the two highest coefficients.
    powers : array, shape (n, n)
        ``powers @ (legendre @ f)`` are the coefficients of powers of 2 tau - 1, lowest first. The
        product of the two matrices would lose digits, half of them at 20 nodes.
    plain, rooted : tuple of two arrays
        (x - origin)/length at the nodes and its derivative with respect to tau: linear, or with
        nodes crowded as (1 - tau)² at the end, which makes (1 - x)^1.5 a polynomial.
    identity : array, shape (n, n)
    """

    points: Array
    integral: Array
    weights: Array
    fine: Array
    second: int
    to_fine: Array
    slope: Array
    legendre: Array
    tail: Array
    powers: Array
    plain: tuple[Array, Array]
    rooted: tuple[Array, Array]
    identity: Array


@cache
def lobatto(count: int) -> Nodes:
    """Return Gauss-Lobatto-Legendre nodes on [0, 1] and their matrices."""
    top = np.zeros(count)
    top[-1] = 1.0
    inner = legendre.legroots(legendre.legder(top))
    z = np.concatenate(([-1.0], np.sort(inner.real), [1.0]))
    to_coefficients = np.linalg.inv(legendre.legvander(z, count - 1))
    rows_of_identity = np.eye(count)
    primitive = np.stack([legendre.legint(row, lbnd=-1.0) for row in rows_of_identity], axis=1)
    integral = 0.5 * legendre.legvander(z, count) @ primitive @ to_coefficients
    integral[0] = 0.0
    difference = z[:, None] - z[None, :] + rows_of_identity
    weights = 1.0 / np.prod(2.0 * difference, axis=1)
    weights /= np.abs(weights).max()
    fine = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 3 * count + 1))
    to_fine = legendre.legvander(2.0 * fine - 1.0, count - 1) @ to_coefficients
    slopes = [legendre.legval(-1.0, legendre.legder(row)) for row in rows_of_identity]
    points = 0.5 + 0.5 * z
    return Nodes(
        points=points,
        integral=np.ascontiguousarray(integral),
        weights=weights,
        fine=fine,
        second=int(np.searchsorted(fine, points[1])),
        to_fine=np.ascontiguousarray(to_fine.T),
        slope=2.0 * np.array(slopes) @ to_coefficients,
        legendre=np.asarray(to_coefficients),
        tail=np.ascontiguousarray(to_coefficients[-2:]),
        powers=np.stack([_powers(row) for row in rows_of_identity], axis=1),
        plain=(points, np.ones(count)),
        rooted=(points * (2.0 - points), 2.0 * (1.0 - points)),
        identity=rows_of_identity,
    )


def _powers(coefficients: Array) -> Array:
    """Return coefficients of powers, shape (n,), from coefficients of Legendre's polynomials."""
    powers = legendre.leg2poly(coefficients)
    return np.asarray(np.pad(powers, (0, coefficients.size - powers.size)))


def rows(nodes: Nodes, tau: Array) -> Array:
    """Return the matrix, shape (..., n), that interpolates values at the nodes to ``tau``."""
    basis = nodes.weights / ((tau[..., None] - nodes.points) + ON_NODE)
    return np.asarray(basis / basis.sum(axis=-1, keepdims=True))


def value_at(nodes: Nodes, tau: float, values: Array) -> float:
    """Return the interpolant of ``values`` at one tau; faster than ``rows``."""
    basis = nodes.weights / ((tau - nodes.points) + ON_NODE)
    return float(basis.dot(values) / basis.dot(nodes.plain[1]))


def row(nodes: Nodes, tau: float) -> Array:
    """Return the row of the matrix ``rows`` for one tau, shape (n,); faster than ``rows``."""
    basis = nodes.weights / ((tau - nodes.points) + ON_NODE)
    return np.asarray(basis / basis.dot(nodes.plain[1]))


def dips(nodes: Nodes, values: Array, fine: Array, least: Any) -> tuple[Any, Any, Array]:
    """Return finer point, column and tau of each minimum of K polynomials below ``least``.

    A parabola through three finer points locates a candidate; the polynomial's value decides.
    """
    step = fine[nodes.second :] - fine[nodes.second - 1 : -1]
    index, column = ((step[:-1] < 0.0) & (step[1:] >= 0.0)).nonzero()
    if not index.size:
        return index, column, np.zeros(0)
    fall, rise = step[index, column], step[index + 1, column]
    index += nodes.second
    bend, slope = rise - fall, 0.5 * (rise + fall)
    least = np.broadcast_to(least, fine.shape[1:])[column]
    low = np.flatnonzero(fine[index, column] - 0.5 * slope * (slope / bend) < least)
    index, column = index[low], column[low]
    if low.size:
        angle = (index - (slope / bend)[low]) * (np.pi / (len(fine) - 1))
        tau = 0.5 - 0.5 * np.cos(angle)
        low = np.einsum("ij,ji->i", rows(nodes, tau), values[:, column]) < least[low]
        return index[low], column[low], tau[low]
    return index, column, np.zeros(0)
