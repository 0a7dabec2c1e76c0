"""All steps at once: the geometry of every step, then a lean loop; one impact, or many alike."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab.checks import Real
from contactlab_jaeger.geometry import Geometry, of_each
from contactlab_jaeger.places import Array, Places
from contactlab_jaeger.step import follow


class Course(NamedTuple):
    """The steps, scaled: radius and pressure of shape (K,), the others too or (K, items).

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


def run_many(places: Places, course: Course, velocity: Real, items: int) -> tuple[Array, Array]:
    """Return forces, shape (K, items), and works of impacts that go through one course."""
    old, work, change = np.zeros((0, 1)), np.zeros(items), np.zeros(items)
    forces = np.empty((len(course.radius), items))
    for k, geometry in enumerate(_steps(places, course)):
        displacement = (velocity + change) * course.drift[k]
        forces[k], lost, old = follow(places, old, geometry, displacement, items)
        change -= course.kick[k] * forces[k]
        work += lost
    return forces, work


def _steps(places: Places, course: Course) -> list[Geometry]:
    """Return the geometry of each step of a course that all impacts share."""
    square = course.radius * course.radius
    before = np.concatenate(([0.0], square[:-1]))
    found = of_each(places, before, square, course.pressure)
    reach = places.squares.searchsorted(square)
    settled = np.where(square > before, places.squares.searchsorted(before), reach)
    rows = (np.ascontiguousarray(table.T) for table in found[1:])
    return [
        Geometry(first, share[first:last, None], limit[:last, None], weights[:last])
        for first, last, share, limit, weights in zip(
            settled.tolist(), reach.tolist(), *rows, strict=True
        )
    ]
