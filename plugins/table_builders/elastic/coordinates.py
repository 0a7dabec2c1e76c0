"""Impacts of the places in a table's regions, for its builder."""

from __future__ import annotations

import numpy as np

from contactlab.numeric.types import Array
from contactlab_laws.tables.patches import polynomial
from contactlab_laws.tables.regions import (
    CUT_END,
    CUT_TOP,
    LARGEST_CHI,
    SEAM_FROM,
    SLIP_LATE,
    SLIP_LONG,
    SLIP_ON,
    SMALL_FAR,
    SMALL_NEAR,
    STUCK_BACK,
    STUCK_ON,
    Cuts,
    slip_cut,
)

NAMES = (
    "chi < 1/2, near psi1 = 1",
    "chi < 1/2, far from it",
    "stuck first, below the cut",
    "stuck first, above the cut",
    "slip first, below the cut",
    "slip first, above the cut",
    "slip first, longer",
    "slip first, past compression",
)
#: Terms of the cuts and of the seam. A cut that is wrong by 4e-6 is seen in second derivatives.
STUCK_TERMS, SLIP_TERMS, SEAM_TERMS = 9, 11, 5


def impact(region: int, a: Array, b: Array, cuts: Cuts) -> tuple[Array, Array]:
    """Return (psi1, chi) >= 0 of the place (a, b) in the unit square of ``region``.

    Parameters
    ----------
    region : int
        One of the constants of ``contactlab_laws.tables.regions``.
    a, b : array, shape (places,)
        Coordinates in [0, 1].
    cuts : Cuts
        Polynomials of the boundaries between regions.

    Returns
    -------
    psi1, chi : array, shape (places,)
    """
    if region == SMALL_NEAR:
        return 1.0 - a**5 * b, 0.5 - 0.5 * b
    if region == SMALL_FAR:
        return 1.0 - b, 0.5 - 0.5 * a * b
    if region in (STUCK_BACK, STUCK_ON):
        cut = polynomial(cuts.stuck, a)
        above = region == STUCK_ON
        return a, cut + b * b * (LARGEST_CHI - cut) if above else 0.5 + b * (cut - 0.5)
    chi = 0.5 + b * (LARGEST_CHI - 0.5)
    if region == SLIP_LATE:
        return 1.0 + (1.0 + a) * (2.0 * chi - 1.0), chi
    if region == SLIP_LONG:
        t = CUT_END + a * (1.0 - CUT_END)
    else:
        if region == SLIP_ON:
            seam = polynomial(cuts.seam, np.maximum(b, SEAM_FROM))
            a = np.where(a < 0.5, 2.0 * a * seam, seam + (2.0 * a - 1.0) * (1.0 - seam))
        t = a * CUT_END
        cut = slip_cut(cuts.slip, t)
        chi = cut + b * b * (CUT_TOP - cut) if region == SLIP_ON else 0.5 + b * (cut - 0.5)
    return 1.0 + t**5 * (2.0 * chi - 1.0), chi


def measure(region: int, speed: Array, chi: Array) -> Array:
    """Return what g is multiplied with: psi2 = psi1 (-1 + measure g)."""
    return 1.0 - speed if region == SMALL_FAR else np.abs(2.0 * chi - 1.0)
