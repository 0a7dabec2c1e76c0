"""Where a law keeps w(s), and how it integrates."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from contactlab.checks import Real

Array = NDArray[np.float64]


class Places(ABC):
    """Places s along the contact radius with rules for the force; made once, never changed.

    Attributes
    ----------
    squares : array, shape (n,)
        s², ascending, below 1.
    measure : array, shape (n,)
        Weights of 1.5 times the integral over the largest contact.
    """

    def __init__(self, positions: Array, measure: Array) -> None:
        self.squares = positions * positions
        self.listed = self.squares.tolist()
        self.measure = measure
        for array in (self.squares, self.measure):
            array.flags.writeable = False

    @abstractmethod
    def weights(self, square: Array) -> Array:
        """Return weights of F in w, shape (n, K), for contacts of b² = ``square``, shape (K,).

        They hold for the places in contact; gross slip must give F = b³ with them.
        """

    @abstractmethod
    def weights_within(self, square: float, reach: int) -> Array:
        """Return the same for one contact, of its ``reach`` places only."""

    def lift(self, square: Real) -> Real:
        """Return the factor on the limits for which gross slip gives b³: 1 if the weights do."""
        return 1.0
