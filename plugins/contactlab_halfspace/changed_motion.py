"""The normal motion that friction changed, in SI units."""

from __future__ import annotations

import math

import numpy as np

from contactlab.contracts import NormalContact, NormalMotion, SampledMotion
from contactlab.numeric.types import Array
from contactlab_halfspace.instants import units


def change_motion(
    normal: NormalMotion, changed: dict[int, tuple[Array, Array]]
) -> tuple[SampledMotion, dict[int, Array]]:
    """Return a motion, and the impulses in N s at its samples, of each changed impact from 0.

    Parameters
    ----------
    normal : NormalMotion
        Normal motion without friction, of one impact or a batch.
    changed : dict of int to (array, array)
        Phases, shape (K + 1,), and departures of approach, rate and force, shape (3, K + 1), of
        impacts by their numbers in the batch.
    """
    scene, shape = normal.scene, normal.scene.shape
    longest = max(len(phase) for phase, _ in changed.values())
    columns, impulses = np.empty((4, longest - 1, math.prod(shape))), {}
    for item, place in enumerate(np.ndindex(shape)):
        one = normal.take(place) if shape else normal
        phase, departures = changed.get(item, (np.linspace(0.0, math.pi, longest), None))
        sample = one.at(phase)
        rows = [np.asarray(each, float) for each in (*sample[:3], sample.contact.force)]
        if departures is not None:
            unit, pair = units(one), one.scene.pair
            scales = unit.length**2 / pair.radius, one.scene.normal_speed, unit.force
            for row, change, scale in zip(rows[1:], departures, scales, strict=True):
                row += change * scale
            rows = _part(rows, len(phase) // 2)
            passed = 0.5 * np.diff(rows[0]) * (rows[3][1:] + rows[3][:-1])
            impulses[item] = np.concatenate(([0.0], np.cumsum(passed)))
        for column, row in zip(columns, rows, strict=True):
            column[:, item] = np.concatenate((row[1:], np.full(longest - len(row), row[-1])))
    time, approach, rate, force = columns.reshape(4, longest - 1, *shape)
    edge = np.sqrt(scene.pair.radius * np.maximum(approach, 0.0))
    contact = NormalContact(force=force, radius=edge, overlap=approach)
    motion = SampledMotion(
        normal.law, scene, time=time, approach=approach, rate=rate, contact=contact
    )
    return motion, impulses


def _part(rows: list[Array], top: int) -> list[Array]:
    """Return time, approach, rate and force; after parting, force 0 and a constant rate."""
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
