"""The bundle of springs: positions s at which a law keeps w(s), and weights of its integral."""

from __future__ import annotations

from abc import ABC, abstractmethod

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
