"""All steps of one impact at once: the geometry of every step, then a lean loop."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab_jaeger.geometry import of_each
from contactlab_jaeger.places import Array, Places


class Course(NamedTuple):
    """The steps, scaled, each of shape (K,).

    ``drift`` takes the slip velocity to displacement, ``kick`` takes F to its change.
    """

    radius: Array
    pressure: Array
    drift: Array
    kick: Array


def run(places: Places, course: Course, velocity: float) -> tuple[Array, float]:
    """Return the forces, shape (K,), and the friction work, as ``step.advance`` would."""
    square = course.radius * course.radius
    before = np.concatenate(([0.0], square[:-1]))
    settled, share, limit, weights = of_each(places, before, square, course.pressure)
    count, reach = len(square), len(limit)
    trial = np.ones((count, reach))  # shares of the displacement, then what they come to
    trial[:, settled:] = share.T
    top = np.ascontiguousarray(limit.T)
    held, weigh = np.zeros((count + 1, reach)), np.ascontiguousarray(weights.T)
    old, change, forces = held[0], 0.0, []
    lower, upper = np.minimum, np.maximum  # looked up once
    for moved, stretch, most, least, weight, drift, kick in zip(
        trial,
        held[1:],
        top,
        -top,
        weigh,
        course.drift.tolist(),
        course.kick.tolist(),
        strict=True,
    ):
        moved *= (velocity + change) * drift
        moved += old
        lower(moved, most, out=stretch)
        upper(stretch, least, out=stretch)
        force = float(weight.dot(stretch))
        change -= kick * force
        forces.append(force)
        old = stretch
    slip = np.subtract(trial, held[1:], out=trial)
    slip *= held[1:] + held[:-1]
    work = np.maximum(np.einsum("ij,ij->i", weigh, slip), 0.0)
    return np.array(forces), 0.5 * float(work.sum())
