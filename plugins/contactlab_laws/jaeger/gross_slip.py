"""Elastic impacts that slip from start to end, for which laws of partial slip need no march."""

from __future__ import annotations

from contactlab.contracts import NormalMotion, WholeImpact, sliding
from contactlab.impact.hertz import slips_throughout_elastic
from contactlab.impact.scene import Scene


def gross_slip(scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
    """Return the impacts of eq. (45), of elastic Hertz contacts; of others nothing is known."""
    if "elastic_hertz" not in normal.offers:
        return ()
    where = slips_throughout_elastic(scene.psi1, scene.chi)
    if where is False:  # of one impact; of a batch the mask says it
        return ()
    reason = "the impact slips from start to end, eq. (45)"
    return (sliding(scene, normal, where=where, reason=reason, stops=False),)
