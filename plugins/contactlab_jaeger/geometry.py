"""What one step does to the places, apart from the displacement: limits, shares and weights."""

from __future__ import annotations

from bisect import bisect_left
from typing import NamedTuple

import numpy as np

from contactlab.checks import Real
from contactlab_jaeger.places import Array, Places


class Geometry(NamedTuple):
    """One step; K is the number of impacts, or 1 where all have the same contact.

    Attributes
    ----------
    settled : int
        Leading places that follow the surfaces through the whole step in every impact.
    share : array, shape (reach - settled, K)
        Part of the step for which the other places are in contact.
    limit : array, shape (reach, K)
        l at the end of the step, zero out of contact.
    weights : array, shape (reach,) or (reach, K)
        Of the force.
    """

    settled: int
    share: Array
    limit: Array
    weights: Array


def of_one(places: Places, before: float, after: float, pressure: Real) -> Geometry:
    """Return the geometry where one contact, from b² = ``before`` to ``after``, serves all."""
    reach = bisect_left(places.listed, after)
    room = after - places.squares[:reach, None]
    settled = bisect_left(places.listed, before) if after > before else reach
    share = room[settled:]
    if settled < reach:
        share = np.minimum(share / (after - before), 1.0)
    limit = (pressure * places.lift(after)) * room
    return Geometry(settled, share, limit, places.weights_within(after, reach))


def of_each(places: Places, before: Real, after: Array, pressure: Real) -> Geometry:
    """Return the geometry of contacts that differ, arrays of shape (K,).

    While b grows, a place met on the way moves with the surfaces only from then on; without
    this the error would be of first order in the step. b² is taken as linear in the step.
    """
    reach = int(places.squares.searchsorted(after.max()))  # n where that is NaN
    settled = min(reach, int(places.squares.searchsorted(np.min(before))))
    room = after - places.squares[:reach, None]
    growth = after - before
    grows = growth > 0.0
    share = np.clip(room[settled:] / np.where(grows, growth, 1.0), 0.0, 1.0)
    weights = np.where(room > 0.0, places.weights(after)[:reach], places.measure[:reach, None])
    limit = (pressure * places.lift(after)) * np.maximum(room, 0.0)
    return Geometry(settled, np.where(grows, share, 1.0), limit, weights)
