"""Whole-impact answers of one loss for pressure and shear, from the table of restitutions."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.contracts import WholeImpact, from_change
from contactlab.impact.scene import Scene
from contactlab_laws.tables.restituted_regions import RESTITUTED_CHI, restituted_error
from contactlab_laws.viscoelastic.rebound import rebound


def tabulated(scene: Scene, restitution: float) -> tuple[WholeImpact, ...]:
    """Return the answer for the impacts whose chi is in the table, or nothing."""
    low, high = RESTITUTED_CHI
    chi, psi1 = np.broadcast_arrays(np.asarray(scene.chi), np.asarray(scene.psi1))
    where: Any = (chi >= low) & (chi <= high) & np.isfinite(psi1)
    if not where.any():
        return ()
    inside = np.where(where, chi, 1.0), np.where(where, psi1, 0.0)
    change = rebound(inside[1].ravel(), inside[0].ravel(), restitution).reshape(chi.shape)
    change = change - inside[1]
    error = restituted_error(inside[0], restitution)
    single = not scene.shape
    return (
        from_change(
            scene,
            where=True if single else where,
            psi_change=float(change) if single else change,
            psi2_error=float(error) if single else error,
            reason="the answer is in the table of restitutions",
            counter="tabulated",
        ),
    )
