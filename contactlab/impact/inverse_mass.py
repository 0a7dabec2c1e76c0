"""The inverse mass W of two bodies at their contact, and what follows from it (theory §14)."""

from __future__ import annotations

import numpy as np

from contactlab.numeric.arrays import choose, every, magnitude, quotient
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array, Mask, Real, Rows, Vector
from contactlab.numeric.vectors import hypotenuse, rows, square_root

#: Smallest over largest eigenvalue of an inverse mass, scaled to ones on the diagonal, that is
#: told from zero.
SINGULAR = 1e-14
#: Determinant of a scaled inverse mass from which no eigenvalue is near that.
CLEAR = 1e-10
#: Parts of W, and of the slip over the speed, that are rounding.
ROUNDING = 1e-12
#: Ways in which an impact is solved: W does not couple, friction changes the approach and slip
#: keeps its line, slip turns.
CENTRAL, PLANAR, SPATIAL = 0, 1, 2


def check(inverse: Array) -> None:
    """Refuse a W that is not positive definite."""
    if inverse.ndim == 2:  # plain numbers warn of nothing
        definite = _is_definite(rows(inverse))
    else:
        with np.errstate(all="ignore"):
            definite = every(_is_definite(rows(inverse)))
    if definite:
        return
    with np.errstate(all="ignore"):
        diagonal = np.sqrt(np.einsum("...ii->...i", inverse))
        scaled = inverse / (diagonal[..., None] * diagonal[..., None, :])
    if not (np.isfinite(scaled).all() and np.linalg.eigvalsh(scaled).min() > SINGULAR):
        rule = "must be positive definite: lam · chi⁻¹ · eta must be below 2"
        raise refuse("inverse_mass", inverse.tolist(), rule)


def _is_definite(tensor: Rows) -> Mask:
    """Return where W is positive definite without a look at its eigenvalues, which takes longer."""
    (x, _, _), (a, y, _), (b, c, z) = tensor
    p, q, r = square_root(magnitude(x)), square_root(magnitude(y)), square_root(magnitude(z))
    a, b, c = quotient(a, p * q), quotient(b, p * r), quotient(c, q * r)
    # scaled to ones on the diagonal; the sum of the eigenvalues is 3 then, so that two have at most
    # 9/4 as product, and the least is no less than 4/9 of the determinant
    determinant = 1.0 - a * a - b * b - c * c + 2.0 * a * b * c
    return (x > 0.0) & (y > 0.0) & (z > 0.0) & (magnitude(a) < 1.0) & (determinant > CLEAR)


def ways(tensor: Rows, speed: Real, slip: Vector, cross_stiffness_ratio: Real = 1.0) -> Real:
    """Return the way of each impact: ``CENTRAL``, ``PLANAR`` or ``SPATIAL``.

    Parameters
    ----------
    tensor : rows of W
        In 1/kg, as of ``vectors.rows``.
    speed : float or array
        Speed of approach in m/s.
    slip : two floats or arrays
        Slip velocity along t1 and t2, in m/s.
    cross_stiffness_ratio : float or array
        That of the pair: where it is not 1, slip keeps its line along t1 only.
    """
    ((_, p, q), (_, a, b), (_, c, d)), (x, y) = tensor, slip
    least = ROUNDING * _coupled_size(tensor)
    pressed = hypotenuse(p, q) > least
    turned = magnitude((a * x + b * y) * y - (c * x + d * y) * x)
    leaves = magnitude(y) > ROUNDING * (magnitude(x) + magnitude(speed))
    moved = x * x + y * y
    # across its line slip changes by a share of itself: a slip that is rounding turns by nothing
    turns = turned > ROUNDING * a * (moved + square_root(moved) * magnitude(speed))
    turns = turns | (leaves & (cross_stiffness_ratio != 1.0))
    leaves = leaves | (magnitude(q) > least) | (magnitude(b) > ROUNDING * a)
    return choose(pressed | turns, choose(leaves, SPATIAL, PLANAR), CENTRAL)


def presses(tensor: Rows) -> Mask:
    """Return where friction changes the approach by more than rounding, by the rows of W."""
    return hypotenuse(tensor[0][1], tensor[0][2]) > ROUNDING * _coupled_size(tensor)


def _coupled_size(tensor: Rows) -> Real:
    """Return the scale in 1/kg against which W's coupling of approach and slip is small."""
    W = tensor
    return square_root(W[0][0] * 0.5 * (W[1][1] + W[2][2]))


def unit_slip(slip: Array) -> Array:
    """Return unit vectors along slip velocities, shape (..., 2); t1 where there is no slip."""
    if slip.ndim == 1:
        x, y = slip.tolist()
        length = float(np.hypot(x, y))
        return np.array([x / length, y / length] if length > 0.0 else [1.0, 0.0])
    size = np.hypot(slip[..., 0], slip[..., 1])[..., None]
    moving = size > 0.0
    return np.where(moving, slip / np.where(moving, size, 1.0), np.array([1.0, 0.0]))


def along(tensor: Rows, x: Real, y: Real) -> Real:
    """Return W in 1/kg along a unit vector of the tangent plane, by its rows and components."""
    W = tensor
    return x * (W[1][1] * x + W[1][2] * y) + y * (W[2][1] * x + W[2][2] * y)
