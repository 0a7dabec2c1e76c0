"""Normal motions made of samples, and of the motions of parts of a batch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts.contact import NormalContact
from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion, NormalSample
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import choose, merge_parts, some, spread
from contactlab.numeric.types import Array, Index, Mask, Real


class SampledMotion(NormalMotion):
    """A normal motion through samples, linear between them; its phase is proportional to time.

    Maxima are those of the samples, and of Hertz's impact where no sample is in contact; the load
    impulse is the sum by the trapezium rule.

    Parameters
    ----------
    law : NormalLaw
        The normal law.
    scene : Scene
        One impact or a batch.
    time : array, shape (K, ...)
        Times of the samples in s, growing. The sample at first touch is added.
    approach, rate : array, shape (K, ...)
        Approach in m and its rate in m/s.
    contact : NormalContact
        The normal contact; arrays of shape (K, ...).
    """

    def __init__(
        self,
        law: Law,
        scene: Scene,
        *,
        time: Array,
        approach: Array,
        rate: Array,
        contact: NormalContact,
    ) -> None:
        self.law, self.scene = law, scene
        shape = scene.shape
        touch: Array = np.broadcast_to(scene.normal_speed, (1, *shape))
        zero = np.zeros((1, *shape))
        column = (len(np.asarray(time)), *shape)

        def all_of(first: Real, rest: Real) -> Array:
            return np.concatenate((first, np.broadcast_to(rest, column)))

        self._time = all_of(zero, time)
        sampled = contact.complete
        entries = (sampled.force, sampled.radius, sampled.overlap, sampled.friction_load)
        force, radius, overlap, load = (all_of(zero, entry) for entry in entries)
        moved = np.diff(self._time, axis=0) * 0.5 * (load[1:] + load[:-1])
        impulse = np.concatenate((zero, np.cumsum(moved, axis=0)))
        depth, speed = all_of(zero, approach), all_of(touch, rate)
        self._columns = np.stack((depth, speed, force, radius, overlap, load, impulse))
        self.duration = spread(self._time[-1], shape)
        self.final_rate, self.total_load_impulse = (
            spread(column[-1], shape) for column in (speed, impulse)
        )
        largest = [spread(column.max(axis=0), shape) for column in (radius, depth, force)]
        if any(some(own == 0.0) for own in largest):  # laws divide by maxima as they start
            usual = hertz_scales(scene)
            scales = usual.radius, usual.approach, usual.force
            pairs = zip(largest, scales, strict=True)
            largest = [choose(own == 0.0, scale, own) for own, scale in pairs]
        self.maximum_radius, self.maximum_approach, self.maximum_force = largest

    @property
    def compression_work(self) -> Real:
        """Work of the normal force up to the greatest approach, in J: of an impact ½ M v1²."""
        depth, _, force, *_ = self._columns
        steps = 0.5 * (force[1:] + force[:-1]) * np.diff(depth, axis=0)
        steps[0] = 0.4 * force[1] * depth[1]  # a path may press in one step: Hertz's work
        place = depth[1:].argmax(axis=0)[np.newaxis]
        pressed = np.take_along_axis(np.cumsum(steps, axis=0), place, axis=0)[0]
        hertzian = 0.4 * self.maximum_force * self.maximum_approach
        work: Real = choose(pressed > 0.0, spread(pressed, self.scene.shape), hertzian)
        return work

    def at(self, phase: Real) -> NormalSample:
        """Return the motion at ``phase``, by linear interpolation."""
        fraction = np.asarray(phase, dtype=np.float64) / math.pi
        outer = np.broadcast_shapes(fraction.shape, self.scene.shape)
        time = np.broadcast_to(fraction * self.duration, outer)
        count = len(self._time)
        items = self._time.reshape(count, -1)
        wanted = time.reshape(-1, items.shape[1])
        shares = np.empty((7, *wanted.shape))
        for item in range(items.shape[1]):
            for k, column in enumerate(self._columns.reshape(7, count, -1)[..., item]):
                shares[k, :, item] = np.interp(wanted[:, item], items[:, item], column)
        depth, rate, force, radius, overlap, load, impulse = (
            column.reshape(outer) if outer else float(column.item()) for column in shares
        )
        when = np.array(time) if outer else float(time)
        return NormalSample(when, depth, rate, NormalContact(force, radius, overlap, load), impulse)

    def phase(self, fraction: Real) -> Real:
        """Return pi times the fraction."""
        return math.pi * np.asarray(fraction)

    def take(self, part: Index) -> SampledMotion:
        """Return the motion of some impacts."""
        index = (slice(1, None), *(part if isinstance(part, tuple) else (part,)))
        time = self._time[index]
        depth, rate, *contact, _ = (column[index] for column in self._columns)
        return SampledMotion(
            self.law,
            self.scene.take(part),
            time=time,
            approach=depth,
            rate=rate,
            contact=NormalContact(*contact),
        )


class Ends(NamedTuple):
    """Ends of the normal motions that friction changed.

    Entries have the batch shape. A NaN rate marks impacts whose normal motion friction does not
    change. A law without a duration or maximum returns NaN for that entry.

    Attributes
    ----------
    duration : float or array
        Time of contact in s.
    final_rate : float or array
        Rate of approach at separation, in m/s.
    maximum_radius, maximum_approach, maximum_force : float or array
        Greatest contact radius (m), approach (m) and normal force (N).
    dissipation : float or array
        Energy in J that the normal law took; 0 for an elastic law.
    compressions : float or array
        How often the approach grew: 1, or more where friction presses the bodies together again.
    """

    duration: Real
    final_rate: Real
    maximum_radius: Real
    maximum_approach: Real
    maximum_force: Real
    dissipation: Real
    compressions: Real = 1.0

    @classmethod
    def of(cls, normal: NormalMotion | Ends | None) -> Ends:
        """Return the ends of a motion; None stands for a motion that friction does not change.

        Parameters
        ----------
        normal : NormalMotion, Ends or None
        """
        if isinstance(normal, Ends):
            return normal
        if normal is None:
            return cls._make([math.nan] * len(cls._fields))
        law: Any = normal.law
        ends = [getattr(normal, name) for name in cls._fields[:5]]
        return cls._make((*ends, law.dissipation(normal), 1.0))

    @classmethod
    def merge(
        cls,
        parts: Sequence[tuple[slice | Mask, NormalMotion | Ends | None]],
        shape: tuple[int, ...],
    ) -> Ends:
        """Return the ends of a batch of ``shape`` from places and the motions of parts.

        Parameters
        ----------
        parts, shape
            As of ``BatchMotion.merge``.
        """
        ends = [(where, cls.of(normal)) for where, normal in parts]
        columns = ([(where, getattr(each, name)) for where, each in ends] for name in cls._fields)
        return cls._make(merge_parts(column, shape) for column in columns)
