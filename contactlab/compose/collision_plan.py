"""Plan entries specific to collisions: bodies that separate, spin about the normal."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.compose.rebound import damped_error
from contactlab.impact.encounter import Encounter
from contactlab.impact.normal_spin import NormalSpin, normal_spin
from contactlab.numeric.arrays import some
from contactlab.numeric.checks import Real
from contactlab.outcome.plan import (
    NORMAL_SPIN,
    PSI2_ERROR,
    TANGENTIAL_MOTION,
    WITHOUT_SPIN,
    Clause,
    Clauses,
    Plan,
    Words,
)

PARTED = "collision: the bodies separate, they pass through untouched"
TURNS = "spin about the normal: its friction is left out"
#: Smallest shift of psi2, and smallest loss of spin, with a caution.
LEAST_SHIFT, LEAST_LOSS = 1e-3, 1e-2
#: What the sizes of a caution are measured for.
MEASURED = (
    "model, not numerical error; by a table of elastic impacts, psi1 to 7, w to 5, chi from 1 to "
    "1.75, beyond a rough guide"
)


def collision_plan(plan: Plan, met: Encounter | None, passed: Any) -> Plan:
    """Return the plan with clauses on separating bodies and on spin about the normal.

    ``plan`` is that of the encounters that ``met``, None if no bodies did; ``passed`` marks the
    encounters of the whole batch whose bodies separate.
    """
    if met is not None:
        plan = with_normal_spin(plan, met)
    if passed.any():
        plan = plan.changed(left_out=(*plan.left_out, Clause(PARTED, passed)))
    return plan


def with_normal_spin(plan: Plan, encounter: Encounter) -> Plan:
    """Return the plan of an encounter's impacts with what spin about the normal would change.

    Parameters
    ----------
    plan : Plan
        That of ``encounter.scene``.
    encounter : Encounter
        Bodies that approach each other, of any shape.
    """

    def words() -> Words:
        computed, left_out, cautions = plan.computed, plan.left_out, plan.cautions
        spin = normal_spin(encounter)
        if spin is None:
            return computed, left_out, cautions
        acts = np.array(spin.acts)
        computed = tuple(part for clause in computed for part in _without_spin(clause, acts))
        left_out = (*left_out, Clause(TURNS, acts, code=NORMAL_SPIN))
        return computed, left_out, (*cautions, *_sizes(spin, batch=bool(encounter.shape)))

    return Plan(plan.columns, words)


def _without_spin(clause: Clause, acts: Any) -> Clauses:
    """Return a clause; a bound of the error of psi2 is said apart where spin ``acts``."""
    if clause.code != PSI2_ERROR or clause.values is None or not some(clause.where & acts):
        return (clause,)
    said = clause._replace(text=f"{clause.text}, {WITHOUT_SPIN}", where=clause.where & acts)
    rest = clause._replace(where=clause.where & ~acts)
    return (said, rest) if some(rest.where) else (said,)


def _sizes(spin: NormalSpin, *, batch: bool) -> Clauses:
    """Return the cautions of the shift of psi2, and of a loss of spin where psi2 hardly moves."""
    about = "up to about" if batch else "about"
    size, percent, w = (np.asarray(each) for each in (abs(spin.shift), 100.0 * spin.loss, spin.w))
    number = "w = kappa omega a/(mu v1) = {:.2g}"
    shifts = size >= LEAST_SHIFT
    slows = ~shifts & (percent >= 100.0 * LEAST_LOSS)
    clauses = (
        Clause(
            f"spin about the normal: its friction, left out, shifts psi2 by {about} {{:.2g}} "
            f"({number}), and the spin would lose {about} {{:.2g}} % ({MEASURED})",
            shifts,
            (size, w, percent),
            NORMAL_SPIN,
        ),
        Clause(
            f"spin about the normal: the spin would lose {about} {{:.2g}} % by its friction, left "
            f"out ({number}), which shifts psi2 by less than {LEAST_SHIFT:g} ({MEASURED})",
            slows,
            (percent, w),
            NORMAL_SPIN,
        ),
    )
    return tuple(clause for clause in clauses if some(clause.where))


def by_rebound(plan: Plan, chi: Any, restitution: Real) -> Plan:
    """Return the plan of laws that answer as ``rebound`` does, with the words of ``rebound``."""
    unknown = np.isnan(plan.psi2_error)
    bound = np.broadcast_to(damped_error(chi, restitution), unknown.shape)
    error_words = "none was measured beyond chi = 10, of contactlab.rebound"
    if not np.isnan(bound[unknown]).all():
        error_words = "at most {:g} beside Coulomb's law at every point, of contactlab.rebound"
    low, high = float(np.min(restitution)), float(np.max(restitution))
    told = f"{low:g}" if low == high else f"{low:.4g}..{high:.4g}"
    said: dict[str, tuple[str, tuple[Any, ...] | None]] = {
        TANGENTIAL_MOTION: (
            f"tangential motion: contactlab.rebound with restitution={told}",
            None,
        ),
        PSI2_ERROR: (
            f"numerical error of psi2: {error_words}",
            (np.where(unknown, bound, np.nan),),
        ),
    }
    computed = []
    for clause in plan.computed:
        if clause.code in said and some(clause.where & unknown):
            text, values = said[clause.code]
            clause = clause._replace(text=text, values=values)
        # the restitution was given, it is no default
        computed.append(clause._replace(text=clause.text.partition("; restitution")[0]))
    error = np.where(unknown, bound, plan.psi2_error)
    return plan.changed(computed=tuple(computed), psi2_error=error if error.ndim else float(error))
