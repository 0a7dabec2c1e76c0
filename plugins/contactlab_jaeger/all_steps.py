"""All steps at once: the geometry of every step, then a lean loop; of one impact, or of many."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from contactlab.checks import Real
from contactlab_jaeger.bundle import Array, Bundle
from contactlab_jaeger.geometry import of_each


class ScaledSteps(NamedTuple):
    """The steps, scaled, each of shape (K,); drift and kick of a batch (K, items) or (K, 1).

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


def advance_batch(
    bundle: Bundle, steps: ScaledSteps, velocity: Real, items: int
) -> tuple[Array, Array]:
    """Return the same of impacts that share one contact: forces (K, items) and works (items,).

    Springs lead, so that a row is contiguous over the batch. A spring out of contact has limit
    and deflection 0; only those that touch at the start or the end of a step are looked at.

    Parameters
    ----------
    bundle : Bundle
    steps : ScaledSteps
    velocity : float or array, shape (items,)
        Slip velocity at first touch, in m/s.
    items : int
        Impacts.
    """
    square = steps.radius * steps.radius
    before = np.concatenate(([0.0], square[:-1]))
    throughout, part, limit, weights = of_each(bundle, before, square, steps.pressure)
    part = np.concatenate((np.ones((throughout, len(square))), part))
    touching = bundle.squares.searchsorted(square)
    whole = np.where(square > before, bundle.squares.searchsorted(before), touching)
    springs = len(limit)
    old, new, trial = np.zeros((3, springs, items))
    forces, works = np.empty((2, len(square), items))
    change, displacement = np.zeros((2, items))
    least, last = -limit, 0  # springs that touched at the end of the step before
    for k, (first, now) in enumerate(zip(whole.tolist(), touching.tolist(), strict=True)):
        rows = max(now, last)
        first = rows if first == now else first
        held, moved, kept = old[:rows], trial[:rows], new[:rows]
        np.add(velocity, change, out=displacement)
        displacement *= steps.drift[k]
        np.add(held[:first], displacement, out=moved[:first])
        if first < rows:
            np.multiply(part[first:rows, k, None], displacement, out=moved[first:])
            moved[first:] += held[first:]
        moved.clip(least[:rows, k, None], limit[:rows, k, None], out=kept)
        weights[:rows, k].dot(kept, out=forces[k])
        change -= steps.kick[k] * forces[k]
        moved -= kept  # the slip
        held += kept
        moved *= held
        weights[:rows, k].dot(moved, out=works[k])
        if now < rows:
            old[now:rows] = 0.0
        old, new, last = new, old, now
    return forces, 0.5 * np.maximum(works, 0.0, out=works).sum(axis=0)
