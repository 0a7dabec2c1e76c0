"""All steps of one impact at once: the geometry of every step, then a lean loop."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab_jaeger.bundle import Array, Bundle
from contactlab_jaeger.geometry import of_each


class ScaledSteps(NamedTuple):
    """The steps, scaled, each of shape (K,).

    ``drift`` takes the slip velocity to displacement, ``kick`` takes F to its change.
    """

    radius: Array
    pressure: Array
    drift: Array
    kick: Array


def advance_all(bundle: Bundle, steps: ScaledSteps, velocity: float) -> tuple[Array, float]:
    """Return the forces, shape (K,), and the friction work, as ``step.advance`` would.

    ``velocity`` is the slip velocity at first touch, in m/s.
    """
    square = steps.radius * steps.radius
    before = np.concatenate(([0.0], square[:-1]))
    throughout, part, limit, weights = of_each(bundle, before, square, steps.pressure)
    count, touching = len(square), len(limit)
    trials = np.ones((count, touching))  # parts of the displacement, then w before the limit
    trials[:, throughout:] = part.T
    limits = np.ascontiguousarray(limit.T)
    deflections = np.zeros((count + 1, touching))  # w at the ends of steps
    weights = np.ascontiguousarray(weights.T)
    old, change, forces = deflections[0], 0.0, []
    minimum, maximum = np.minimum, np.maximum  # looked up once
    for trial, new, most, least, weight, drift, kick in zip(
        trials,
        deflections[1:],
        limits,
        -limits,
        weights,
        steps.drift.tolist(),
        steps.kick.tolist(),
        strict=True,
    ):
        trial *= (velocity + change) * drift
        trial += old
        minimum(trial, most, out=new)
        maximum(new, least, out=new)
        force = float(weight.dot(new))
        change -= kick * force
        forces.append(force)
        old = new
    slip = np.subtract(trials, deflections[1:], out=trials)
    slip *= deflections[1:] + deflections[:-1]
    work = np.maximum(np.einsum("ij,ij->i", weights, slip), 0.0)
    return np.array(forces), 0.5 * float(work.sum())
