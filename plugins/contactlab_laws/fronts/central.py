"""The path of an impact with the normal motion of spheres, in stretches."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import ClosedFormMotion, LostPathError, ScaledContact, Stretch
from contactlab.numeric.types import Array
from contactlab_laws.fronts.steps import Steps, error_of_step, follow_one
from contactlab_laws.hertz.motion import velocity_factor

#: Rings in which stick and slip are shown; the solution itself knows no rings.
RINGS = 200
#: From the contact to the variable of a series: moves of Newton's method, kept between bounds, at
#: most; how far u or V may then be off; and the V beyond which it is u that is looked for.
INVERSIONS, ON_CONTACT, STEEP = 50, 1e-14, 0.5
#: Steps of an impact by Python's solver, about half a second; below OFTEN in chi it is not
#: oscillation that takes so many.
MOST_STEPS, OFTEN = 3000, 1e3


@attrs.frozen(eq=False)
class FrontStretch(Stretch):
    """A stretch of the path: stick within the front, slip in one direction outside.

    Its ``steps`` end at the phases ``stops``; ``psi1`` is that of the impact. ``fronts`` belong to
    the phases at which ``states`` was called.
    """

    sign: int
    start: float
    stop: float
    change: float
    work: float
    solves: int
    steps: Steps
    stops: Array
    psi1: float
    fronts: dict[float, float] = attrs.field(factory=dict, repr=False)

    def fields(
        self, normal: ClosedFormMotion, contact: ScaledContact, factor: float
    ) -> Mapping[str, NDArray[Any]]:
        """Return rings of equal width: radius (m), stuck, and the sign of slipping traction.

        ``front`` (m) is the radius within which the contact sticks.
        """
        ring, largest = (np.arange(RINGS) + 0.5) / RINGS, float(normal.maximum_radius)
        front = self.fronts.get(float(contact.phase))
        front = max(0.0, float(self._at(contact)[2, 0]) if front is None else front)
        touching, inside = ring < contact.radius, ring < front
        shown = self.sign if factor > 0.0 else -self.sign
        return {
            "radius": largest * ring,
            "front": np.array(largest * front),
            "stuck": touching & inside,
            "slipping": np.where(touching & ~inside, shown, 0).astype(np.int8),
        }

    def states(self, contact: ScaledContact) -> tuple[Array, Array]:
        """Return (change of velocity since first touch, force)."""
        change, force, fronts = self._at(contact)
        phases = np.atleast_1d(contact.phase)
        self.fronts.update(zip(phases.tolist(), fronts.tolist(), strict=True))
        least = -2.0 * self.psi1  # energy of slip never exceeds that at first touch
        return np.clip(change, least, 0.0), force

    def _at(self, contact: ScaledContact) -> Array:
        """Return change, force and the front at each instant, by Newton's method.

        The force is that of the series at the same place, so that both vary slowly with it.
        """
        phase, radius, rate = map(np.atleast_1d, (contact.phase, contact.radius, contact.rate))
        steps = self.steps
        which = np.searchsorted(self.stops[:-1], phase)
        series, length = steps.series[which], steps.length[which]
        count = series.shape[-1]
        # u' = V and V' = -2.5 u⁴ over x: one of them is steep everywhere, and grows in ``way``
        steep = np.abs(rate) > STEEP
        way = np.where(steep & (rate > 0.0), 1.0, -1.0)
        sought = way[:, None] * np.where(steep[:, None], series[:, 0], series[:, 1])
        sought[:, 0] -= way * np.where(steep, radius, rate)
        slopes = sought[:, 1:] * np.arange(1.0, count)
        low, high, over = np.zeros_like(length), length, sought[:, 0]
        with np.errstate(all="ignore"):
            last = np.einsum("kn,kn->k", sought, np.vander(length, count, increasing=True))
            t = length * np.clip(np.nan_to_num(over / (over - last)), 0.0, 1.0)
            for _ in range(INVERSIONS):
                powers = np.vander(t, count, increasing=True)
                over = np.einsum("kn,kn->k", sought, powers)
                off = np.abs(over) > ON_CONTACT
                if not off.any():
                    break
                low, high = np.where(over > 0.0, low, t), np.where(over > 0.0, t, high)
                new = t - over / np.einsum("kn,kn->k", slopes, powers[:, :-1])
                new = np.where((new >= low) & (new <= high), new, 0.5 * (low + high))
                t = np.where(off, new, t)
        u, V, k, J, c = np.einsum("kin,kn->ik", series[:, :5], powers)
        psi = V - k - (series[:, 1, 0] - series[:, 2, 0])
        return np.array([steps.change[which] + self.sign * psi, self.sign * (u**3 - 1.5 * J), c])


def stretches(
    velocity: float, inertia: float, motion: ClosedFormMotion, tolerance: float
) -> Iterator[Stretch]:
    """Yield the stretches of one impact, from psi and 2.5 chi at first touch; each is a phase."""
    chi = 0.5 * inertia * motion.scaled_mass
    error = error_of_step(tolerance) * min(1.0, velocity)
    ends, status, steps = follow_one((velocity, chi, 0.0, 0.0), error, MOST_STEPS)
    # rounding of a small psi1 apart, the change is one that slip can make
    changes = np.clip(np.append(steps.change, ends[1]), -2.0 * velocity, 0.0)
    works = np.append(steps.work, ends[2])
    bounds = _phases(steps, lost=status != 0)
    first = 0
    for end in np.flatnonzero(np.diff(steps.part, append=-1.0)).tolist():
        after = end + 1
        yield FrontStretch(
            int(steps.sign[first]), float(bounds[first]), float(bounds[after]),
            float(changes[after]), float(works[after]), after,
            steps.take(slice(first, after)), bounds[first + 1 : after + 1], velocity,
        )  # fmt: skip
        first = after
    if status:
        count = max(len(steps.part), MOST_STEPS)
        why = f"at chi = {chi:.3g} the contact oscillates about sqrt(chi) times"
        if chi < OFTEN:
            why = "slip changes too often, or stick is lost within too short a time"
        raise LostPathError(
            f"More than {count} panels would be needed: {why}. A law of steps, such as "
            "springs under symplectic, can go on, with the error of its steps."
        )


def _phases(steps: Steps, *, lost: bool) -> Array:
    """Return the phases at which steps begin, and the last one ends; those never fall."""
    u, rate = steps.series[:, :2, 0].T
    if lost and len(steps.part):
        powers = steps.length[-1] ** np.arange(steps.series.shape[-1])
        last = steps.series[-1, :2] @ powers
        u, rate = np.append(u, last[0]), np.append(rate, last[1])
    u = np.maximum(u, 0.0)
    begins = np.arctan2(u, rate / velocity_factor(u))
    return np.maximum.accumulate(begins if lost else np.append(begins, math.pi))
