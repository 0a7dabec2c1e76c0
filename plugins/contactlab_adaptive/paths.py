"""The normal motion as the adaptive integrator tries it: one whole leg against two half legs."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts import ClosedFormMotion, NormalContact


class Leg(NamedTuple):
    """A stretch of time with the contact sampled inside it.

    ``lead`` and ``tail`` are the times before and after the sample, ``kick`` is their sum, all
    in s; ``normal_force`` is the mean of P over the leg.
    """

    contact: NormalContact
    lead: float
    tail: float
    kick: float
    normal_force: float
    time: float
    approach: float
    rate: float

    @property
    def sound(self) -> bool:
        """Whether the law may be asked: under an infinite force one with a cap would have none."""
        numbers = (self.contact.force, self.contact.overlap, self.lead, self.kick)
        return all(map(math.isfinite, numbers)) and math.isfinite(self.normal_force)


class Trial(NamedTuple):
    """A step tried in two ways.

    ``error`` is how far the two ways part in the normal motion, over its scale; ``place``
    is where the two half legs end, and ``ended`` says that the contact has ended there.
    """

    whole: Leg
    halves: tuple[Leg, Leg]
    place: Any
    error: float
    ended: bool


class NormalPath(ABC):
    """Where the normal motion stands is a value, ``place``; trying a step changes nothing."""

    #: Length of the whole path in the units of a step; None if it is not known beforehand.
    length: float | None

    @abstractmethod
    def begin(self) -> Any:
        """Return the place at first touch."""

    @abstractmethod
    def attempt(self, place: Any, step: float) -> Trial:
        """Try a step."""

    @abstractmethod
    def end(self, place: Any) -> tuple[float, float]:
        """Return (time, rate) at ``place``."""


class ClosedPath(NormalPath):
    """A motion in closed form; a step is one of its phase. Place: (phase, time, rate)."""

    length = math.pi

    def __init__(self, motion: ClosedFormMotion, mass: float) -> None:
        self.motion, self.mass = motion, mass

    def begin(self) -> tuple[float, float, float]:
        """Return phase 0."""
        return 0.0, 0.0, float(np.asarray(self.motion.at(0.0)[2]))

    def attempt(self, place: Any, step: float) -> Trial:
        """Try a step of the phase, cut off at pi."""
        x, start, rate = place
        stop = min(x + step, math.pi)
        if math.pi - stop < 1e-12:
            stop = math.pi
        part = 0.25 * (stop - x)
        phases = np.array([x + part, x + 2.0 * part, x + 3.0 * part, stop])
        *moving, contact = self.motion.at(phases)
        # Plain floats, which are faster one by one; the start of the step goes before them.
        befores = (start, math.nan, rate)
        times, approaches, rates = (
            [before, *_listed(column)] for before, column in zip(befores, moving, strict=True)
        )
        contacts = [NormalContact(*row) for row in zip(*map(_listed, contact), strict=True)]

        def leg(first: int, middle: int, last: int) -> Leg:
            kick = times[last] - times[first]
            if not kick > 0.0:  # time stands still, or is NaN
                kick = math.nan
            return Leg(
                contacts[middle - 1],
                times[middle] - times[first],
                times[last] - times[middle],
                kick,
                self.mass * (rates[first] - rates[last]) / kick,
                times[middle],
                approaches[middle],
                rates[middle],
            )

        halves = leg(0, 1, 2), leg(2, 3, 4)
        return Trial(leg(0, 2, 4), halves, (stop, times[4], rates[4]), 0.0, stop == math.pi)

    def end(self, place: Any) -> tuple[float, float]:
        """Return (time, rate)."""
        return place[1], place[2]


def _listed(column: Any) -> list[float]:
    listed: list[float] = np.asarray(column).tolist()
    return listed
