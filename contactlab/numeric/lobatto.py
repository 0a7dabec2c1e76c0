"""Lobatto collocation on [0, 1]: nodes, and the matrices that all panels share."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Added to distances from nodes so that none is zero; no other distance changes.
ON_NODE = 1e-290
#: A root is found to this part of the values around it, or to this width of tau.
ROOT_VALUE, ROOT_WIDTH, ROOT_CAP = 1e-16, 1e-15, 60
#: The parabola through three finer points is this part of its bend off at its lowest.
PARABOLA = 0.05


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
    derivative : array, shape (n, n)
        ``derivative @ f`` is f' at the nodes.
    tail : array, shape (2, n)
        ``tail @ f`` are the coefficients of the two highest Legendre polynomials in 2 tau - 1.
    ones : array, shape (n,)
    identity : array, shape (n, n)
    """

    points: Array
    integral: Array
    weights: Array
    fine: Array
    second: int
    to_fine: Array
    derivative: Array
    tail: Array
    ones: Array
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
    points = 0.5 + 0.5 * z
    return Nodes(
        points=points,
        integral=np.ascontiguousarray(integral),
        weights=weights,
        fine=fine,
        second=int(np.searchsorted(fine, points[1])),
        to_fine=np.ascontiguousarray(to_fine.T),
        derivative=_derivative(points, weights),
        tail=np.ascontiguousarray(to_coefficients[-2:]),
        ones=np.ones(count),
        identity=rows_of_identity,
    )


def _derivative(points: Array, weights: Array) -> Array:
    """Return the matrix of derivatives at the nodes; each row adds up to zero."""
    distance = points[:, None] - points + np.eye(points.size)
    matrix = weights / weights[:, None] / distance
    np.fill_diagonal(matrix, 0.0)
    np.fill_diagonal(matrix, -matrix.sum(axis=1))
    return np.asarray(matrix)


def rows(nodes: Nodes, tau: Array) -> Array:
    """Return the matrix, shape (..., n), that interpolates values at the nodes to ``tau``."""
    basis = nodes.weights / ((tau[..., None] - nodes.points) + ON_NODE)
    return np.asarray(basis / basis.sum(axis=-1, keepdims=True))


def value_at(nodes: Nodes, tau: float, values: Array) -> float:
    """Return the interpolant of ``values`` at one tau; faster than ``rows``."""
    basis = nodes.weights / ((tau - nodes.points) + ON_NODE)
    return float(basis.dot(values) / basis.dot(nodes.ones))


def row(nodes: Nodes, tau: float) -> Array:
    """Return the row of the matrix ``rows`` for one tau, shape (n,); faster than ``rows``."""
    basis = nodes.weights / ((tau - nodes.points) + ON_NODE)
    return np.asarray(basis / basis.dot(nodes.ones))


def basis(nodes: Nodes, tau: Array) -> Array:
    """Return barycentric weights, shape (n, K), for K places; divide by those of a table of 1."""
    distance = nodes.points[:, None] - tau
    distance += ON_NODE
    return np.asarray(np.divide(nodes.weights[:, None], distance, out=distance))


def first_fall(nodes: Nodes, table: Array, level: float, *, fresh: bool) -> tuple[float, int]:
    """Return tau and row of the first fall of a polynomial below ``level``; (inf, -1) if none.

    Parameters
    ----------
    nodes : Nodes
    table : array, shape (rows, n)
        Values at the nodes.
    level : float
        Below zero by rounding.
    fresh : bool
        Values may begin at zero: if the second node is above ``level``, a fall before it is noise.
    """
    first = np.inf, -1
    for which, (values, fine) in enumerate(zip(table, table @ nodes.to_fine, strict=True)):
        begin = nodes.second if fresh and values[1] >= level else 0
        k = begin + int((fine[begin:] < level).argmax())
        if fine[k] < level:
            ends = (nodes.fine[max(k - 1, 0)].item(), nodes.fine[k].item())
        elif (ends := _dip(nodes, values, fine, begin, level)) == (0.0, 0.0):
            continue
        tau = _root(nodes, values, *ends)
        if tau < first[0]:
            first = tau, which
    return first


def _dip(nodes: Nodes, values: Array, fine: Array, begin: int, level: float) -> tuple[float, float]:
    """Return two places around the first of two roots between finer points; zeros if none."""
    k = begin + 1 + int(fine[begin + 1 : -1].argmin())
    fall, rise = fine[k - 1].item() - fine[k].item(), fine[k + 1].item() - fine[k].item()
    if not (fall > 0.0 and rise > 0.0):
        return 0.0, 0.0
    slope, bend = 0.5 * (rise - fall), rise + fall
    if fine[k].item() - 0.5 * slope * slope / bend >= level + PARABOLA * bend:
        return 0.0, 0.0
    before = nodes.fine[k - 1].item()
    tau = 0.5 - 0.5 * math.cos((k - slope / bend) * math.pi / (len(fine) - 1))
    if value_at(nodes, tau, values) >= level:
        tau = _root(nodes, -(nodes.derivative @ values), before, nodes.fine[k + 1].item())
        if value_at(nodes, tau, values) >= level:
            return 0.0, 0.0
    return before, tau


def _root(nodes: Nodes, values: Array, a: float, b: float) -> float:
    """Return the root between a, where values are not negative, and b, by the Illinois method."""
    fa, fb = value_at(nodes, a, values), value_at(nodes, b, values)
    if fa <= 0.0:
        return a
    scale, side, tau = ROOT_VALUE * max(fa, -fb), 0, a
    for _ in range(ROOT_CAP):
        tau = (fa * b - fb * a) / (fa - fb)
        value = value_at(nodes, tau, values)
        if abs(value) <= scale or b - a < ROOT_WIDTH:
            break
        if value > 0.0:
            a, fa, fb = tau, value, 0.5 * fb if side == 1 else fb
            side = 1
        else:
            b, fb, fa = tau, value, 0.5 * fa if side == -1 else fa
            side = -1
    return tau
