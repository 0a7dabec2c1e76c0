"""The F test of terms added to a linearised fit."""

from __future__ import annotations

import numpy as np

from contactlab.numeric.types import Array

#: Least degrees of freedom beside the parameters and the added terms.
SPARE = 3
#: Outliers and patterns are reported if normal scatter makes them with less than this chance.
CHANCE = 1e-3
#: Scatter below this share of the largest number is numerical error.
NUMERICAL = 1e-4


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


def _remaining_square(residuals: Array, columns: Array) -> float:
    """Return the sum of squares of residuals after projection on columns."""
    basis = orthonormal(columns)
    remaining = residuals - basis @ (basis.T @ residuals)
    return float(remaining @ remaining)


def orthonormal(columns: Array) -> Array:
    """Return an orthonormal basis of the non-zero columns."""
    lengths = np.linalg.norm(columns, axis=0)
    return np.asarray(np.linalg.qr(columns[:, lengths > 0.0] / lengths[lengths > 0.0])[0])
