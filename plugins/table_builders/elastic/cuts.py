"""The curves on which the course of an impact changes, found by bisection."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contactlab.numeric.types import Array
from contactlab_laws.tables.regions import (
    CUT_END,
    CUT_TOP,
    FIRST_POWER,
    SEAM_FROM,
    SLIP_MIDDLE,
    Cuts,
    slip_cut,
)
from table_builders.elastic.coordinates import SEAM_TERMS, SLIP_TERMS, STUCK_TERMS
from table_builders.elastic.exact import last_slip, reaches_disk

POINTS = 40
#: A place is found to 2^-HALVINGS; g is wrong by some (error of a cut)^(5/2) only, and its second
#: derivative by some 300 (error of the seam)^2.
HALVINGS = 36
#: chi, and t/CUT_END, between which the course changes.
STUCK_RANGE, SLIP_RANGE, SEAM_RANGE = (1.4, 1.9), (1.7, 2.69), (0.3, 0.8)


def find() -> Cuts:
    """Return both cuts and the seam."""

    def slips_on(t: float, chi: float) -> bool:
        return last_slip(1.0 + t**5 * (2.0 * chi - 1.0), chi) > 0

    def reaches(b: float, share: float) -> bool:
        t = share * CUT_END
        cut = float(slip_cut(slip, np.array(t)))
        chi = cut + b * b * (CUT_TOP - cut)
        return reaches_disk(1.0 + t**5 * (2.0 * chi - 1.0), chi)

    def slip_terms(t: Array) -> Array:
        later = t[:, None] ** FIRST_POWER * (t[:, None] - SLIP_MIDDLE) ** np.arange(SLIP_TERMS - 1)
        return np.column_stack((np.ones_like(t), later))

    stuck = _fit(
        lambda psi1, chi: last_slip(psi1, chi) > 0, (0.0, 1.0), STUCK_RANGE, _powers(STUCK_TERMS)
    )
    slip = _fit(slips_on, (0.0, CUT_END), SLIP_RANGE, slip_terms)
    return Cuts(stuck, slip, _fit(reaches, (SEAM_FROM, 1.0), SEAM_RANGE, _powers(SEAM_TERMS)))


def _powers(count: int) -> Callable[[Array], Array]:
    return lambda argument: argument[:, None] ** np.arange(count)


def _fit(
    beyond: Callable[[float, float], bool],
    ends: tuple[float, float],
    within: tuple[float, float],
    basis: Callable[[Array], Array],
) -> Array:
    """Return the terms of a curve by functions of its argument, which lies between ``ends``.

    Parameters
    ----------
    beyond : callable
        Whether an argument and a place ``within`` lie beyond the curve.
    ends, within : (float, float)
    basis : callable
        The functions at some arguments, shape (arguments, terms).
    """
    nodes = 0.5 - 0.5 * np.cos(np.pi * (np.arange(POINTS) + 0.5) / POINTS)
    arguments = ends[0] + (ends[1] - ends[0]) * nodes
    places = np.array([_bisect(beyond, argument, within) for argument in arguments.tolist()])
    matrix = basis(arguments)
    sizes = np.abs(matrix).max(axis=0)
    return np.asarray(np.linalg.lstsq(matrix / sizes, places, rcond=None)[0] / sizes)


def _bisect(
    beyond: Callable[[float, float], bool], argument: float, within: tuple[float, float]
) -> float:
    low, high = within
    for _ in range(HALVINGS):
        place = 0.5 * (low + high)
        if beyond(argument, place):
            high = place
        else:
            low = place
    return 0.5 * (low + high)
