"""Whole-impact answers of one loss for pressure and shear, from the table of restitutions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.contracts import WholeImpact, from_change
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Real
from contactlab_laws.tables import restituted
from contactlab_laws.tables.restituted_regions import RESTITUTED_CHI, bound_restitution_error
from contactlab_laws.viscoelastic.rebound import rebound


def look_up(scene: Scene, restitution: Real, *, beyond: bool) -> tuple[WholeImpact, ...]:
    """Return the answer for the impacts whose chi is in the table, or for all; or nothing."""
    low, high = (0.0, math.inf) if beyond else RESTITUTED_CHI
    chi, psi1 = np.broadcast_arrays(np.asarray(scene.chi), np.asarray(scene.psi1))
    where: Any = (chi >= low) & (chi <= high) & np.isfinite(psi1)
    if not where.any():
        return ()
    inside = np.where(where, chi, 1.0), np.where(where, psi1, 0.0)
    e: Any = restitution
    if not isinstance(e, float):
        e = np.broadcast_to(e, chi.shape).ravel()
    change = rebound(inside[1].ravel(), inside[0].ravel(), e).reshape(chi.shape)
    change = change - inside[1]
    error = bound_restitution_error(inside[0], restitution)
    known = np.clip(inside[0], *RESTITUTED_CHI)
    shear = restituted.shear_loss(inside[1].ravel(), known.ravel(), e).reshape(chi.shape)
    single = not scene.shape
    reason = "the answer is in the table of restitutions"
    if beyond:
        reason = "the answer is that of contactlab.rebound, as no step can follow e below 0.01"
    return (
        from_change(
            scene,
            where=True if single else where,
            psi_change=float(change) if single else change,
            psi2_error=float(error) if single else error,
            reason=reason,
            counter="tabulated",
            in_shear=float(shear) if single else shear,
        ),
    )
