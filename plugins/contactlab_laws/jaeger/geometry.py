"""Geometry of the springs in a step: limits, parts of the step in contact, and weights."""

from __future__ import annotations

from bisect import bisect_left
from typing import NamedTuple

import numpy as np

from contactlab.numeric.checks import Real
from contactlab_laws.jaeger.bundle import Array, Bundle


class Geometry(NamedTuple):
    """One step of the springs that touch at its end in some impact.

    K is the number of impacts, or 1 where all have the same contact.

    Attributes
    ----------
    throughout : int
        Innermost springs that touch through the whole step in every impact.
    part : array, shape (touching - throughout, K)
        Part of the step for which the other springs touch.
    limit : array, shape (touching, K)
        l at the end of the step, zero out of contact.
    weights : array, shape (touching,) or (touching, K)
        Weights of the force.
    """

    throughout: int
    part: Array
    limit: Array
    weights: Array


def of_one(bundle: Bundle, before: float, after: float, pressure: Real) -> Geometry:
    """Return the geometry where one contact serves all impacts; ``before``, ``after`` are b²."""
    touching = bisect_left(bundle.squares_listed, after)
    compression = after - bundle.squares[:touching, None]
    throughout = bisect_left(bundle.squares_listed, before) if after > before else touching
    part = compression[throughout:]
    if throughout < touching:
        part = np.minimum(part / (after - before), 1.0)
    limit = (pressure * bundle.limit_factor(after)) * compression
    return Geometry(throughout, part, limit, bundle.weights_of_one(after, touching))


def of_each(bundle: Bundle, before: Real, after: Array, pressure: Real) -> Geometry:
    """Return the geometry of contacts that differ; ``before``, ``after`` are b², shape (K,)."""
    # While b grows, a spring that the contact meets in the step moves with the surfaces only from
    # then on; without this the error would be of first order. b² is taken as linear in the step.
    touching = int(bundle.squares.searchsorted(after.max()))  # n for NaN
    throughout = min(touching, int(bundle.squares.searchsorted(np.min(before))))
    compression = after - bundle.squares[:touching, None]
    growth = after - before
    grows = growth > 0.0
    part = np.clip(compression[throughout:] / np.where(grows, growth, 1.0), 0.0, 1.0)
    outside = bundle.full_weights[:touching, None]
    weights = np.where(compression > 0.0, bundle.weights(after)[:touching], outside)
    limit = (pressure * bundle.limit_factor(after)) * np.maximum(compression, 0.0)
    return Geometry(throughout, np.where(grows, part, 1.0), limit, weights)
