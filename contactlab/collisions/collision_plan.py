"""Plan entries specific to collisions: bodies that separate, and a restitution by its table."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.collisions.rebound import bound_restitution_error
from contactlab.impact.body_cautions import contact_vectors
from contactlab.impact.encounter import Encounter
from contactlab.numeric.arrays import plain, some
from contactlab.numeric.types import Real
from contactlab.outcome.plan import PSI2_ERROR, TANGENTIAL_MOTION, Clause, Plan

PARTED = "collision: the bodies separate, they pass through untouched"


def collision_plan(plan: Plan, met: Encounter | None, passed: NDArray[np.bool_]) -> Plan:
    """Return the plan with clauses on separating bodies and contacts of bodies.

    ``plan`` is that of the encounters that ``met``, None if no bodies did; ``passed`` marks the
    encounters of the whole batch whose bodies separate.
    """
    left_out, cautions = list(plan.left_out), list(plan.cautions)
    if met is not None and not met.of_spheres:
        everywhere = np.ones(met.shape, dtype=bool)
        cautions += [Clause(text, everywhere) for text in contact_vectors(met)]
    if passed.any():
        left_out.append(Clause(PARTED, passed))
    return plan.change(left_out=tuple(left_out), cautions=tuple(cautions))


def by_rebound(plan: Plan, chi: Real, restitution: Real) -> Plan:
    """Return the plan of laws that answer as ``rebound`` does, with the words of ``rebound``."""
    marched = plan.columns.marched
    error = np.where(marched, bound_restitution_error(chi, restitution), plan.psi2_error)
    low, high = float(np.min(restitution)), float(np.max(restitution))
    told = f"{low:g}" if low == high else f"{low:.4g}..{high:.4g}"
    said: dict[str, tuple[str, tuple[Any, ...] | None]] = {
        TANGENTIAL_MOTION: (
            f"friction: contactlab.rebound with restitution={told}, equal damping in compression "
            f"and shear; springs beyond its table",
            None,
        ),
        PSI2_ERROR: (
            "numerical error of psi2: below {:.2g} (bound stated by contactlab.rebound)",
            (error,),
        ),
    }
    computed = []
    for clause in plan.computed:
        if clause.code in said and some(clause.where & marched):
            text, values = said[clause.code]
            clause = clause._replace(text=text, values=values)
        computed.append(clause)
    return plan.change(computed=tuple(computed), psi2_error=plain(error))
