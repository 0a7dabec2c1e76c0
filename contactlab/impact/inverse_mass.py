"""The inverse mass W of two bodies at their contact, and what follows from it (theory §14)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array, Real

#: Smallest over largest eigenvalue of an inverse mass, scaled to ones on the diagonal, that is
#: told from zero.
SINGULAR = 1e-14
#: Parts of W, and of the slip over the speed, that are rounding.
ROUNDING = 1e-12
#: Ways in which an impact is solved: W does not couple, friction changes the approach and slip
#: keeps its line, slip turns.
CENTRAL, PLANAR, SPATIAL = 0, 1, 2


def check(inverse: Array) -> None:
    """Refuse a W that is not positive definite."""
    diagonal = np.sqrt(np.einsum("...ii->...i", inverse))
    with np.errstate(all="ignore"):
        scaled = inverse / (diagonal[..., None] * diagonal[..., None, :])
    if not (np.isfinite(scaled).all() and np.linalg.eigvalsh(scaled).min() > SINGULAR):
        rule = "must be positive definite: lam · chi⁻¹ · eta must be below 2"
        raise refuse("inverse_mass", inverse.tolist(), rule)


def ways(inverse: Array, speed: Real, slip: Array, cross_stiffness_ratio: Real = 1.0) -> Any:
    """Return the way of each impact: ``CENTRAL``, ``PLANAR`` or ``SPATIAL``.

    Parameters
    ----------
    inverse : array, shape (..., 3, 3)
        W in 1/kg.
    speed : float or array
        Speed of approach in m/s.
    slip : array, shape (..., 2)
        Slip velocity along t1 and t2, in m/s.
    cross_stiffness_ratio : float or array
        That of the pair: where it is not 1, slip keeps its line along t1 only.
    """
    uneven = np.not_equal(cross_stiffness_ratio, 1.0)
    if slip.ndim == 1:
        return _way_of_one(inverse.tolist(), float(speed), slip.tolist(), bool(uneven))
    W = inverse
    size = np.sqrt(W[..., 0, 0] * 0.5 * (W[..., 1, 1] + W[..., 2, 2]))
    pressed = np.hypot(W[..., 0, 1], W[..., 0, 2]) > ROUNDING * size
    across = np.einsum("...ij,...j->...i", W[..., 1:, 1:], slip)
    turned = np.abs(across[..., 0] * slip[..., 1] - across[..., 1] * slip[..., 0])
    turns = turned > ROUNDING * W[..., 1, 1] * np.einsum("...i,...i->...", slip, slip)
    leaves = np.abs(slip[..., 1]) > ROUNDING * (np.abs(speed) + np.abs(slip[..., 0]))
    turns |= uneven & leaves
    leaves |= np.abs(W[..., 0, 2]) > ROUNDING * size
    leaves |= np.abs(W[..., 1, 2]) > ROUNDING * W[..., 1, 1]
    coupled = np.where(leaves, SPATIAL, PLANAR)
    return np.where(pressed | turns, coupled, CENTRAL)


def _way_of_one(inverse: list[list[float]], speed: float, slip: list[float], uneven: bool) -> int:
    """Return the way of one impact: ``ways`` in plain numbers, many times as fast."""
    W, (x, y) = inverse, slip
    size = math.sqrt(W[0][0] * 0.5 * (W[1][1] + W[2][2]))
    pressed = math.hypot(W[0][1], W[0][2]) > ROUNDING * size
    turned = abs((W[1][1] * x + W[1][2] * y) * y - (W[2][1] * x + W[2][2] * y) * x)
    leaves = abs(y) > ROUNDING * (abs(speed) + abs(x))
    turns = turned > ROUNDING * W[1][1] * (x * x + y * y) or (uneven and leaves)
    if not (pressed or turns):
        return CENTRAL
    leaves = leaves or abs(W[0][2]) > ROUNDING * size
    return SPATIAL if leaves or abs(W[1][2]) > ROUNDING * W[1][1] else PLANAR


def impulse(inverse: Array, change: Array) -> Array:
    """Return the impulse on the target in N s that makes a change of velocity, (..., 3)."""
    return np.asarray(-np.linalg.solve(inverse, change[..., None])[..., 0])


def along(slip: Array) -> Array:
    """Return unit vectors along slip velocities, shape (..., 2); t1 where there is no slip."""
    size = np.hypot(slip[..., 0], slip[..., 1])[..., None]
    moving = size > 0.0
    return np.where(moving, slip / np.where(moving, size, 1.0), np.array([1.0, 0.0]))


def mass_along(inverse: Array, direction: Array) -> Any:
    """Return the tangential mass in kg along a direction of the tangent plane, (..., 2)."""
    W = inverse[..., 1:, 1:]
    return 1.0 / np.einsum("...i,...ij,...j->...", direction, W, direction)
