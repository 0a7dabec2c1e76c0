"""The slips of points over the last steps, and their extrapolation: stick or slip."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array, Real


class Slips(NamedTuple):
    """Slips at the last three instants: numbers of shape (impacts, rings), or vectors.

    Vectors have the shape (impacts, 2, angles, rings).

    Attributes
    ----------
    last, before, first : array
        Slips, the latest first.
    steps : tuple of array or float
        Durations of the last two steps, the latest first; 0 if there was none.
    inside : array of int that broadcasts to the slips, or 0
        Instants since which each ring has been in contact.
    """

    last: Array
    before: Array
    first: Array
    steps: tuple[Real, Real]
    inside: Real


def begin_slips(slip: Array) -> Slips:
    """Return the slips at first touch."""
    return Slips(slip, slip, slip, (0.0, 0.0), 0.0)


def move_slips(slips: Slips, slip: Array, duration: Real, touching: NDArray[np.bool_]) -> Slips:
    """Return the slips after a step; ``touching`` marks the rings in contact at its end."""
    # A ring out of contact forgets how fast it slipped.
    return Slips(
        last=slip,
        before=np.where(touching, slips.last, slip),
        first=slips.before,
        steps=(duration, slips.steps[0]),
        inside=np.where(touching, slips.inside + 1, 0),
    )


def rest(slips: Slips, duration: Real, *, vectors: bool) -> Array:
    """Return the slip at the end of the next step of a point whose slip rate is zero there.

    The traction of a point that slips is along its slip less this slip. The slip rate is
    extrapolated with constant deceleration: as in backward differences of second order, or up to
    where the point comes to rest within the step. So the direction of slip does not lag.

    Parameters
    ----------
    slips : Slips
        Past slips; vectors along the second axis if ``vectors`` is True, else numbers.
    duration : array that broadcasts to the slips
        Duration of the next step.
    vectors : bool
        Whether slips are vectors.
    """
    increment, prior = slips.last - slips.before, slips.before - slips.first
    latest, earlier = slips.steps
    with np.errstate(all="ignore"):
        if vectors:
            size = np.sqrt((increment * increment).sum(axis=1, keepdims=True))
            along = (increment * prior).sum(axis=1, keepdims=True) / size
        else:
            size, along = np.abs(increment), np.sign(increment) * prior
        ratio = np.divide(duration, latest)
        weight = ratio * ratio / (1.0 + 2.0 * ratio)
        speed = size / latest
        slowing = 2.0 * (along / earlier - speed) / (latest + earlier)
        final = np.maximum(speed - 0.5 * slowing * latest, 0.0)
        until_rest = np.where(slowing > 0.0, 0.5 * (final / size) * (final / slowing), np.inf)
        weight = np.minimum(weight, until_rest)
        known = (np.asarray(slips.inside) > 1) & (np.asarray(earlier) > 0.0) & (size > 0.0)
    return np.asarray(slips.last + np.where(known, weight, 0.0) * increment)
