"""Surface displacements of hemispherical tractions, in closed form.

A traction (s/e)^n sqrt(e² - s²) e^{i n theta} on a disc of radius e has the Hankel transform
sqrt(pi/2) e^{3/2} k^{-3/2} J_{n+3/2}(k e). Every displacement that it makes on the surface of an
elastic half-space is then a Weber-Schafheitlin integral of two Bessel functions, theory §9.

References
----------
DLMF, https://dlmf.nist.gov/10.22, eq. (10.22.56).
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import hyp2f1, rgamma

from contactlab.numeric.types import Array, Real


def displacement(order: int, source: int, radius: Real, edge: Real) -> Array:
    """Return (4/pi) ∫ J_order(k r) F(k) dk, F the transform of a traction of order ``source``.

    Parameters
    ----------
    order, source : int
        Orders of the displacement and of the traction, at least 0.
    radius : float or array
        r, at which the displacement is asked for, at least 0.
    edge : float or array
        e, the radius of the disc, positive; broadcasts with ``radius``.
    """
    radius, edge = np.broadcast_arrays(np.asarray(radius, float), np.asarray(edge, float))
    inside = radius <= edge
    share = np.where(inside, radius, edge) / np.where(inside, edge, radius)
    first, factor = 0.5 * (order + source + 1), 2.0**-1.5 * math.gamma(0.5 * (order + source + 1))
    within = (
        factor
        * (rgamma(0.5 * (source - order + 4)) * rgamma(order + 1.0))
        * share**order
        * hyp2f1(first, 0.5 * (order - source - 2), order + 1.0, share**2)
    )
    beyond = (
        factor
        * (rgamma(0.5 * (order - source + 1)) * rgamma(source + 2.5))
        * share ** (source + 1)
        * hyp2f1(first, 0.5 * (source - order + 1), source + 2.5, share**2)
    )
    # Both sides are in units of e²: e^{3/2} times the scale of the integral, e^{1/2}.
    whole = (4.0 / math.pi) * math.sqrt(0.5 * math.pi) * edge**2
    return np.asarray(whole * np.where(inside, within, beyond))
