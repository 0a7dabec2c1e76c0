"""Exact impacts to build and to judge the table from: each is solved on its own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import contactlab

Array = NDArray[np.float64]

#: At this tolerance neighbouring answers agree to some 1e-14, and all to 1e-13 but in corners.
TOLERANCE = 1e-11


def _law() -> contactlab.Simulation:
    integrator = contactlab.create("integrator.events", tolerance=TOLERANCE)
    return contactlab.Simulation(tangential="fronts", integrator=integrator)


def exact(psi1: Array, chi: Array) -> Array:
    """Return psi2, shape (impacts,), some 3 ms each."""
    scene = contactlab.Scene.nondimensional(psi1=psi1, chi=chi)
    return np.asarray(_law().run(scene).check().psi2)


def last_slip(psi1: float, chi: float) -> int:
    """Return the sign of the slip with which one impact ends."""
    scene = contactlab.Scene.nondimensional(psi1=psi1, chi=chi)
    history = _law().run(scene, history=True).check().history
    assert history is not None
    friction = history.tangential_force[history.normal_force > 0.0]
    return 1 if friction[-1] > 0.0 else -1
