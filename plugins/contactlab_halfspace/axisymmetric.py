"""Many impacts with tractions along one direction, functions of the radius alone: mode 0.

This is the paper's axisymmetric problem with Coulomb's law at every point. Scaled as in ``march``.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from contactlab.numeric.types import Array
from contactlab_halfspace.basis import basis
from contactlab_halfspace.instants import Instants
from contactlab_halfspace.march import Followed
from contactlab_halfspace.rings import Rings, rings, settle
from contactlab_halfspace.slips import begin_slips, move_slips, rest

#: Steps from one ring to the next.
STEPS = 4
#: Solutions of a step: the share of Coulomb's limit at its end is taken from the one before.
PASSES = 2


@lru_cache(maxsize=16)
def table_of(count: int) -> Rings:
    """Return the matrices of ``count`` rings, cached."""
    return rings(basis(count, 1).edges)


def follow_all(
    count: int, course: Instants, psi1: Array, chi: Array, stiffness: Array, *, fields: bool = False
) -> Followed:
    """Return the motion of impacts over ``count`` rings.

    Parameters
    ----------
    count : int
        Rings within the largest contact.
    course : Instants
        Normal motions of the impacts.
    psi1, chi, stiffness : array, shape (impacts,)
        Dimensionless angles of incidence, inertia ratios, and units of force times those of time
        over M_n v1.
    fields : bool
        Whether to keep tractions, slips and pressures.

    Raises
    ------
    RuntimeError
        If no division of the contact into stick and slip is found.
    """
    # In every step the share of Coulomb's limit that acts is linear in the impulse of the friction
    # load, so that gross slip is exact. The first step has one share throughout. The share is that
    # at the step's start, ``after`` that at its end, first guessed by the line through the shares
    # before; a quantity that the share drives twice, as displacement, has a third of the one and a
    # sixth of the other.
    table, moments, edges = table_of(count), basis(count, 1).work[0], basis(count, 1).edges
    cubes, hemispheres = edges**3, np.sqrt(np.maximum(edges[:, None] ** 2 - edges[:-1] ** 2, 0.0))
    impacts = len(psi1)
    change, shares = np.zeros((2, len(course.inside), impacts))
    zero = np.zeros((impacts, count))
    slips, traction, displaced, work = begin_slips(zero), zero, np.zeros(impacts), np.zeros(impacts)
    stuck, sense = np.ones(zero.shape, dtype=bool), zero.copy()
    touched, kept, places = np.zeros(impacts, dtype=bool), [], np.arange(count)
    gains = 2.0 * chi * np.diff(course.impulse, axis=0)
    durations = np.diff(course.time, axis=0) + np.zeros(impacts)
    acting = course.pressure > 0.0
    some, whole = np.any(acting, axis=1), np.all(acting, axis=1)
    smaller = [table.within(number) for number in range(count + 1)]
    for k, number in enumerate(course.inside[1:].tolist(), start=1):
        duration, gain, share = durations[k - 1], gains[k - 1], shares[k - 1]
        after = 2.0 * share - shares[k - 2] if k > 2 else share
        new, limits = np.zeros((2, impacts, count))
        fixed, swept = displaced + duration * (psi1 + change[k - 1]), duration * gain
        live = acting[k]
        if number and some[k]:
            ours, chosen = smaller[number], slice(None) if whole[k] else live
            part = chosen, slice(number)
            # The edge lies between two rings, and the limit between the hemispheres of both.
            outer, inner = float(course.share[k]), 1.0 - float(course.share[k])
            limit = outer * hemispheres[number, :number] + inner * hemispheres[number - 1, :number]
            load = float(outer * cubes[number] + inner * cubes[number - 1])
            scale = (course.pressure[k] + np.zeros(impacts))[chosen, None]
            resting = rest(slips, duration[:, None], vectors=False)[part] / scale
            guess, begins, ahead = (stuck[part], sense[part]), live & ~touched, after
            for _ in range(PASSES):
                share = np.where(begins, after, shares[k - 1])
                total = (fixed - swept * (share / 3.0 + after / 6.0))[chosen, None]
                solution = settle(ours, total / scale - resting, limit, *guess)
                after = ahead.copy()  # of impacts out of contact, as if they were alone
                after[chosen] = solution @ ours.weights / load
            stuck[part], sense[part] = guess
            new[part], limits[part] = solution * scale, limit * scale
            shares[k - 1] = share = np.where(begins, after, shares[k - 1])
            touched = touched | live
        displaced = fixed - swept * (share / 3.0 + after / 6.0)
        slip = displaced[:, None] - new[:, :number] @ table.compliance[:, :number].T
        work += (((slip - slips.last) @ moments) * (0.5 * (traction + new))).sum(axis=1)
        slips = move_slips(slips, slip, duration[:, None], places < number)
        change[k] = change[k - 1] - 0.5 * gain * (share + after)
        shares[k], traction = after, new
        if fields:
            kept.append((new, slip, limits))
    impulse = np.broadcast_to(course.impulse, shares.shape)
    works, residual = 6.0 * chi * stiffness * work, np.zeros(impacts)
    return Followed(change, shares, impulse, works, residual, kept)
