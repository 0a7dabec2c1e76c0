"""Makes the plan of a scene from its normal motion and the declarations of the laws."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np

from contactlab.compose.answers import NONE, ONE, Answer, Mask, separated
from contactlab.compose.composition import Laws
from contactlab.contracts.error_model import psi_magnitude
from contactlab.contracts.motion import NormalMotion
from contactlab.contracts.normal import ClosedFormNormalLaw
from contactlab.contracts.status import Status
from contactlab.impact.unit_slips import unit_slips, unlikely
from contactlab.numeric.arrays import every, some, spread
from contactlab.outcome.plan import BOOKS, PSI2_ERROR, TANGENTIAL_MOTION, UNCHECKED, Clause, Plan

#: Error of what is known in closed form, over max(1, |psi1|).
CLOSED_FORM = 1e-12
#: Advice of a plan if the error is not declared.
ADVICE = "; run(scene, estimate_error=True) estimates it"


def make_plan(
    normal: NormalMotion,
    laws: Laws,
    known: Sequence[Answer],
    *,
    history: bool | str = False,
) -> Plan:
    """Return what the scene needs of the three laws.

    Parameters
    ----------
    normal : NormalMotion
        Normal motion of the scene.
    laws : Laws
    known : sequence of Answer
        Whole-impact answers; their impacts are not marched.
    history : bool or "fields"
        True if a history was requested, ``"fields"`` if one with fields was.
    """
    scene = normal.scene
    ended, marched = _ended_and_marched(normal, known)
    error = _error(normal, laws, known, marched)
    cautions: tuple[str, ...] = ()  # those of the laws, which are asked now: they may raise
    if some(ended):
        cautions = laws.normal.cautions(scene, normal) + laws.tangential.cautions(scene, normal)
    if some(marched):
        part = normal if every(marched) else normal.take(marched)
        cautions += laws.integrator.remarks(part, laws.tangential, part.scene)

    # Kept until the plan is read: neither the normal motion nor the numbers of the answers.
    normal_law = normal.law
    fields = any(answer.known.fields is not None for answer in known)
    reasons = [(answer.known.reason, answer.where, answer.known.balanced) for answer in known]

    def clauses() -> tuple[tuple[Clause, ...], tuple[Clause, ...], tuple[Clause, ...]]:
        everywhere = np.ones(scene.shape, dtype=bool) if scene.shape else ONE
        how = "integrated from first touch to separation"
        if isinstance(normal_law, ClosedFormNormalLaw):
            how = "in closed form"
        law = f"{type(normal_law).__name__}, {how}{_defaults(normal_law)}"
        computed = [Clause(f"normal motion: {law}", everywhere)]
        if some(marched):
            text = "tangential motion: {!r} over {!r}"
            computed.append(
                Clause(text, marched, (laws.integrator, laws.tangential), TANGENTIAL_MOTION)
            )
        left_out = _not_marched(reasons, ended)
        if reason := _no_history(history, marched, fields=fields):
            left_out.append(Clause(reason, everywhere))
        return (
            (*computed, *_error_clauses(error, ended)),
            tuple(left_out),
            tuple(
                Clause(text, everywhere)
                for text in (*unit_slips(scene), *unlikely(scene), *cautions, *_taken(normal_law))
            ),
        )

    return Plan(late=clauses, marched=marched, psi2_error=error)


def _taken(law: Any) -> tuple[str, ...]:
    """Return the caution of a restitution that nobody gave."""
    kept = _defaults(law).partition("restitution = ")[2]
    if not kept:
        return ()
    value = kept.partition(",")[0].partition(" ")[0]
    name = type(law).__name__
    return (f"restitution = {value} was taken by default: give {name} one of your own",)


def _defaults(law: Any) -> str:
    """Return which options of a law have their default value, with a semicolon before."""
    if not (attrs.has(type(law)) and attrs.fields(type(law))):
        return ""
    try:
        usual = type(law)()
    except (TypeError, ValueError):  # it has no defaults, or not for all options
        return ""
    values = {item.name: getattr(law, item.name) for item in attrs.fields(type(law))}
    kept = [
        f"{name} = {value:g}"
        for name, value in values.items()
        if isinstance(value, float) and value == getattr(usual, name)
    ]
    return f"; {', '.join(kept)} by default" if kept else ""


def _ended_and_marched(normal: NormalMotion, known: Sequence[Answer]) -> tuple[Mask, Mask]:
    """Return the impacts whose normal motion ends, and the ones among them to be marched."""
    if not normal.scene.shape:
        if normal.status is not Status.SUCCESS:
            return NONE, NONE
        return ONE, NONE if known else ONE
    ended = separated(normal)
    marched = ended.copy()
    for answer in known:
        marched &= ~answer.where
    return ended, marched


def _not_marched(reasons: Sequence[tuple[str, Mask, bool]], ended: Mask) -> list[Clause]:
    """Return why impacts are not marched."""
    march = "march of the tangential motion"
    clauses = [Clause(f"{march}: {reason}", where) for reason, where, _ in reasons]
    clauses += [Clause(UNCHECKED, where, code=BOOKS) for _, where, balanced in reasons if balanced]
    if not every(ended):
        clauses.append(Clause(f"{march}: the normal motion came to no end", ~ended))
    return clauses


def _no_history(history: bool | str, marched: Mask, *, fields: bool) -> str | None:
    """Return what a history leaves out, and why."""
    if not history:
        return "history: not asked for"
    if history != "fields":
        return "traction and stick/slip fields: not asked for (history='fields')"
    if not (some(marched) or fields):
        return "traction and stick/slip fields: there is no march to take them from"
    return None


def _error(normal: NormalMotion, laws: Laws, known: Sequence[Answer], marched: Mask) -> Any:
    """Return the declared numerical error of psi2: of one impact a float, of a batch an array.

    Parameters
    ----------
    normal : NormalMotion
    laws : Laws
    known : sequence of Answer
    marched : array of bool
        Impacts that no whole-impact answer is for.
    """
    scene = normal.scene
    rounding = CLOSED_FORM * psi_magnitude(scene) + normal.accuracy * 4.0 * scene.chi
    if not (scene.shape or marched):
        return float(rounding + sum(answer.known.psi2_error for answer in known))
    error: Any = spread(rounding, scene.shape)
    for answer in known:
        error = error + np.where(answer.where, answer.known.psi2_error, 0.0)
    if some(marched):
        with np.errstate(all="ignore"):
            declared = laws.integrator.psi2_error(normal, laws.tangential, scene)
            if math.isnan(normal.accuracy):
                declared = math.nan  # no better known than the motion that it follows
            error = np.where(marched, declared, error) if scene.shape else declared
    return error if scene.shape else float(error)


def _error_clauses(error: Any, ended: Mask) -> list[Clause]:
    """Return what a plan says of the numerical error."""
    if ended.ndim:
        undeclared = ended & np.isnan(error)
        declared = ended & ~undeclared
    elif math.isnan(error):
        undeclared, declared = ended, NONE
    else:
        undeclared, declared = NONE, ended
    clauses = []
    if some(declared):
        text = "numerical error of psi2: at most {:.2g}, declared"
        clauses.append(Clause(text, declared, (error,), PSI2_ERROR))
    if some(undeclared):
        text = f"numerical error of psi2: not declared{ADVICE}"
        clauses.append(Clause(text, undeclared, code=PSI2_ERROR))
    return clauses
