"""Exact impacts to build and to judge the table from, and to go beyond it."""

from __future__ import annotations

import numpy as np

import contactlab
from contactlab.numeric.types import Array

#: Solved alone at this tolerance, neighbouring answers agree to some 1e-14, and all to 1e-13.
ALONE = 1e-11
#: Solved together, answers come to 1e-10 of max(1, |psi1|), but for those so near to psi1 = 1
#: (6e-8) or to chi = 1/2 (4e-3 at psi1 = 1): these are solved alone.
TOGETHER = 1e-9
NEAR_ONE, NEAR_HALF = 1e-5, 1e-2
#: Nearer to the point psi1 = 1, chi = 1/2 than this even the exact solution errs, by up to 2e-8.
CORNER = 1e-3
#: Distances, in parts of CORNER, from which answers there are extrapolated.
FARTHER = (1.0, 2.0, 3.0)


def _law(tolerance: float) -> contactlab.Simulation:
    integrator = contactlab.create("integrator.events", tolerance=tolerance)
    law = contactlab.create("tangential.fronts", table=False)
    return contactlab.Simulation(tangential=law, integrator=integrator)


def alone(psi1: Array, chi: Array) -> Array:
    """Return psi2, shape (impacts,), each solved on its own, some 3 ms."""
    scene = contactlab.Scene.nondimensional(psi1=psi1, chi=chi)
    return np.asarray(_law(ALONE).run(scene).check().psi2)


def exact(psi1: Array, chi: Array) -> Array:
    """Return psi2 for psi1 >= 0, shape (impacts,), by whatever is most accurate; some 3 ms each.

    Near the corner psi1 = 1, chi = 1/2 nothing but the ratio of the distances from both matters
    to first order: psi2/psi1 = -1 + d h(d), where d is the larger distance and h is smooth while
    the ratio is kept. There h is extrapolated from d = CORNER and more.
    """
    distance = np.maximum(np.abs(psi1 - 1.0), np.abs(2.0 * chi - 1.0))
    corner = (distance < CORNER) & (distance > 0.0)
    psi2 = np.where(distance == 0.0, -psi1, 0.0)
    rest = ~corner & (distance > 0.0)
    if rest.any():
        psi2[rest] = alone(psi1[rest], chi[rest])
    if corner.any():
        psi2[corner] = _in_corner(psi1[corner], chi[corner], distance[corner])
    return psi2


def _in_corner(psi1: Array, chi: Array, distance: Array) -> Array:
    far = np.array(FARTHER)[:, None] * CORNER
    stretch = far / distance
    p, x = 1.0 + stretch * (psi1 - 1.0), 0.5 + stretch * (chi - 0.5)
    psi2 = alone(p.ravel(), x.ravel()).reshape(p.shape)
    h = (psi2 / p + 1.0) / far
    weights = np.ones_like(far + distance)
    for k, here in enumerate(far):
        for j, other in enumerate(far):
            if j != k:
                weights[k] *= (distance - other) / (here - other)
    return np.asarray(psi1 * (distance * (weights * h).sum(axis=0) - 1.0))


def together(psi1: Array, chi: Array) -> Array:
    """Return psi2 for psi1 >= 0, shape (impacts,); most impacts are solved together."""
    distance = np.abs(psi1 - 1.0)
    hard = (distance < NEAR_ONE) | (np.abs(chi - 0.5) < NEAR_HALF)
    psi2 = psi1.copy()
    if not hard.all():
        scene = contactlab.Scene.nondimensional(psi1=psi1[~hard], chi=chi[~hard])
        psi2[~hard] = _law(TOGETHER).sweep(scene).check().psi2
    if hard.any():
        psi2[hard] = exact(psi1[hard], chi[hard])
    return psi2


def last_slip(psi1: float, chi: float) -> int:
    """Return the sign of the slip with which one impact ends."""
    scene = contactlab.Scene.nondimensional(psi1=psi1, chi=chi)
    history = _law(ALONE).run(scene, history=True).check().history
    assert history
    friction = history.tangential_force[history.normal_force > 0.0]
    return 1 if friction[-1] > 0.0 else -1
