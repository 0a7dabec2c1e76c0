"""Whole-impact answers of one loss for pressure and shear, from the table of restitutions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.contracts import WholeImpact, from_change
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import some
from contactlab.numeric.types import Mask, Real
from contactlab_laws.tables import restituted
from contactlab_laws.tables.restituted_regions import RESTITUTED_CHI, bound_restitution_error
from contactlab_laws.viscoelastic.rebound import rebound


def look_up(scene: Scene, restitution: Real, *, beyond: bool) -> tuple[WholeImpact, ...]:
    """Return the answers for the impacts whose chi is in the table, or for all impacts."""
    low, high = (0.0, math.inf) if beyond else RESTITUTED_CHI
    psi1: Any = scene.psi1
    chi: Any = scene.chi
    where: Mask = (chi >= low) & (chi <= high) & (abs(psi1) < math.inf)
    if not some(where):
        return ()
    if scene.shape:
        change, error, shear = _look_up_many(scene, restitution, where)
    else:  # plain numbers take a third of the time
        change = rebound(psi1, chi, restitution) - psi1
        error = bound_restitution_error(chi, restitution)
        known = min(max(chi, RESTITUTED_CHI[0]), RESTITUTED_CHI[1])
        shear = restituted.single_shear_loss(psi1, known, float(restitution))
    reason = "the answer is in the table of restitutions"
    if beyond:
        reason = "the answer is that of contactlab.rebound, as no step can follow e below 0.01"
    return (
        from_change(
            scene,
            where=where,
            psi_change=change,
            psi2_error=error,
            reason=reason,
            counter="tabulated",
            in_shear=shear,
        ),
    )


def _look_up_many(scene: Scene, restitution: Real, where: Mask) -> tuple[Any, Any, Any]:
    """Return change of psi, error and loss in shear of some impacts of a batch."""
    chi, psi1 = np.where(where, scene.chi, 1.0), np.where(where, scene.psi1, 0.0)
    e = restitution
    if not isinstance(e, float):
        e = np.broadcast_to(e, chi.shape).ravel()
    change = rebound(psi1.ravel(), chi.ravel(), e).reshape(chi.shape) - psi1
    known = np.clip(chi, *RESTITUTED_CHI)
    shear = restituted.shear_loss(psi1.ravel(), known.ravel(), e).reshape(chi.shape)
    return change, bound_restitution_error(chi, restitution), shear
