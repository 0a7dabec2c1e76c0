"""The restitution e of a viscoelastic impact and its relaxation time a, in scaled units (§15).

a = (e^(-3/5) - 1)/g, where g lies between 1.0923 and 1.1351.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.chebyshev import chebval

from contactlab.numeric.arrays import plain
from contactlab.numeric.types import Array, Real

#: g by Chebyshev polynomials of (e^(1/3) - 0.6)/0.4, from ``LEAST`` up: e to 2e-10.
TERMS = (
    1.1117603234, 2.2069240894e-2, 1.693150355e-3, -6.0396428493e-4, 1.2285619681e-4,
    -2.0696505414e-5, 2.8178510532e-6, -1.6950910388e-7, -8.1828646693e-8, 5.0365173402e-8,
    -2.0123813399e-8, 7.0226410944e-9, -2.3074047795e-9,
)  # fmt: skip
#: Below this e the asymptote for a to infinity, to second order: e to 4e-7.
LEAST = 0.008
#: g for a to infinity, and the factor of e^(2/3) that joins the asymptote to the polynomial.
FIRST, SECOND = 0.8**-0.4, 1.4306172
#: Turns of the fixed point: each multiplies the error of e by 0.05 at most.
TURNS = 8


def number_of(restitution: Real) -> Real:
    """Return a = A v1/(C² R) at a restitution, a float or an array; 0 at e = 1.

    Parameters
    ----------
    restitution : float or array
        e, in (0, 1].
    """
    e = np.asarray(restitution)
    found: Real = plain(np.expm1(-0.6 * np.log(e)) / _ratio(e) + 0.0)  # no -0
    return found


def restitution_of(number: Real) -> Real:
    """Return e at a = A v1/(C² R) >= 0, a float or an array; 1 at a = 0.

    Parameters
    ----------
    number : float or array
    """
    a = np.asarray(number)
    e = np.full(a.shape, 0.5)
    for _ in range(TURNS):
        e = (1.0 + _ratio(e) * a) ** (-5.0 / 3.0)
    found: Real = plain(e)
    return found


def _ratio(e: Real) -> Array:
    """Return g."""
    series = chebval((np.cbrt(np.maximum(e, LEAST)) - 0.6) / 0.4, TERMS)
    asymptote = FIRST * (1.0 - e**0.6) * (1.0 + SECOND * np.cbrt(e) ** 2)
    return np.where(e >= LEAST, series, asymptote)
