"""Rebound of many unlike impacts: psi2 alone, of elastic spheres."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contactlab.closed_forms import slips_throughout_elastic
from contactlab.scene import Scene
from contactlab_fronts.many.march import march
from contactlab_hertz.law import Hertz

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: As psi1 vanishes psi2/psi1 tends to a limit: below this the difference is some LINEAR of it.
LINEAR = 1e-6
#: A looser tolerance saves a third of the time, and would let answers depend on each other, and
#: on whether they are found in an array or alone, by more than 1e-10.
LOOSEST = 1e-9


def rebound(psi1: Array, chi: Array, tolerance: float) -> tuple[Array, Flags]:
    """Return (psi2, solved) of elastic Hertz impacts with Coulomb friction, e = 1.

    Parameters
    ----------
    psi1, chi : ndarray, shape (impacts,)
        Scaled incidence, any sign, and chi > 0 (theory §1).
    tolerance : float
        Wanted error of psi2, of max(1, |psi1|); never more than ``LOOSEST`` is aimed at.

    Returns
    -------
    psi2 : ndarray, shape (impacts,)
        Odd in psi1 to the last bit; never NaN.
    solved : ndarray of bool, shape (impacts,)
        False where the impact was given up, and psi2 is nothing but psi1.
    """
    motion = Hertz().motion(Scene.nondimensional(psi1=0.0, chi=1.0))
    speed, change = np.abs(psi1), -4.0 * chi  # slips throughout, eq. (45)
    solved = np.ones(psi1.shape, dtype=bool)
    sticks = ~np.asarray(slips_throughout_elastic(psi1, chi))
    scaled, inertia = np.maximum(speed[sticks], LINEAR), 2.0 * chi[sticks] / motion.scaled_mass
    found = march(scaled, inertia, motion, min(tolerance, LOOSEST))
    change[sticks] = np.where(found.solved, found.change * (speed[sticks] / scaled), 0.0)
    solved[sticks] = found.solved
    # no impact gains energy, nor more impulse than full slip gives: not even by an error
    np.clip(change, np.maximum(-2.0 * speed, -4.0 * chi), 0.0, out=change)
    return np.copysign(1.0, psi1) * (speed + change), solved
