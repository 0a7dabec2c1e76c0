"""psi2 for arrays of (psi1, chi): the shortcut for people's own code."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab.checks import POSITIVE, Real, Rule, real, refuse

Array = NDArray[np.float64]

#: So few are solved one by one: together they would take longer.
FEW = 64
#: Whatever is asked for: an answer is then the same, to 1e-10, in an array and alone.
EXACT = 1e-9
TOLERANCE = Rule(
    lambda value: (value >= 1e-9) & (value < 1.0), "must lie between 1e-9 and 1, of max(1, |psi1|)"
)
LARGEST_CHI = 1e4
CHI = Rule(
    lambda value: POSITIVE.holds(value) & (value <= LARGEST_CHI),
    "must be positive and at most 1e4, the range over which answers were checked",
)
#: Every impact with chi in range slips throughout from here on: psi1 falls by 4 chi.
LARGEST = 1e5


def rebound(psi1: object, chi: object, *, tolerance: float = 1e-5) -> Real:
    """Return the tangential rebound psi2 of elastic spheres, for any number of impacts at once.

    The paper's model in its continuum limit (elastic Hertz contact, Coulomb friction), without
    scenes, plans or books: about a tenth of a millisecond an impact in a large array.
    ``contactlab.Simulation`` gives everything else.

    Parameters
    ----------
    psi1 : float or array_like
        Non-dimensional angle of incidence, eq. (29): kappa v_x / (mu v1). Any sign and size.
    chi : float or array_like
        Eq. (38), broadcast against ``psi1``; positive, at most 1e4.
    tolerance : float
        Error aimed at, of max(1, |psi1|), from 1e-9. Answers are that good whatever is asked.

    Returns
    -------
    psi2 : float or ndarray
        Tangential velocity of the contact after the impact, in the sense of ``psi1``: negative
        is reversed for positive psi1. Odd in psi1 to the last bit. A float if both are scalars.
        What else is in an array changes an answer by less than 1e-10.

    Raises
    ------
    ValueError
        For bad input, with the argument, its value, the rule and the remedy.
    ValueError, PluginError
        If the law ``tangential.fronts`` is blocked or cannot be imported.
    ImpactError
        If an impact could not be solved at all; none is known.

    Examples
    --------
    >>> round(rebound(1.2, 49 / 34), 6)
    -0.180519
    """
    incidence = real("psi1", psi1, remedy="give the non-dimensional angle of incidence (29)")
    inertia = real("chi", chi, rule=CHI, remedy="chi of eq. (38); 1.4412 for a solid steel sphere")
    aim = real("tolerance", tolerance, rule=TOLERANCE, remedy="leave it out for 1e-5")
    if not isinstance(aim, float):
        raise refuse("tolerance", tolerance, "must be one number", "leave it out for 1e-5")
    try:
        velocity, ratio = np.broadcast_arrays(np.asarray(incidence), np.asarray(inertia))
    except ValueError:
        shapes = f"{np.shape(incidence)} and {np.shape(inertia)}"
        raise refuse(
            "psi1 and chi", shapes, "must have shapes that fit", "one value of chi for each psi1"
        ) from None
    psi2 = _solve(velocity.ravel(), ratio.ravel(), aim).reshape(velocity.shape)
    return float(psi2) if psi2.ndim == 0 else psi2


def _solve(psi1: Array, chi: Array, tolerance: float) -> Array:
    """Return psi2, shape (impacts,)."""
    from contactlab.registry import REGISTRY  # no law before it is needed

    law = REGISTRY.create("tangential.fronts")
    if psi1.size <= FEW:
        return _one_by_one(psi1, chi)
    psi2: Array
    psi2, solved = law.rebound(psi1, chi, tolerance)
    if not solved.all():
        left = ~solved
        psi2[left] = _one_by_one(psi1[left], chi[left])
    return psi2


def _one_by_one(psi1: Array, chi: Array) -> Array:
    """Return psi2 by the exact solution for abs(psi1), event by event."""
    from contactlab.registry import REGISTRY
    from contactlab.scene import Scene
    from contactlab.simulation import Simulation

    integrator = REGISTRY.create("integrator.events", tolerance=EXACT)
    exact = Simulation(tangential="fronts", integrator=integrator)
    # Beyond, the energy of slip may not fit into a float.
    incidence = np.minimum(np.abs(psi1), LARGEST)
    result = exact.run(Scene.nondimensional(psi1=incidence, chi=chi)).check()
    return np.asarray(np.copysign(1.0, psi1) * (np.abs(psi1) + result.psi_change))
