"""Lobatto collocation on [0, 1]: nodes, integration to them, and interpolation between them."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from contactlab.numeric.types import Array

#: Offset of distances from nodes, so that none is zero; no other distance changes.
ON_NODE = 1e-290


class Nodes(NamedTuple):
    """Nodes, weights and integration for n nodes.

    Attributes
    ----------
    points : array, shape (n,)
        The nodes tau, 0 and 1 included.
    integral : array, shape (n, n)
        ``integral[i] @ f`` is the integral of f from 0 to ``points[i]``.
    weights : array, shape (n,)
        Weights of barycentric interpolation.
    """

    points: Array
    integral: Array
    weights: Array


@cache
def lobatto(count: int) -> Nodes:
    """Return Gauss-Lobatto-Legendre nodes on [0, 1]."""
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
    return Nodes(0.5 + 0.5 * z, np.ascontiguousarray(integral), weights)


def rows(nodes: Nodes, tau: Array) -> Array:
    """Return the matrix, shape (..., n), that interpolates values at the nodes to ``tau``."""
    basis = nodes.weights / ((tau[..., None] - nodes.points) + ON_NODE)
    return np.asarray(basis / basis.sum(axis=-1, keepdims=True))
