"""Matrices of the annulus method that depend on the number of annuli alone.

The unknowns are the tractions q_j in the middles of the annuli, in units in which the
Coulomb limit of eq. (34) is sqrt(beta² - r_j²), not the coefficients phi_i of eq. (1):
q = S phi with S upper triangular. The displacement of eq. (33) is then xi = B q with
B = A S^-1 / 2, everywhere and always, the free surface outside the contact included. B has
condition 3 n, the mixed matrix in phi n^2.5 (theory §6).

Memory is the lag of each annulus behind the bodies, g_j = xi_j - D with D the slip displacement
so far: while an annulus sticks its lag is constant, which is all that (33) says.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from contactlab.numeric.types import Array, Real

#: Most annuli for which the responses of all leading divisions are kept (8 n³ bytes: 64 MB at 200).
LARGEST_TABLE = 200


class Tables(NamedTuple):
    """Read-only arrays for ``n`` annuli."""

    mean: bool  # (33) prescribes the mean displacement of an annulus, else its middle's
    radius_squared: Array  # r_j², shape (n,)
    weight: Array  # F^ = weight . q, eq. (22), shape (n,)
    compliance: Array  # B, shape (n, n)
    lower_inverse: Array  # L^-1 of B = L U, shape (n, n)
    upper_inverse: Array  # U^-1, shape (n, n)
    responses: list[Array]  # entry c: ``response`` with annuli 1..c stuck; empty for large n


def hertz_pressure(table: Tables, radius: Real) -> Array:
    """Return sqrt(beta² - r_j²), the limits (34) of a Hertz pressure, shape (..., n)."""
    limits = np.square(np.asarray(radius))[..., None] - table.radius_squared
    return np.asarray(np.sqrt(np.maximum(limits, 0.0, out=limits), out=limits))


def influence(annuli: int) -> Array:
    """Return A of eq. (14), middles of annuli j in rows and distributions i in columns."""
    # The misprint in the second branch is corrected: it holds for j = i+1 .. n.
    i = np.arange(1, annuli + 1)[None, :]
    middle = np.arange(1, annuli + 1)[:, None] - 0.5
    ratio = np.minimum(i / middle, 1.0)  # inside, arcsin 1 = pi/2 gives the first branch
    root = np.sqrt(np.maximum(middle**2 - i**2, 0.0))
    return np.asarray(((2 * i**2 - middle**2) * np.arcsin(ratio) / i + root) / annuli)


def traction_shape(annuli: int) -> Array:
    """Return S of eq. (34): q = S phi, upper triangular."""
    i = np.arange(1, annuli + 1)[None, :]
    middle = np.arange(1, annuli + 1)[:, None] - 0.5
    return np.asarray(0.5 * np.pi * np.sqrt(np.maximum(1.0 - (middle / i) ** 2, 0.0)))


def mean_compliance(inverse_shape: Array, weight: Array) -> Array:
    """Return B for displacements averaged with the weight of each annulus's own traction."""
    # With W the weights of the force, W B is symmetric (Betti), and the energy books close at every
    # n. For displacements in the middles (33) they do not: friction takes 5 % more than is lost at
    # n = 10. The distribution sqrt(1 - r²/a_i²) of eq. (1) has the Abel transform (a_i² - s²)/a_i,
    # and works add up along s.
    circle = np.arange(1, len(weight) + 1) / len(weight)
    low, high = np.minimum.outer(circle, circle), np.maximum.outer(circle, circle)
    products = 2.0 / 3.0 * low**3 * high**2 - 2.0 / 15.0 * low**5
    works = 0.375 * np.pi**2 * products / np.multiply.outer(circle, circle)
    return np.asarray(inverse_shape.T @ works @ inverse_shape / weight[:, None])


def factors(matrix: Array) -> tuple[Array, Array]:
    """Return L and U of ``matrix`` without pivoting."""
    # For B, n = 1 to 1000, no multiplier exceeds 1: partial pivoting would choose this order.
    # Leading blocks of L^-1 and U^-1 invert the leading blocks of B, so that one factorisation
    # serves every number of stuck annuli.
    size = len(matrix)
    lower, upper = np.eye(size), matrix.copy()
    for k in range(size - 1):
        lower[k + 1 :, k] = upper[k + 1 :, k] / upper[k, k]
        upper[k + 1 :, k:] -= np.multiply.outer(lower[k + 1 :, k], upper[k, k:])
    return lower, np.triu(upper)


def exchange(response: Array, annulus: int) -> Array:
    """Return the response after ``annulus`` (from 0) went from slip to stick or back."""
    # A response M takes x to x M. x holds D, then the lag of each annulus that sticks and the
    # traction of each that slips. x M holds the force, then the traction of each annulus that
    # sticks and the lag of each that slips. The exchange of one unknown is a principal pivot, no
    # new solve.
    k = annulus + 1
    pivot = response[k, k]
    row, column = response[k] / pivot, response[:, k].copy()
    result = response - np.multiply.outer(column, row)
    result[k] = row
    result[:, k] = column / -pivot
    result[k, k] = 1.0 / pivot
    return np.asarray(result)


@lru_cache(maxsize=4)
def tables(annuli: int, mean: bool = False) -> Tables:
    """Return the tables for ``annuli`` annuli, cached."""
    inverse_shape = np.asarray(np.linalg.inv(traction_shape(annuli)), dtype=np.float64)
    ring = 0.5 * np.pi * (np.arange(1, annuli + 1) / annuli) ** 2
    weight: Array = ring @ inverse_shape
    midpoint = 0.5 * influence(annuli) @ inverse_shape
    compliance = mean_compliance(inverse_shape, weight) if mean else midpoint
    lower, upper = factors(compliance)
    responses = []
    if annuli <= LARGEST_TABLE:
        slipping = np.zeros((annuli + 1, annuli + 1))
        slipping[0, 1:] = -1.0  # the lag of a surface that carries no traction: 0 - D
        slipping[1:, 0] = weight
        slipping[1:, 1:] = compliance.T
        responses.append(slipping)
        for stuck in range(annuli):
            responses.append(exchange(responses[stuck], stuck))
    radius_squared = ((np.arange(annuli) + 0.5) / annuli) ** 2
    lower_inverse, upper_inverse = np.tril(np.linalg.inv(lower)), np.triu(np.linalg.inv(upper))
    made = Tables(
        mean,
        radius_squared,
        weight,
        compliance,
        lower_inverse,
        upper_inverse,
        responses,
    )
    for array in (*made[1:-1], *responses):
        array.flags.writeable = False
    return made


@lru_cache(maxsize=512)
def response(annuli: int, mean: bool, sticks: bytes) -> Array:
    """Return the response of any division; ``sticks`` holds a boolean an annulus."""
    # One exchange an annulus leads here from the nearest division with leading annuli stuck.
    # Responses are cached (20 kB each at 50 annuli, 320 kB at 200): divisions recur in steps and
    # impacts.
    stuck = np.frombuffer(sticks, dtype=bool)
    before = np.concatenate([[0], np.cumsum(stuck)])
    nearest = int((np.arange(annuli + 1) - 2 * before).argmin())
    matrix = tables(annuli, mean).responses[nearest]
    for annulus in np.flatnonzero(stuck != (np.arange(annuli) < nearest)):
        matrix = exchange(matrix, int(annulus))
    return matrix
