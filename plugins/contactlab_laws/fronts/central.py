"""The central impact: the path of one whose normal motion is a sphere's, in stretches."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Generator, Iterator, Mapping
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import ClosedFormMotion, LostPathError, ScaledContact, Stretch
from contactlab.numeric.types import Array
from contactlab_laws.fronts.path import Answer, Impact, Part, Request
from contactlab_laws.fronts.phases import STICK, Phase
from contactlab_laws.fronts.series import Rows
from contactlab_laws.fronts.steps import alone, error_of_step
from contactlab_laws.hertz.motion import velocity_factor

#: Rings in which stick and slip are shown; the solution itself knows no rings.
RINGS = 200
#: From the phase to the variable of a series: moves of Newton's method, kept between bounds, at
#: most; how far the phase may then be off; and where in a step it is known for a first guess.
INVERSIONS, ON_PHASE, GUESSES = 50, 2e-15, np.linspace(0.0, 1.0, 17)
#: Steps of an impact, about half a second; below OFTEN in chi it is not oscillation that takes so
#: many.
MOST_STEPS, OFTEN = 3000, 1e3


@attrs.frozen(eq=False)
class FrontStretch(Stretch):
    """A stretch within whose ``front`` all sticks, and outside which all slips one way."""

    sign: int
    start: float
    stop: float
    change: float
    work: float
    solves: int

    @abstractmethod
    def front(self, contact: ScaledContact) -> float:
        """Return the radius of the front at one instant."""

    def fields(
        self, normal: ClosedFormMotion, contact: ScaledContact, factor: float
    ) -> Mapping[str, NDArray[Any]]:
        """Return rings of equal width: radius (m), stuck, and the sign of slipping traction.

        ``front`` (m) is the radius within which the contact sticks.
        """
        ring, largest = (np.arange(RINGS) + 0.5) / RINGS, float(normal.maximum_radius)
        front = self.front(contact)
        touching, inside = ring < contact.radius, ring < front
        shown = self.sign if factor > 0.0 else -self.sign
        return {
            "radius": largest * ring,
            "front": np.array(largest * front),
            "stuck": touching & inside,
            "slipping": np.where(touching & ~inside, shown, 0).astype(np.int8),
        }


class Step(NamedTuple):
    """Series of u, V, k, J and the front to ``length``, where the phase is ``stop``.

    ``before`` is the change of velocity where they begin.
    """

    stop: float
    sign: int
    rows: list[list[float]]
    length: float
    before: float

    def at(self, phase: Array) -> Array:
        """Return change, J and the front at each phase, by Newton's method for the variable."""
        rows = np.array(self.rows)
        slopes = np.zeros((2, rows.shape[1]))
        slopes[:, :-1] = rows[:2, 1:] * np.arange(1.0, rows.shape[1])
        table = np.vstack([rows, slopes])

        def look(t: Array) -> tuple[Array, Array]:
            """Return the series and the slopes of u and V, and the phase."""
            values = table @ np.vander(t, rows.shape[1], increasing=True).T
            u = np.maximum(values[0], 0.0)
            return values, np.arctan2(u, values[1] / velocity_factor(u))

        known = self.length * GUESSES
        t = np.interp(phase, look(known)[1], known)
        low, high = np.zeros_like(t), np.full_like(t, self.length)
        for _ in range(INVERSIONS):
            values, here = look(t)
            over = here - phase
            if np.abs(over).max() < ON_PHASE:
                break
            u, rate = np.maximum(values[0], 0.0), values[1]
            # u' = V x' and V' = -2.5 u⁴ x', where the phase grows by g(u) times x (theory §3)
            steep = np.abs(rate) > 0.5
            slope, pace = np.where(steep, values[5], values[6]), np.where(steep, rate, -2.5 * u**4)
            low, high = np.where(over > 0.0, low, t), np.where(over > 0.0, t, high)
            with np.errstate(all="ignore"):
                new = t - over * pace / (velocity_factor(u) * slope)
            t = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
        change = self.before + self.sign * (values[1] - values[2] - (rows[1, 0] - rows[2, 0]))
        return np.vstack([change, values[3:5]])


@attrs.frozen(eq=False)
class SeriesStretch(FrontStretch):
    """Stick, or slip at the edge, in steps; ``least`` is the most negative change possible."""

    steps: list[Step]
    least: float

    def _at(self, phase: Array) -> Array:
        """Return change, J and the front at each phase."""
        which = np.searchsorted([step.stop for step in self.steps[:-1]], phase)
        columns = np.empty((3, phase.size))
        for index in np.unique(which).tolist():
            columns[:, which == index] = self.steps[index].at(phase[which == index])
        return columns

    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return (change of velocity since first touch, force)."""
        change, lack, _ = self._at(contact.phase)
        return np.clip(change, self.least, 0.0), self.sign * (contact.force - 1.5 * lack)

    def front(self, contact: ScaledContact) -> float:
        """Return the radius of the front at one instant."""
        return max(0.0, float(self._at(np.array([contact.phase]))[2, 0]))


@attrs.frozen(eq=False)
class GrossStretch(FrontStretch):
    """Gross slip: psi falls in proportion to V, under Coulomb's force.

    ``ratio`` is 2 chi; ``before`` and ``rate`` are change of velocity and V where it begins.
    """

    before: float
    rate: float
    ratio: float

    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return (change of velocity since first touch, force)."""
        gone = (self.sign * self.ratio) * (self.rate - contact.rate)
        return self.before - gone, self.sign * contact.force

    def front(self, contact: ScaledContact) -> float:
        """Return 0: the front is at the centre."""
        return 0.0


class CentralImpact(Impact):
    """An impact of spheres that keeps its stretches, one for each part of its path."""

    def __init__(self, psi1: float, chi: float) -> None:
        super().__init__(psi1, chi)
        self.psi1, self.phase, self.solves = psi1, 0.0, 0
        self.kept: list[Step] = []
        self.stretches: list[FrontStretch] = []

    def keep(self, phase: Phase, rows: Rows, length: float, last: tuple[float, ...]) -> None:
        """Keep a step."""
        psi = rows[1][0] - rows[2][0] - (self.rate - self.margin)
        stop = math.atan2(max(last[0], 0.0), last[1] / velocity_factor(max(last[0], 0.0)))
        shown = [*rows[:4], rows[0] if phase is STICK else rows[4]]
        before = self.change + self.sign * psi
        self.kept.append(Step(stop, self.sign, shown, length, before))

    def _known(self, sign: int, stop: float) -> tuple[int, float, float, float, float, int]:
        """Return what stretches have in common, and go on to the end of one."""
        start, self.phase = self.phase, max(self.phase, stop)
        # The energy of slip never exceeds that at first touch, rounding of a small psi1 apart.
        change = min(max(self.change, -2.0 * self.psi1), 0.0)
        self.solves += len(self.kept)
        return sign, start, self.phase, change, self.work, self.solves

    def _along(
        self, phase: Phase, own: tuple[float, ...] = (), constants: tuple[float, ...] = ()
    ) -> Generator[Request, Answer, tuple[int, tuple[float, ...]]]:
        ended = yield from super()._along(phase, own, constants)
        self.end_stretch()
        return ended

    def end_stretch(self) -> None:
        """Make a stretch of the steps kept so far, if there are any."""
        if self.kept:
            known = self._known(self.sign, self.kept[-1].stop)
            self.stretches.append(SeriesStretch(*known, self.kept, -2.0 * self.psi1))
            self.kept = []

    def _gross(self) -> Part:
        sign, before, rate = self.sign, self.change, self.rate
        after = yield from super()._gross()
        known = self._known(sign, math.atan2(self.radius, self.rate / velocity_factor(self.radius)))
        self.stretches.append(GrossStretch(*known, before, rate, 2.0 * self.numbers[0]))
        return after


def stretches(
    velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
) -> Iterator[Stretch]:
    """Yield the stretches of one impact, from psi and 2.5 chi at first touch."""
    chi = 0.5 * inertia * motion.scaled_mass
    impact = CentralImpact(velocity, chi)
    error = error_of_step(tolerance) * min(1.0, velocity)
    reason = alone(impact, error, MOST_STEPS, impact.keep)
    impact.end_stretch()  # of an impact that is lost, for its history so far
    yield from impact.stretches
    if reason:
        why = f"at chi = {chi:.3g} the contact oscillates about sqrt(chi) times"
        if chi < OFTEN:
            why = "slip changes too often, or stick is lost within too short a time"
        raise LostPathError(
            f"More than {MOST_STEPS} panels would be needed: {why}. A law of steps, such as "
            "springs under symplectic, can go on, with the error of its steps."
        )
