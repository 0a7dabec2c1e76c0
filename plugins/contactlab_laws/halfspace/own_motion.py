"""The normal motion that came of the friction, in SI units."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts import NormalContact, NormalMotion, SampledMotion
from contactlab_laws.halfspace.course import units
from contactlab_laws.halfspace.hemispheres import Array
from contactlab_laws.halfspace.impacts import Impacts


class Own(NamedTuple):
    """A normal motion, and the impulses in N s at its samples, of each impact; 0 at first touch."""

    motion: SampledMotion
    impulses: dict[int, Array]


def own_motion(normal: NormalMotion, followed: dict[int, tuple[Impacts, int]]) -> Own:
    """Return the normal motion of impacts, with departures where ``followed`` has them.

    Parameters
    ----------
    normal : NormalMotion
        Normal motion without friction, of one impact or a batch.
    followed : dict of int to (Impacts, int)
        Impacts with departures by their numbers in the batch: the group in which each was
        followed, and its place in that group.
    """
    scene, shape = normal.scene, normal.scene.shape
    longest = max(len(each.path.inside) for each, _ in followed.values())
    columns, impulses = np.empty((4, longest - 1, math.prod(shape))), {}
    for item, place_in_batch in enumerate(np.ndindex(shape)):
        one = normal.take(place_in_batch) if shape else normal
        phase, departures = np.linspace(0.0, math.pi, longest), None
        if item in followed:
            impacts, place = followed[item]
            assert impacts.departures is not None
            departures = impacts.departures[:, :, place]
            phase = impacts.path.phase[:, 0]
        sample = one.at(phase)
        rows = [np.asarray(each, float) for each in sample[:3]]
        rows.append(np.asarray(sample.contact.force, float))
        if departures is not None:
            unit, pair = units(one), one.scene.pair
            scales = unit.length**2 / pair.radius, one.scene.normal_speed, unit.force
            for row, change, scale in zip(rows[1:], departures, scales, strict=True):
                row += change * scale
            rows = _parted(rows, len(phase) // 2)
            passed = 0.5 * np.diff(rows[0]) * (rows[3][1:] + rows[3][:-1])
            impulses[item] = np.concatenate(([0.0], np.cumsum(passed)))
        for column, row in zip(columns, rows, strict=True):
            column[:, item] = np.concatenate((row[1:], np.full(longest - len(row), row[-1])))
    time, approach, rate, force = columns.reshape(4, longest - 1, *shape)
    edge = np.sqrt(scene.pair.radius * np.maximum(approach, 0.0))
    contact: Any = NormalContact(force=force, radius=edge, overlap=approach)
    motion = SampledMotion(
        normal.law, scene, time=time, approach=approach, rate=rate, contact=contact
    )
    return Own(motion, impulses)


def _parted(rows: list[Array], top: int) -> list[Array]:
    """Return time, approach, rate and force with nothing happening after the bodies parted."""
    time, approach, rate, force = (row.copy() for row in rows)
    force[approach <= 0.0] = 0.0
    after = np.flatnonzero(approach[top:] <= 0.0)
    first = top + int(after[0]) if after.size else len(time)
    # The last contact is at the least approach: the rate is constant there to rounding.
    last = first - 1
    end = time[last] - approach[last] / rate[last]
    time[first:], approach[first:], rate[first:] = end, 0.0, rate[-1]
    if first == len(time):
        time[-1], approach[-1] = end, 0.0
    force[-1] = 0.0
    return [time, approach, rate, force]
