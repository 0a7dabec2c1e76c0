"""All steps at once, of one impact or of many: the geometry of every step, then a lean loop."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from contactlab.numeric.types import Array, Real
from contactlab_laws.jaeger.bundle import Bundle, of_each

#: Most springs times steps of a geometry that is kept for the next impact; eight take 13 MB.
LARGEST_KEPT = 50_000


class ScaledSteps(NamedTuple):
    """The steps, scaled, each of shape (K,); drift and kick of a batch (K, items) or (K, 1).

    ``drift`` takes the slip velocity to displacement, ``kick`` takes F to the change of velocity.
    """

    radius: Array
    pressure: Array
    drift: Array
    kick: Array


def advance_all(bundle: Bundle, steps: ScaledSteps, velocity: float) -> tuple[Array, float]:
    """Return the forces of one impact, shape (K,), and the work, as by ``step.advance``."""
    # ``velocity`` is the slip velocity at first touch, in m/s.
    rows, parts, weights = _geometry(bundle, steps)
    trials = parts.copy()  # parts of the displacement, then w before the limit
    count, touching = trials.shape
    deflections = np.zeros((count + 1, touching))  # w at the ends of steps
    old, change, forces = deflections[0], 0.0, []
    add, minimum, maximum = np.add, np.minimum, np.maximum
    for (whole, most, least, weight), trial, new, drift, kick in zip(
        rows, trials, deflections[1:], steps.drift.tolist(), steps.kick.tolist(), strict=True
    ):
        if whole:
            add(old, (velocity + change) * drift, out=trial)
        else:
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


#: One row for each step: True unless some spring moves for only a part of the step, limits, minus
#: the limits, weights.
Rows = list[tuple[bool, Array, Array, Array]]


def _geometry(bundle: Bundle, steps: ScaledSteps) -> tuple[Rows, Array, Array]:
    """Return the rows of the steps, and parts and weights, shape (K, touching) each."""
    if len(steps.radius) * len(bundle.squares) > LARGEST_KEPT:
        return _rows(bundle, steps.radius, steps.pressure)
    return _keep(bundle, steps.radius.tobytes(), steps.pressure.tobytes())


@lru_cache(maxsize=8)
def _keep(bundle: Bundle, radius: bytes, pressure: bytes) -> tuple[Rows, Array, Array]:
    return _rows(bundle, np.frombuffer(radius), np.frombuffer(pressure))


def _rows(bundle: Bundle, radius: Array, pressure: Array) -> tuple[Rows, Array, Array]:
    square = radius * radius
    before = np.concatenate(([0.0], square[:-1]))
    throughout, part, limit, weights = of_each(bundle, before, square, pressure)
    parts = np.ones((len(square), len(limit)))
    parts[:, throughout:] = part.T
    # A spring out of contact has no part in the step; its limit 0 keeps it at 0 all the same.
    partly = np.any((parts > 0.0) & (parts < 1.0), axis=1)
    whole: list[bool] = np.logical_not(partly).tolist()
    limits, weights = np.ascontiguousarray(limit.T), np.ascontiguousarray(weights.T)
    for array in (limits, weights, parts):
        array.flags.writeable = False
    rows = list(zip(whole, limits, -limits, weights, strict=True))
    return rows, parts, weights


def advance_batch(
    bundle: Bundle, steps: ScaledSteps, velocity: Real, items: int
) -> tuple[Array, Array]:
    """Return forces (K, items) and friction works (items,) of impacts that share one contact."""
    # Springs lead, so that a row is contiguous over the batch. A spring out of contact has limit
    # and deflection 0; each step takes only the springs that touch at its start or end.
    # The work of a step, twice the sum of slip times mean w, is here the force before and after
    # times the displacement, less the energy stored: the same sum, as slip = old w + part D - w.
    # All weights are those of the step, so that energy that a change of weights makes or loses is
    # missing in the books, as it is in a sum of slips.
    square = steps.radius * steps.radius
    before = np.concatenate(([0.0], square[:-1]))
    rows, parts, _ = _geometry(bundle, steps)
    touching = bundle.squares.searchsorted(square)
    whole = np.where(square > before, bundle.squares.searchsorted(before), touching)
    deflection, squared = np.zeros((2, parts.shape[1], items))  # w and w²
    forces = np.empty((len(square), items))
    change, displacement, energy, work, total = np.zeros((5, items))
    last = 0  # springs that touched at the end of the step before
    for (_, most, least, weight), part, first, now, drift, kick, force in zip(
        rows,
        parts,
        whole.tolist(),
        touching.tolist(),
        steps.drift,
        steps.kick,
        forces,
        strict=True,
    ):
        count = max(now, last)
        same = first if first < now else count  # springs with the whole displacement
        moved, stored, weight = deflection[:count], squared[:count], weight[:count]
        np.add(velocity, change, out=displacement)
        displacement *= drift
        weight.dot(moved, out=work)
        weight.dot(stored, out=energy)
        moved[:same] += displacement
        if same < count:  # the others, new in contact, were at 0
            np.multiply(part[same:count, None], displacement, out=moved[same:])
        np.minimum(moved, most[:count, None], out=moved)  # faster than clip
        np.maximum(moved, least[:count, None], out=moved)
        weight.dot(moved, out=force)
        work += force
        if same < count:
            work -= (weight[same:] * (1.0 - part[same:count])).dot(moved[same:])
        work *= displacement
        work += energy
        np.multiply(moved, moved, out=stored)
        weight.dot(stored, out=energy)
        work -= energy
        total += np.maximum(work, 0.0, out=work)
        np.multiply(force, kick, out=displacement)
        change -= displacement
        last = now
    total *= 0.5
    return forces, total
