"""The pressure of a contact: prescribed by the normal motion, or an answer to the traction."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Real
from contactlab_halfspace.instants import Instants
from contactlab_halfspace.modes import SPARE, Modes


class Contact(NamedTuple):
    """The contacts of the impacts that touch at the end of a step.

    Attributes
    ----------
    touching : array of bool, shape (impacts,)
        Which impacts these are.
    rings : int
        Rings within which there may be traction.
    limit : array, shape (impacts that touch, rings), or None
        Coulomb's limit over mu; None if pressure answers to traction.
    load : array, shape (impacts that touch,), or float
        Force of ``limit``.
    dragged : array, shape (impacts, 2, 1, all rings), or float
        Displacement that the pressure drags the surfaces by.
    depth : array, shape (impacts that touch, 1, 1, rings), or float
        Normal displacement of surfaces that touch, for a force of 0.
    yielding : array, shape (impacts that touch,), or float
        Approach that a force of 1 takes away by the end of the step.
    """

    touching: NDArray[np.bool_]
    rings: int
    limit: Array | None
    load: Real
    dragged: Real = 0.0
    depth: Real = 0.0
    yielding: Real = 0.0


class Prescribed:
    """Pressure that friction does not change: the hemispheres of normal motions.

    Parameters
    ----------
    table : Modes
    course : Instants
        Normal motions of the impacts, with columns of their own.
    stiffness : array, shape (impacts,)
        Unit of force times that of time over M_n v1; 5/4 for elastic Hertz contacts.
    """

    def __init__(self, table: Modes, course: Instants, stiffness: Array) -> None:
        self.table, self.course, self.stiffness = table, course, stiffness
        self.duration = np.diff(course.time, axis=0)
        self._impulse = np.diff(course.impulse, axis=0)

    def impulse(self, k: int) -> Array:
        """Return the impulses of the friction load in step ``k``, foreseen before it is taken."""
        return np.asarray(self._impulse[k - 1])

    def contact(self, k: int) -> Contact | None:
        """Return the contacts at the end of step ``k``; None if no impact touches."""
        course = self.course
        number, pressure = int(course.inside[k]), course.pressure[k]
        touching = pressure > 0.0
        if not (number and touching.any()):
            return None
        edges, points = self.table.basis.edges, self.table.points
        outer = np.maximum(pressure, 0.0) * float(course.share[k])
        inner = np.maximum(pressure, 0.0) - outer
        limit = np.multiply.outer(outer, _hemisphere(edges[number], points))
        load = outer * edges[number] ** 3
        dragged = np.multiply.outer(outer, self.table.drags[number - 1])
        if number > 1:
            limit += np.multiply.outer(inner, _hemisphere(edges[number - 1], points))
            load += inner * edges[number - 1] ** 3
            dragged += np.multiply.outer(inner, self.table.drags[number - 2])
        return Contact(touching, number, limit[touching, :number], load[touching], dragged)

    def advance(self, k: int, force: Array) -> Array:
        """Take step ``k``, which ends with these forces; return its impulses."""
        return self.impulse(k)


class Answering(Prescribed):
    """Pressure over the surfaces as traction deforms them, with the normal motion that follows.

    Approach and rate are those of the elastic Hertz contact, and departures from them. The
    departures obey Newton's law with the force less Hertz's, which is linear in time in a step.

    Attributes
    ----------
    approach, rate, excess : array, shape (K + 1, impacts)
        Departures of approach, rate and force.
    """

    def __init__(self, table: Modes, course: Instants, stiffness: Array) -> None:
        super().__init__(table, course, stiffness)
        self.approach, self.rate, self.excess = np.zeros((3, *course.time.shape))

    def impulse(self, k: int) -> Array:
        """Return the impulses of the step, with the excess of force at its start."""
        more = self.stiffness * self.duration[k - 1] * self.excess[k - 1]
        return np.asarray(super().impulse(k) + more)

    def contact(self, k: int) -> Contact | None:
        """Return the contacts; None where all surfaces have parted."""
        radius = float(self.course.radius[k])
        whole = radius**2 + self._approach(k, 0.0)
        touching = whole > 0.0
        if not (radius and touching.any()):
            return None
        edges, points = self.table.basis.edges, self.table.points
        number = min(int(np.searchsorted(edges, radius * (1.0 + SPARE))) + 1, len(points))
        whole, square = whole[touching], self._square(k)[touching]
        depth = (whole + square * radius**3)[:, None, None, None] - 0.5 * points[:number] ** 2
        return Contact(touching, number, None, radius**3, 0.0, depth, square)

    def _square(self, k: int) -> Array:
        """Return the departures of the approach for an excess of force of 1 at the end."""
        return np.asarray(self.stiffness * self.duration[k - 1] ** 2 / 6.0)

    def _approach(self, k: int, excess: Real) -> Array:
        """Return the departures of the approach after step ``k``."""
        gone = self.approach[k - 1] + self.duration[k - 1] * self.rate[k - 1]
        return np.asarray(gone - self._square(k) * (2.0 * self.excess[k - 1] + excess))

    def advance(self, k: int, force: Array) -> Array:
        """Take step ``k``; return the impulses of its forces."""
        excess = force - float(self.course.radius[k]) ** 3
        more = self.stiffness * 0.5 * self.duration[k - 1] * (self.excess[k - 1] + excess)
        self.approach[k] = self._approach(k, excess)
        self.rate[k] = self.rate[k - 1] - more
        self.excess[k] = excess
        return np.asarray(super().impulse(k) + more)


def _hemisphere(edge: float, points: Array) -> Array:
    """Return sqrt(edge² - points²), 0 outside."""
    return np.asarray(np.sqrt(np.maximum(edge**2 - points**2, 0.0)))
