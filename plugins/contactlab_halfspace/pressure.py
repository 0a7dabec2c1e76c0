"""The pressure of a contact: prescribed by the normal motion, or an answer to the traction."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab.numeric.types import Array
from contactlab_halfspace.instants import Instants
from contactlab_halfspace.modes import SPARE, Modes


class Contact(NamedTuple):
    """The contact at the end of a step.

    Attributes
    ----------
    rings : int
        Rings within which there may be traction.
    limit : array, shape (rings,), or None
        Coulomb's limit over mu; None if pressure answers to traction.
    load : float
        Force of ``limit``.
    dragged : array, shape (2, 1, all rings), or float
        Displacement that the pressure drags the surfaces by.
    depth : array, shape (rings,), or float
        Normal displacement of surfaces that touch, for a force of 0.
    yielding : float
        Approach that a force of 1 takes away by the end of the step.
    """

    rings: int
    limit: Array | None
    load: float
    dragged: Array | float = 0.0
    depth: Array | float = 0.0
    yielding: float = 0.0


class Prescribed:
    """Pressure that friction does not change: the hemispheres of a normal motion.

    Parameters
    ----------
    table : Modes
    course : Instants
        Normal motion of one impact.
    stiffness : float
        Unit of force times that of time over M_n v1; 5/4 for elastic Hertz contacts.
    """

    def __init__(self, table: Modes, course: Instants, stiffness: float) -> None:
        self.table, self.course, self.stiffness = table, course, stiffness
        self.duration = np.diff(course.time[:, 0])
        self._impulse = np.diff(course.impulse[:, 0])

    def impulse(self, k: int) -> float:
        """Return the impulse of the friction load in step ``k``, foreseen before it is taken."""
        return float(self._impulse[k - 1])

    def contact(self, k: int) -> Contact | None:
        """Return the contact at the end of step ``k``; None out of contact."""
        course = self.course
        number, pressure = int(course.inside[k]), float(course.pressure[k, 0])
        if number == 0 or pressure <= 0.0:
            return None
        edges, points = self.table.basis.edges, self.table.points
        outer = pressure * float(course.share[k])
        inner = pressure - outer
        limit, load = outer * _hemisphere(edges[number], points), outer * edges[number] ** 3
        dragged = outer * self.table.drags[number - 1]
        if number > 1:
            limit = limit + inner * _hemisphere(edges[number - 1], points)
            load += inner * edges[number - 1] ** 3
            dragged = dragged + inner * self.table.drags[number - 2]
        return Contact(number, limit[:number], float(load), dragged)

    def advance(self, k: int, force: float) -> float:
        """Take step ``k``, which ends with this force; return its impulse."""
        return self.impulse(k)


class Answering(Prescribed):
    """Pressure over the surfaces as traction deforms them, with the normal motion that follows.

    Approach and rate are those of the elastic Hertz contact, and departures from them. The
    departures obey Newton's law with the force less Hertz's, which is linear in time in a step.

    Attributes
    ----------
    approach, rate, excess : array, shape (K + 1,)
        Departures of approach, rate and force.
    """

    def __init__(self, table: Modes, course: Instants, stiffness: float) -> None:
        super().__init__(table, course, stiffness)
        self.approach, self.rate, self.excess = np.zeros((3, len(course.inside)))

    def impulse(self, k: int) -> float:
        """Return the impulse of the step, with the excess of force at its start."""
        more = self.stiffness * self.duration[k - 1] * self.excess[k - 1]
        return super().impulse(k) + float(more)

    def contact(self, k: int) -> Contact | None:
        """Return the contact; None where the surfaces have parted."""
        square, radius = self._square(k), float(self.course.radius[k])
        whole = radius**2 + self._approach(k, 0.0)
        if radius == 0.0 or whole <= 0.0:
            return None
        edges, points = self.table.basis.edges, self.table.points
        number = min(int(np.searchsorted(edges, radius * (1.0 + SPARE))) + 1, len(points))
        depth = whole + square * radius**3 - 0.5 * points[:number] ** 2
        return Contact(number, None, radius**3, 0.0, depth, square)

    def _square(self, k: int) -> float:
        """Return the departure of the approach for an excess of force of 1 at the end."""
        return self.stiffness * float(self.duration[k - 1]) ** 2 / 6.0

    def _approach(self, k: int, excess: float) -> float:
        """Return the departure of the approach after step ``k``."""
        duration = self.duration[k - 1]
        gone = self.approach[k - 1] + duration * self.rate[k - 1]
        return float(gone - self._square(k) * (2.0 * self.excess[k - 1] + excess))

    def advance(self, k: int, force: float) -> float:
        """Take step ``k``; return the impulse of its force."""
        excess = force - float(self.course.radius[k]) ** 3
        duration = self.duration[k - 1]
        more = self.stiffness * 0.5 * duration * (self.excess[k - 1] + excess)
        self.approach[k] = self._approach(k, excess)
        self.rate[k] = self.rate[k - 1] - more
        self.excess[k] = excess
        return float(super().impulse(k) + more)


def _hemisphere(edge: float, points: Array) -> Array:
    """Return sqrt(edge² - points²), 0 outside."""
    return np.asarray(np.sqrt(np.maximum(edge**2 - points**2, 0.0)))
