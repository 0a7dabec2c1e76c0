"""The F test of terms added to a linearised fit."""

from __future__ import annotations

import math

import numpy as np

from contactlab.numeric.types import Array

#: Least degrees of freedom beside the parameters and the added terms.
SPARE = 3
#: Outliers and patterns are reported if normal scatter makes them with less than this chance.
CHANCE = 1e-3
#: Scatter below this share of the largest number is numerical error.
NUMERICAL = 1e-4
#: Share of a term's square across the slopes that rounding alone may leave.
ROUNDING = 1e-10


def chance_of(residuals: Array, slopes: Array, terms: Array, least: float) -> float:
    """Return the chance that normal scatter follows ``terms``, shape (numbers, m), as closely."""
    from scipy.special import fdtrc  # only a fit needs scipy

    added = terms.shape[1]
    freedom = len(residuals) - slopes.shape[1] - added
    if freedom < SPARE:
        return 1.0
    plain = _remaining_square(residuals, slopes)
    curved = _remaining_square(residuals, np.hstack([slopes, terms]))
    ratio = (plain - curved) / added / (curved / freedom + least + np.finfo(float).tiny)
    return float(fdtrc(added, freedom, max(ratio, 0.0)))


def log_chance(count: int, freedom: int, ratio: float) -> float:
    """Return the logarithm of the chance that F exceeds a ratio, where the chance underflows too.

    Notes
    -----
    The chance is the incomplete beta function I_x(a, b), x = freedom/(freedom + count ratio), a =
    freedom/2, b = count/2: its power series begins with x^a (1 - x)^b / (a B(a, b)), and is bounded
    by a geometric one. DLMF 8.17.8, https://dlmf.nist.gov/8.17#E8
    """
    from scipy.special import betaln, fdtrc  # only a fit needs scipy

    chance = float(fdtrc(count, freedom, ratio))
    if chance > np.finfo(float).tiny:
        return math.log(chance)
    a, b = 0.5 * freedom, 0.5 * count
    x = a / (a + b * ratio)
    first = a * math.log(x) + b * math.log1p(-x) - math.log(a) - float(betaln(a, b))
    return first - math.log1p(-min(x * (a + b) / (a + 1.0), 1.0 - 1e-9))


def chances_of_each(
    residuals: Array, slopes: Array, products: Array, squares: Array, along: Array, least: float
) -> Array:
    """Return ``chance_of`` of each of many single terms, shape (terms,), from their sums.

    Parameters
    ----------
    residuals, slopes : array
        As those of ``chance_of``.
    products : array, shape (terms,)
        Inner products of each term and the residuals less their projection on the slopes.
    squares : array, shape (terms,)
        Inner product of each term with itself.
    along : array, shape (terms, parameters)
        Inner products of each term and the ``orthonormal`` slopes.
    least : float
    """
    from scipy.special import fdtrc  # only a fit needs scipy

    freedom = len(residuals) - slopes.shape[1] - 1
    if freedom < SPARE:
        return np.ones(len(squares))
    plain = _remaining_square(residuals, slopes)
    across = squares - np.sum(along**2, axis=1)
    new = across > ROUNDING * squares  # the slopes already span the others
    gains = np.where(new, products**2 / np.where(new, across, 1.0), 0.0)
    ratios = gains / ((plain - gains) / freedom + least + np.finfo(float).tiny)
    return np.asarray(fdtrc(1, freedom, np.maximum(ratios, 0.0)))


def remaining(residuals: Array, basis: Array) -> Array:
    """Return residuals less their projection on an orthonormal basis."""
    return np.asarray(residuals - basis @ (basis.T @ residuals))


def _remaining_square(residuals: Array, columns: Array) -> float:
    """Return the sum of squares of residuals after projection on columns."""
    rest = remaining(residuals, orthonormal(columns))
    return float(rest @ rest)


def orthonormal(columns: Array) -> Array:
    """Return an orthonormal basis of the non-zero columns."""
    lengths = np.linalg.norm(columns, axis=0)
    return np.asarray(np.linalg.qr(columns[:, lengths > 0.0] / lengths[lengths > 0.0])[0])
