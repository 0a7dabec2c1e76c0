"""Elastic impacts that slip from start to end, for which laws of partial slip need no march."""

from __future__ import annotations

from contactlab.contracts import NormalMotion, WholeImpact, sliding
from contactlab.impact.hertz import slips_throughout
from contactlab.impact.scene import Scene


def gross_slip(scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
    """Return the answers of eq. (45), for impacts of elastic Hertz contacts; else none."""
    if "elastic_hertz" not in normal.claims:
        return ()
    where = slips_throughout(scene.psi1, scene.chi)
    if where is False:  # a single impact; a batch has a mask
        return ()
    reason = "the impact slips from start to end, eq. (45)"
    return (sliding(scene, normal, where=where, reason=reason, stops=False),)
