"""The oscillator x' = V, V' = -x - 2 beta V from x = 0, V = 1 until x + 2 beta V = 0.

Theory §11. A linear spring and dashpot is this oscillator in time, Tsuji's law in a time of its
own. Every formula is one of arccos(beta), which goes on into arcosh beyond critical damping. The
restitution is eq. (15) of Schwager & Pöschel, Granular Matter 9 (2007) 465-469,
doi:10.1007/s10035-007-0065-z, in one piece.
"""

from __future__ import annotations

import math
from functools import lru_cache

import attrs
import numpy as np

from contactlab.numeric.types import Real
from contactlab_laws.calibrated import root


def half_duration(damping: float) -> float:
    """Return arccos(beta)/sqrt(1 - beta²): the time to x_max, half the duration."""
    square = (1.0 - damping) * (1.0 + damping)
    if square == 0.0:
        return 1.0
    if square < 0.0:
        return math.acosh(damping) / math.sqrt(-square)
    return math.acos(damping) / math.sqrt(square)


def restitution(damping: float) -> float:
    """Return e = exp(-2 beta arccos(beta)/sqrt(1 - beta²))."""
    return math.exp(-2.0 * damping * half_duration(damping))


@lru_cache(maxsize=256)
def damping_of(coefficient: float) -> float:
    """Return beta at a coefficient of restitution: below e^-½, because e < 1/beta²."""
    wanted = -0.5 * math.log(coefficient)
    if wanted == 0.0:
        return 0.0
    return root(lambda beta: beta * half_duration(beta) - wanted, 0.0, coefficient**-0.5)


@attrs.frozen
class Oscillator:
    """The motion, over its own time.

    Attributes
    ----------
    damping : float
        beta.
    """

    damping: float

    @property
    def duration(self) -> float:
        """The time at which x + 2 beta V comes to zero."""
        return 2.0 * half_duration(self.damping)

    @property
    def restitution(self) -> float:
        """Minus V at the end; x is sqrt(e) at most, and 2 beta e at the end."""
        return restitution(self.damping)

    def at(self, time: Real) -> tuple[Real, Real, Real]:
        """Return x, V and x + 2 beta V; the first and the last are never negative."""
        beta = self.damping
        square = (1.0 - beta) * (1.0 + beta)
        frequency = abs(square) ** 0.5
        if square > 0.0:
            sine, cosine = np.sin(frequency * time) / frequency, np.cos(frequency * time)
        elif square < 0.0:
            sine, cosine = np.sinh(frequency * time) / frequency, np.cosh(frequency * time)
        else:
            sine, cosine = time, 1.0 + 0.0 * time
        decay = np.exp(-beta * time)
        pull = (1.0 - 2.0 * beta * beta) * sine + 2.0 * beta * cosine
        x, rate = decay * sine, decay * (cosine - beta * sine)
        return np.maximum(x, 0.0), rate, np.maximum(decay * pull, 0.0)
