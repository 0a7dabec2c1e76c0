"""The bundle of springs: positions s at which a law keeps w(s), and its geometry in a step."""

from __future__ import annotations

from abc import ABC, abstractmethod
from bisect import bisect_left
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.checks import Real

Array = NDArray[np.float64]


class Bundle(ABC):
    """Springs along the contact radius, with weights that give the force; never changed.

    Parameters
    ----------
    positions : array, shape (n,)
        s of each spring over the largest contact radius, ascending, below 1.
    full_weights : array, shape (n,)
        Weights of 1.5 times the integral of w over the largest contact.

    Attributes
    ----------
    squares : array, shape (n,)
        s²; ``squares_listed`` is the same as a list.
    full_weights : array, shape (n,)
    """

    def __init__(self, positions: Array, full_weights: Array) -> None:
        self.squares = positions * positions
        self.squares_listed = self.squares.tolist()
        self.full_weights = full_weights
        for array in (self.squares, self.full_weights):
            array.flags.writeable = False

    @abstractmethod
    def weights(self, square: Array) -> Array:
        """Return weights of F in w, shape (n, K), for contacts of b² = ``square``, shape (K,)."""
        # They hold for the springs in contact; gross slip must give F = b³ with them.

    @abstractmethod
    def weights_of_one(self, square: float, touching: int) -> Array:
        """Return the weights of the innermost springs of one contact, shape (touching,)."""

    def limit_factor(self, square: Real) -> Real:
        """Return the factor on the limits for which gross slip gives b³; by default 1."""
        return 1.0


class Geometry(NamedTuple):
    """One step of the springs that touch at its end in some impact.

    K is the number of impacts, or 1 where all have the same contact.

    Attributes
    ----------
    throughout : int
        Innermost springs that touch through the whole step in every impact.
    part : array, shape (touching - throughout, K)
        Part of the step for which the other springs touch.
    limit : array, shape (touching, K)
        l at the end of the step, zero out of contact.
    weights : array, shape (touching,) or (touching, K)
        Weights of the force.
    """

    throughout: int
    part: Array
    limit: Array
    weights: Array


def of_one(bundle: Bundle, before: float, after: float, pressure: Real) -> Geometry:
    """Return the geometry where one contact serves all impacts; ``before``, ``after`` are b²."""
    touching = bisect_left(bundle.squares_listed, after)
    compression = after - bundle.squares[:touching, None]
    throughout = bisect_left(bundle.squares_listed, before) if after > before else touching
    part = compression[throughout:]
    if throughout < touching:
        part = np.minimum(part / (after - before), 1.0)
    limit = (pressure * bundle.limit_factor(after)) * compression
    return Geometry(throughout, part, limit, bundle.weights_of_one(after, touching))


def of_each(bundle: Bundle, before: Real, after: Array, pressure: Real) -> Geometry:
    """Return the geometry of contacts that differ; ``before``, ``after`` are b², shape (K,)."""
    # While b grows, a spring that the contact meets in the step moves with the surfaces only from
    # then on; without this the error would be of first order. b² is taken as linear in the step.
    touching = int(bundle.squares.searchsorted(after.max()))  # n for NaN
    throughout = min(touching, int(bundle.squares.searchsorted(np.min(before))))
    compression = after - bundle.squares[:touching, None]
    growth = after - before
    grows = growth > 0.0
    part = np.clip(compression[throughout:] / np.where(grows, growth, 1.0), 0.0, 1.0)
    outside = bundle.full_weights[:touching, None]
    weights = np.where(compression > 0.0, bundle.weights(after)[:touching], outside)
    limit = (pressure * bundle.limit_factor(after)) * np.maximum(compression, 0.0)
    return Geometry(throughout, np.where(grows, part, 1.0), limit, weights)


def spring_fields(radius: Any, deflection: Any, limit: Any, *, metres: Any = 1.0) -> dict[str, Any]:
    """Return the fields of springs, w and l in units of ``metres``, all of one shape."""
    slips = (limit > 0.0) & (np.abs(deflection) >= limit)
    return {
        "radius": radius,
        "displacement": metres * deflection,
        "limit": metres * limit,
        "stuck": (limit > 0.0) & ~slips,
        "slipping": (slips * np.sign(deflection)).astype(np.int8),
    }
