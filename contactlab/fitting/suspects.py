"""Measured numbers that look like a slip of the pen: a sign, or a single impact."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Cosine between measured and predicted numbers below which they have opposite signs.
OPPOSITE = -0.5
#: Residuals further from their median than this are no scatter: in numbers of standard errors of
#: normal scatter, which a fit of a thousand impacts would not show.
FAR = 6.0
#: The median absolute deviation of normal scatter is this much smaller than its standard error.
NORMAL = 1.4826
#: A larger share of the impacts is no slip of the pen.
FEW = 0.1
#: Fewer numbers say too little of their scatter.
LEAST = 8


def suspects(measured: Mapping[str, Array], predicted: Mapping[str, Array]) -> list[str]:
    """Return a sentence for each quantity of the wrong sign, and each impact far off the others.

    Parameters
    ----------
    measured, predicted : mapping of str to array, shape (n,)
        By quantity; NaN where it was not measured.
    """
    found = []
    for name, values in measured.items():
        there = np.isfinite(values)
        if _opposite(values[there], predicted[name][there]):
            found.append(
                f"{name}: measured and computed numbers have opposite signs, so that the fit says "
                "nothing; what has a direction needs its sign: contactlab guide units-and-signs"
            )
            continue
        rows = np.flatnonzero(there)
        residuals = values[there] - predicted[name][there]
        far = _far(residuals)
        if len(far) > max(1.0, FEW * len(rows)):
            found.append(
                f"{name}: {len(far)} of {len(rows)} impacts are off by more than {FAR:.0f} times "
                "the scatter of the others: the law may not hold for them"
            )
            continue
        found += [
            f"{name}: impact {rows[place] + 1} is off by {residuals[place]:.3g}, {times:.0f} times "
            "the scatter of the others; # before its line leaves it out"
            for place, times in far
        ]
    return found


def _opposite(measured: Array, predicted: Array) -> bool:
    size = float(np.linalg.norm(measured) * np.linalg.norm(predicted))
    return size > 0.0 and float(measured @ predicted) < OPPOSITE * size


def _far(residuals: Array) -> list[tuple[int, float]]:
    """Return the places of residuals far from their median, and how far, the farthest first."""
    if len(residuals) < LEAST:
        return []
    off = np.abs(residuals - np.median(residuals))
    scatter = NORMAL * float(np.median(off))
    places = np.argsort(-off)
    return [(int(at), float(off[at] / scatter)) for at in places if off[at] > FAR * scatter > 0.0]
